// Product importance sampling: its samples follow the tables, the tables reach all light that any
// normal can meet, and the estimates have the exact mean.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/direction_test.h"
#include "support/environment_maps.h"

namespace komorebi {
namespace {

using testing::RandomBits;

double share(const std::uint32_t* cdf, std::uint32_t first, std::uint32_t last, std::uint32_t i) {
  return cdf[last] == cdf[first]
             ? 0.0
             : static_cast<double>(cdf[i + 1] - cdf[i]) / (cdf[last] - cdf[first]);
}

/// With which probability a patch is chosen for normals of a bin, straight from the tables.
double patch_share(const EnvironmentView& e, const ProductView& p, std::uint32_t bin,
                   std::uint32_t patch_row, std::uint32_t patch_column) {
  std::uint32_t row = 0, column = 0;
  while (p.patch_row[row + 1] <= patch_row) ++row;
  while (p.patch_column[column + 1] <= patch_column) ++column;
  const std::uint32_t* columns = p.column_cdf + (std::size_t{bin} * p.rows + row) * (p.columns + 1);
  const std::uint32_t height = p.patch_row[row + 1] - p.patch_row[row];
  const std::uint32_t* in_cell =
      p.patch_row_cdf + std::size_t{column} * (e.height + 1 + p.rows) + p.patch_row[row] + row;
  return share(p.row_cdf + bin * (p.rows + 1), 0, p.rows, row) *
         share(columns, 0, p.columns, column) *
         share(in_cell, 0, height, patch_row - p.patch_row[row]) *
         share(detail::patch_columns(e, patch_row), p.patch_column[column],
               p.patch_column[column + 1], patch_column);
}

std::vector<Vec3> some_normals(int count, std::uint64_t seed) {
  RandomBits random(seed);
  std::vector<Vec3> normals = {{0, 0, 1},  {0, 0, -1}, {1, 0, 0},
                               {0, -1, 0}, {-1, 0, 0}, glm::normalize(Vec3(1, 1, -1e-4f))};
  while (static_cast<int>(normals.size()) < count) {
    const Bits2 bits = random.next();
    normals.push_back(uniform_sphere(Vec2(to_unit_float(bits.x), to_unit_float(bits.y))));
  }
  return normals;
}

void expect_samples_follow_tables(const Environment& map, std::uint64_t seed) {
  const EnvironmentView e = map.view();
  const ProductView p = map.product_table().view();
  constexpr int kCount = 400000;
  for (const Vec3& normal : some_normals(8, seed)) {
    const std::uint32_t bin = octahedral_cell(normal, p.bins);
    std::vector<double> expected;
    for (std::uint32_t r = 0; r <= e.height; ++r) {
      for (std::uint32_t c = 0; c < e.width; ++c) {
        expected.push_back(kCount * patch_share(e, p, bin, r, c));
      }
    }
    std::vector<std::uint64_t> observed(expected.size(), 0);
    RandomBits random(seed + 1);
    for (int i = 0; i < kCount; ++i) {
      const EnvironmentSample s = sample_product(e, p, normal, Vec3(0.0f), random.next());
      ASSERT_GT(s.pdf, 0.0f);
      const auto at = detail::locate(e, s.direction);
      ++observed[std::size_t{at.patch.row} * e.width + at.patch.column];
    }
    const auto result = testing::chi_square(observed, expected);
    EXPECT_GT(result.p_value, testing::sidak(0.01, 40))
        << result.statistic << " of " << result.degrees;
  }
}

TEST(ProductTable, SamplesFollowIt) {
  expect_samples_follow_tables(testing::random_map(32, 16, 1), 1);
  expect_samples_follow_tables(testing::random_map(13, 7, 2), 2);
  expect_samples_follow_tables(testing::random_map(1, 2, 3), 3);
  expect_samples_follow_tables(testing::random_map(150, 70, 4), 4);
}

TEST(ProductTable, DensityIsThatOfTheDrawnPatch) {
  const Environment map = testing::random_map(97, 50, 5);
  const EnvironmentView e = map.view();
  const ProductView p = map.product_table().view();
  RandomBits random(6);
  for (const Vec3& normal : some_normals(40, 7)) {
    const std::uint32_t bin = octahedral_cell(normal, p.bins);
    for (int i = 0; i < 500; ++i) {
      const EnvironmentSample s = sample_product(e, p, normal, Vec3(0.0f), random.next());
      const auto at = detail::locate(e, s.direction);
      if (at.s < 1e-3f || at.s > 0.999f || at.z_fraction < 1e-3f || at.z_fraction > 0.999f)
        continue;
      const double pdf = double{environment_pdf(e, s.direction)} /
                         detail::patch_probability(e, at.patch.row, at.patch.column) *
                         patch_share(e, p, bin, at.patch.row, at.patch.column);
      ASSERT_NEAR(double{s.pdf} / pdf, 1.0, 5e-3);
      ASSERT_NEAR(product_pdf(e, p, normal, Vec3(0.0f), s.direction), pdf, 1e-6 * pdf);
      const Vec3 radiance = environment_radiance(e, s.direction);
      ASSERT_NEAR(luminance(s.radiance), luminance(radiance), 2e-3f * (1.0f + luminance(radiance)));
    }
  }
}

/// Of a density that is made of any direction it has to be found that the directions which it was
/// not drawn for have it too: all of them together are drawn for sure.
TEST(ProductTable, DensityOfDirectionsComesToOne) {
  const Mat3d turn(glm::dvec3(0.36, 0.48, -0.8), glm::dvec3(-0.8, 0.6, 0.0),
                   glm::dvec3(0.48, 0.64, 0.6));
  for (const auto& [width, height] : {std::pair{64u, 32u}, {150u, 70u}, {13u, 7u}, {1u, 2u}}) {
    const Environment map = testing::random_map(width, height, 14);
    const EnvironmentView e = map.view(1.5, turn);
    const ProductView p = map.product_table().view();
    constexpr std::uint32_t kSide = 512;  // equal areas
    for (const Vec3& normal : some_normals(10, 15)) {
      double sum = 0.0;
      for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        const Vec2 u((static_cast<float>(i % kSide) + 0.5f) / kSide,
                     (static_cast<float>(i / kSide) + 0.5f) / kSide);
        sum += double{product_pdf(e, p, normal, Vec3(0.0f), uniform_sphere(u))};
      }
      EXPECT_NEAR(sum * 4.0 * kPi / (kSide * kSide), 1.0, 0.02) << width;
    }
  }
}

/// For whatever normal: what shines and lies above its horizon can be drawn, and with no small
/// part of its due, so that no sample exceeds the limit of the film.
TEST(ProductTable, ReachesAllThatShines) {
  for (const auto& [width, height] : {std::pair{64, 32}, {200, 100}, {5, 3}, {2, 1}, {1, 1}}) {
    const Environment map = testing::random_map(static_cast<std::uint32_t>(width),
                                                static_cast<std::uint32_t>(height), 8);
    const EnvironmentView e = map.view();
    const ProductView p = map.product_table().view();
    const float bound = 32.0f * map.max_radiance();
    RandomBits random(9);
    for (const Vec3& normal : some_normals(3000, 10)) {
      const std::uint32_t bin = octahedral_cell(normal, p.bins);
      for (int i = 0; i < 30; ++i) {
        const Bits2 bits = random.next();
        const Vec3 d = uniform_sphere(Vec2(to_unit_float(bits.x), to_unit_float(bits.y)));
        const float cosine = glm::dot(d, normal);
        const auto at = detail::locate(e, d);
        if (cosine <= 0.0f || !(environment_pdf(e, d) > 0.0f)) continue;
        const double pdf = double{environment_pdf(e, d)} /
                           detail::patch_probability(e, at.patch.row, at.patch.column) *
                           patch_share(e, p, bin, at.patch.row, at.patch.column);
        ASSERT_GT(pdf, 0.0) << width;
        const Vec3 weight =
            environment_radiance(e, d) * (cosine * kInvPi / static_cast<float>(pdf));
        ASSERT_LE(max_abs(weight), bound) << width;
      }
    }
  }
}

TEST(ProductTable, MeanIsTheIrradiance) {
  const Mat3d turn(glm::dvec3(0.36, 0.48, -0.8), glm::dvec3(-0.8, 0.6, 0.0),
                   glm::dvec3(0.48, 0.64, 0.6));
  const Environment maps[] = {testing::random_map(64, 32, 11), testing::random_map(20, 9, 12),
                              testing::sunny_map(128, 64, 40, 50, 5e4f)};
  for (const Environment& map : maps) {
    const EnvironmentView turned = map.view(1.5, turn);
    std::vector<double> noise;
    for (const Vec3& normal : some_normals(20, 13)) {
      const Vec3d local = turn * Vec3d(normal);
      const double exact =
          1.5 * testing::integrate_map(map.view(), 8, [&](const Vec3d& l, const Vec3d& d) {
            return testing::luminance_of(l) * std::max(0.0, glm::dot(d, local));
          });
      const Sampler sampler(1, 2, 3);
      double sum = 0.0, squares = 0.0;
      constexpr int kCount = 1 << 16;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const auto s = sample_product(turned, map.product_table().view(), normal, Vec3(0.0f),
                                      sampler.bits_2d(8, i));
        const double x = luminance(s.radiance) / double{s.pdf} *
                         std::max(0.0, glm::dot(Vec3d(s.direction), Vec3d(normal)));
        sum += x;
        squares += x * x;
      }
      const double mean = sum / kCount;
      noise.push_back(squares / kCount / (mean * mean) - 1.0);
      EXPECT_NEAR(mean, exact, (2e-3 + 3.0 * std::sqrt(noise.back() / kCount)) * exact);
    }
    // What is left is how the cosine varies within a bin and a cell, and the share of the mean.
    std::nth_element(noise.begin(), noise.begin() + 10, noise.end());
    EXPECT_LT(noise[10], 0.25);
  }
}

TEST(ProductTable, NoLightNoSample) {
  std::vector<float> texels(64 * 32 * 3, 0.0f);
  for (std::size_t i = 0; i < 3; ++i) texels[3 * (64 * 30 + 5) + i] = 1.0f;  // near the zenith
  const Environment map("spot", 64, 32, texels);
  const auto down =
      sample_product(map.view(), map.product_table().view(), Vec3(0, 0, -1), Vec3(0.0f), {5, 7});
  EXPECT_EQ(down.pdf, 0.0f);
  EXPECT_EQ(product_pdf(map.view(), map.product_table().view(), Vec3(0, 0, -1), Vec3(0.0f),
                        Vec3(0, 0, 1)),
            0.0f);
  const auto up =
      sample_product(map.view(), map.product_table().view(), Vec3(0, 0, 1), Vec3(0.0f), {5, 7});
  EXPECT_GT(up.pdf, 0.0f);
}

}  // namespace
}  // namespace komorebi
