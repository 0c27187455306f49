// A real map whose energy sits in a few texels: 69 % of it in 0.1 % of them.
#include <gtest/gtest.h>

#include <cmath>

#include "io/image.h"
#include "render/environment.h"
#include "support/convergence.h"
#include "support/direction_test.h"
#include "support/environment_maps.h"
#include "support/shared_data.h"

namespace komorebi {
namespace {

using testing::estimated_power;
using testing::exact_power;
using testing::integrate_map;
using testing::luminance_of;

class RooitouPark : public ::testing::Test {
 protected:
  static constexpr const char* kFile = "data/hdri/rooitou_park_1k.hdr";
  static Environment load(const std::string& path) {
    Image image = read_image(path);
    return Environment(path, image.width, image.height, std::move(image.pixels));
  }
};

TEST_F(RooitouPark, FollowsItsDensity) {
  KOMOREBI_SHARED_FILE(path, kFile);
  const Environment map = load(path);
  const EnvironmentView e = map.view();
  // blocks of 8 × 9 patches; inside one the density varies a thousandfold, so each patch counts
  std::vector<double> expected;
  constexpr std::uint32_t kColumns = 128;
  expected.resize(kColumns * 57, 0.0);
  const auto block = [&](std::uint32_t column, std::uint32_t row) {
    return std::size_t{row / 9} * kColumns + column / 8;
  };
  double total = 0.0;
  constexpr int kCount = 4000000;
  for (std::uint32_t r = 0; r <= e.height; ++r) {
    const double z = 0.5 * (e.row_z[r] + e.row_z[r + 1]), radius = std::sqrt((1.0 - z) * (1.0 + z));
    for (std::uint32_t c = 0; c < e.width; ++c) {
      const double phi = 2.0 * kPi * (0.5 - (c + 1.0) / e.width);
      const Vec3 d(Vec3d(radius * std::cos(phi), radius * std::sin(phi), z));
      const double p =
          environment_pdf(e, d) * (2.0 * kPi / e.width) * (e.row_z[r + 1] - e.row_z[r]);
      total += p;
      expected[block(c, r)] += p * kCount;
    }
  }
  EXPECT_NEAR(total, 1.0, 1e-5);
  std::vector<std::uint64_t> observed(expected.size(), 0);
  testing::RandomBits random(12);
  for (int i = 0; i < kCount; ++i) {
    const auto at = detail::locate(e, sample_environment(e, random.next()).direction);
    ++observed[block(at.patch.column, at.patch.row)];
  }
  EXPECT_GT(testing::chi_square(observed, expected).p_value, 0.001);
}

TEST_F(RooitouPark, MeanEqualsExactSums) {
  KOMOREBI_SHARED_FILE(path, kFile);
  const Environment map = load(path);
  EXPECT_NEAR(estimated_power(map.view(), 1 << 16) / exact_power(map.view(), 4), 1.0, 1e-3);
}

// Irradiance on planes, unoccluded: the error falls at least as fast as n^-3/4, the rate for an
// integrand that is bent at the horizon, where independent points give n^-1/2.
TEST_F(RooitouPark, IrradianceConvergesAsTheorySays) {
  KOMOREBI_SHARED_FILE(path, kFile);
  const Environment map = load(path);
  const EnvironmentView e = map.view();
  for (const Vec3 n : {Vec3(0, 0, 1), Vec3(0.6f, 0.0f, 0.8f), Vec3(0, -1, 0)}) {
    const double exact = integrate_map(e, 4, [&](const Vec3d& l, const Vec3d& d) {
      return luminance_of(l) * std::max(0.0, glm::dot(d, Vec3d(n)));
    });
    const double slope =
        testing::convergence_slope(4, 12, 256, [&](std::uint32_t pixel, std::uint32_t count) {
          const Sampler sampler(0, pixel, 5);
          double sum = 0.0;
          for (std::uint32_t i = 0; i < count; ++i) {
            const auto s = sample_environment(e, sampler.bits_2d(8, i));
            sum += luminance(s.radiance) * std::max(0.0f, glm::dot(s.direction, n)) / double{s.pdf};
          }
          return sum / count / exact - 1.0;
        });
    RecordProperty("slope", std::to_string(slope));
    EXPECT_LT(slope, -0.75);
  }
}

}  // namespace
}  // namespace komorebi
