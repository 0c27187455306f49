// However a map's texels stand in memory, everything that is asked of it is the same to the bit.
#include <gtest/gtest.h>

#include <cmath>

#include "parallel/thread_pool.h"
#include "support/chi_square.h"
#include "support/environment_maps.h"

namespace komorebi {
namespace {

std::vector<float> all_texels(const Environment& map) {
  std::vector<float> texels;
  for (std::uint64_t i = 0; i < map.map().texel_count(); ++i) {
    const Vec3 value = map.map().texel(i);
    texels.insert(texels.end(), &value.x, &value.x + 3);
  }
  return texels;
}

TEST(MapStorage, AnswersAreThoseOfFloats) {
  for (const auto storage : {LightStorage::kRgbe, LightStorage::kHalf, LightStorage::kFloat}) {
    const Environment map = testing::stored_map(37, 20, 5, storage);
    const EnvironmentView view = map.view(1.3);
    ASSERT_EQ(view.storage, storage);
    const std::vector<float> texels = all_texels(map);
    EnvironmentView floats = view;
    floats.storage = LightStorage::kFloat;
    floats.texels = texels.data();
    floats.words = nullptr;
    const Sampler sampler(1, 2, 3);
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const Bits2 bits = sampler.bits_2d(8, i);
      const EnvironmentSample a = sample_environment(view, bits),
                              b = sample_environment(floats, bits);
      ASSERT_EQ(a.direction, b.direction);
      ASSERT_EQ(a.radiance, b.radiance);
      ASSERT_EQ(a.pdf, b.pdf);
      const EnvironmentValue c = evaluate_environment(view, a.direction);
      const EnvironmentValue d = evaluate_environment(floats, a.direction);
      ASSERT_EQ(c.radiance, d.radiance);
      ASSERT_EQ(c.pdf, d.pdf);
    }
  }
}

TEST(MapStorage, TablesAreEqualForAnyThreads) {
  const auto made = [](unsigned threads) {
    LightMap map("m", 300, 177);
    std::vector<float> texels = all_texels(testing::random_map(300, 177, 8));
    map.put(0, 177, texels.data());
    ThreadPool pool(threads);
    return std::make_unique<Environment>(std::move(map), pool);
  };
  const auto one = made(1), four = made(4);
  const EnvironmentView a = one->view(), b = four->view();
  for (std::size_t i = 0; i < 179; ++i) EXPECT_EQ(a.row_cdf[i], b.row_cdf[i]);
  for (std::size_t i = 0; i < 178u * 301u; ++i) ASSERT_EQ(a.column_cdf[i], b.column_cdf[i]);
}

/// A map of 16k × 8k, even but for a sun of 2 × 2 texels, put in band by band.
std::unique_ptr<Environment> big_map(float sky, float sun) {
  constexpr std::uint32_t kWidth = 16384, kHeight = 8192, kRows = 64;
  LightMap map("16k", kWidth, kHeight);
  std::vector<float> band;
  for (std::uint32_t first = 0; first < kHeight; first += kRows) {
    band.assign(std::size_t{3} * kWidth * kRows, sky);
    for (std::uint32_t row : {6000u, 6001u}) {
      if (row < first || row >= first + kRows) continue;
      const std::size_t at = 3 * (std::size_t{row - first} * kWidth + 5000);
      std::fill_n(band.begin() + static_cast<std::ptrdiff_t>(at), 6, sun);
    }
    map.put(first, kRows, band.data());
  }
  ThreadPool pool(0);
  return std::make_unique<Environment>(std::move(map), pool);
}

TEST(MapStorage, ASmallSunInABigMapConverges) {
  constexpr float kSky = 0.5f, kSun = 98304.0f;  // beyond the halves
  const auto map = big_map(kSky, kSun);
  EXPECT_EQ(map->map().storage(), LightStorage::kRgbe);
  EXPECT_LT(map->byte_count(), std::size_t{16384} * 8192 * 8 + (1u << 20));
  const EnvironmentView view = map->view();
  // A texel's share of the sphere, by the bilinear hat about its centre.
  const double latitude = kPi * (6001.0 / 8192 - 0.5);
  const double texel = 2 * kPi / 16384 * kPi / 8192 * std::cos(latitude);
  const double sun = 4 * texel * double{kSun - kSky}, sky = 4 * kPi * double{kSky};
  const Sampler sampler(0, 1, 2);
  constexpr std::uint32_t kCount = 1 << 20;
  double sum = 0.0;
  std::vector<std::uint64_t> observed(9);
  const double v = (6001.0) / 8192, u = 5001.0 / 16384;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto s = sample_environment(view, sampler.bits_2d(8, i));
    sum += double{luminance(s.radiance)} / double{s.pdf};
    const Vec2 at = equirectangular_from_direction(s.direction);
    const bool near =
        std::abs(double{at.x} - u) < 2.0 / 16384 && std::abs(double{at.y} - v) < 2.0 / 8192;
    const int octant = (s.direction.x < 0) + 2 * (s.direction.y < 0) + 4 * (s.direction.z < 0);
    ++observed[near ? 8 : static_cast<std::size_t>(octant)];
  }
  EXPECT_NEAR(sum / kCount / (sun + sky), 1.0, 1e-4);
  const double around = 16 * texel * double{kSky};  // sky beside the sun
  std::vector<double> expected(9, (sky - 0.0) / 8);
  expected[8] = sun + around;
  const int octant_of_sun = [&] {
    const Vec3 d =
        direction_from_equirectangular(Vec2(static_cast<float>(u), static_cast<float>(v)));
    return (d.x < 0) + 2 * (d.y < 0) + 4 * (d.z < 0);
  }();
  expected[static_cast<std::size_t>(octant_of_sun)] -= around;
  for (std::size_t bin = 0; bin < 9; ++bin) {
    expected[bin] *= kCount / (sun + sky);
    EXPECT_NEAR(double(observed[bin]), expected[bin], 5 * std::sqrt(expected[bin]) + 2) << bin;
  }
}

TEST(MapStorage, AnEvenBigMapIsAnEvenSky) {
  const auto map = big_map(0.75f, 0.75f);
  const EnvironmentView view = map->view();
  const Sampler sampler(4, 1, 2);
  double sum = 0.0;
  constexpr std::uint32_t kCount = 1 << 16;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto s = sample_environment(view, sampler.bits_2d(8, i));
    ASSERT_EQ(s.radiance, Vec3(0.75f));
    ASSERT_NEAR(s.pdf * 4.0f * float(kPi), 1.0f, 2e-3f);
    sum += 0.75 / double{s.pdf};
  }
  EXPECT_NEAR(sum / kCount / (4 * kPi * 0.75), 1.0, 1e-4);
  EXPECT_NEAR(map->mean_flux() / (4 * kPi * 0.75), 1.0, 1e-6);
}

}  // namespace
}  // namespace komorebi
