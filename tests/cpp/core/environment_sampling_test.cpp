// The inverse transform of a map: against exact sums, against its own density, and its convergence.
#include <gtest/gtest.h>

#include <cmath>

#include "render/environment.h"
#include "support/direction_test.h"
#include "support/environment_maps.h"

namespace komorebi {
namespace {

using testing::estimated_power;
using testing::exact_power;
using testing::random_map;
using testing::sunny_map;

// A grid of whole patches, each cut in 2 × 2 in (u, z). The density is bilinear in a cell, so its
// value in the middle is its mean there.
struct PatchGrid {
  const EnvironmentView& e;
  std::uint32_t columns() const { return 2 * e.width; }
  std::uint32_t rows() const { return 2 * (e.height + 1); }

  double z_edge(std::uint32_t r) const {
    return r % 2 == 0 ? e.row_z[r / 2] : 0.5 * (e.row_z[r / 2] + e.row_z[r / 2 + 1]);
  }
  std::size_t cell(const Vec3& world) const {
    const Vec3d d(e.texture_from_world * world);
    double x = (0.5 - std::atan2(d.y, d.x) / (2.0 * kPi)) * e.width - 0.5;
    if (x < 0.0) x += e.width;
    const auto column = std::min(static_cast<std::uint32_t>(2.0 * x), columns() - 1);
    std::uint32_t row = 0;
    const double z = d.z / glm::length(d);
    while (row + 1 < rows() && z >= z_edge(row + 1)) ++row;
    return std::size_t{row} * columns() + column;
  }
  std::vector<double> expected() const {
    std::vector<double> result;
    for (std::uint32_t r = 0; r < rows(); ++r) {
      const double z = 0.5 * (z_edge(r) + z_edge(r + 1)), radius = std::sqrt(1.0 - z * z);
      const double solid_angle = 2.0 * kPi / columns() * (z_edge(r + 1) - z_edge(r));
      for (std::uint32_t c = 0; c < columns(); ++c) {
        const double phi = 2.0 * kPi * (0.5 - (0.5 * (c + 0.5) + 0.5) / e.width);
        const Vec3 texture(Vec3d(radius * std::cos(phi), radius * std::sin(phi), z));
        result.push_back(environment_pdf(e, glm::transpose(e.texture_from_world) * texture) *
                         solid_angle);
      }
    }
    return result;
  }
};

void expect_samples_follow_density(const EnvironmentView& e, int count, std::uint64_t seed) {
  const PatchGrid grid{e};
  std::vector<double> expected = grid.expected();
  double total = 0.0;
  for (double& p : expected) total += p, p *= count;
  EXPECT_NEAR(total, 1.0, 1e-5);
  std::vector<std::uint64_t> observed(expected.size(), 0);
  testing::RandomBits random(seed);
  for (int i = 0; i < count; ++i)
    ++observed[grid.cell(sample_environment(e, random.next()).direction)];
  // a float direction may land in the cell beside a bright one, where nothing is expected
  const auto result = testing::chi_square(observed, expected);
  EXPECT_GT(result.p_value, testing::sidak(0.01, 8))
      << result.statistic << " of " << result.degrees;
}

const Mat3d kTurn(glm::dvec3(0.36, 0.48, -0.8), glm::dvec3(-0.8, 0.6, 0.0),
                  glm::dvec3(0.48, 0.64, 0.6));

TEST(EnvironmentSampling, FollowsItsDensity) {
  expect_samples_follow_density(random_map(32, 16, 1).view(), 2000000, 1);
}
TEST(EnvironmentSampling, FollowsItsDensityOddSizes) {
  expect_samples_follow_density(random_map(13, 7, 2).view(), 1000000, 2);
  expect_samples_follow_density(random_map(1, 2, 3).view(), 1000000, 3);
}
TEST(EnvironmentSampling, FollowsItsDensityRotated) {
  const Environment map = random_map(32, 16, 4);
  expect_samples_follow_density(map.view(3.0, kTurn), 2000000, 4);
}
TEST(EnvironmentSampling, FollowsItsDensityWithASun) {
  const Environment map = sunny_map(64, 32, 20, 9, 1e4f);
  expect_samples_follow_density(map.view(), 2000000, 5);
}
TEST(EnvironmentSampling, FollowsItsDensityWithASunAtThePole) {
  const Environment map = sunny_map(16, 8, 15, 7, 1e3f, 0.1f);
  expect_samples_follow_density(map.view(1.0, kTurn), 2000000, 6);
}

TEST(EnvironmentSampling, MeanEqualsExactSums) {
  const Environment maps[] = {random_map(32, 16, 1), random_map(5, 3, 2),
                              sunny_map(64, 32, 0, 31, 1e6f), sunny_map(64, 32, 63, 16, 1e9f)};
  for (const Environment& map : maps) {
    const double exact = exact_power(map.view(), 64);
    EXPECT_NEAR(estimated_power(map.view(), 1 << 16) / exact, 1.0, 1e-4);
  }
}

// The share of the energy in the dim sky must be found too, whatever the sun: directions more than
// 0.3 from it, weighed by 1 / pdf, must give the sky's solid angle × radiance.
TEST(EnvironmentSampling, ExactBesideAnOverwhelmingSun) {
  const Environment map = sunny_map(128, 64, 40, 40, 3e7f, 1.0f);
  const EnvironmentView e = map.view();
  const Vec3 sun = direction_from_equirectangular(Vec2(40.5f / 128, 40.5f / 64));
  double sum = 0.0, square = 0.0;
  constexpr int kCount = 1 << 22;
  testing::RandomBits random(8);
  for (int i = 0; i < kCount; ++i) {
    const auto s = sample_environment(e, random.next());
    const double value =
        glm::dot(s.direction, sun) < 0.95f ? luminance(s.radiance) / double{s.pdf} : 0.0;
    sum += value, square += value * value;
  }
  const double mean = sum / kCount, error = std::sqrt((square / kCount - mean * mean) / kCount);
  EXPECT_NEAR(mean, 2.0 * kPi * 1.95, 4.0 * error);
  EXPECT_LT(error, 0.1 * mean);
}

// The whole numbers that choose a patch are those that its density is made of, down to the
// smallest.
TEST(EnvironmentSampling, EveryPatchIsChosenByItsOwnUnits) {
  for (const Environment& map : {sunny_map(64, 32, 40, 20, 1e12f), random_map(33, 17, 7)}) {
    const EnvironmentView e = map.view();
    const auto check = [](const std::uint32_t* cdf, std::uint32_t count) {
      ASSERT_EQ(cdf[0], 0u);
      ASSERT_EQ(cdf[count], 1u << 31);
      for (std::uint32_t i = 0; i < count; ++i) {
        ASSERT_LE(cdf[i], cdf[i + 1]);
        if (cdf[i] == cdf[i + 1]) continue;
        const auto first = detail::find_in_cdf(cdf, count, 2 * cdf[i]);
        const auto last = detail::find_in_cdf(cdf, count, 2 * cdf[i + 1] - 1);
        ASSERT_EQ(first.entry, i);
        ASSERT_EQ(last.entry, i);
        ASSERT_GE(first.fraction, 0.0f);
        ASSERT_LT(last.fraction, 1.0f);
      }
    };
    check(e.row_cdf, e.height + 1);
    for (std::uint32_t row = 0; row <= e.height; ++row) {
      check(detail::patch_columns(e, row), e.width);
      for (std::uint32_t column = 0; column < e.width; ++column) {
        const auto patch = detail::environment_patch(e, row, column);
        const Vec3 sum = patch.low_left + patch.low_right + patch.high_left + patch.high_right;
        const std::uint32_t* cdf = detail::patch_columns(e, row) + column;
        ASSERT_EQ(luminance(sum) > 0.0f, cdf[1] > cdf[0] && e.row_cdf[row + 1] > e.row_cdf[row]);
      }
    }
  }
}

// All 32 bits count: in a row that a sun rules, columns of a few units of 2^-31 are met.
TEST(EnvironmentSampling, SmallestPatchesAreMet) {
  const Environment map = sunny_map(64, 32, 40, 20, 1e12f);
  const EnvironmentView e = map.view();
  const std::uint32_t row = 20;  // between texel rows 19 and 20
  const std::uint32_t* cdf = detail::patch_columns(e, row);
  const std::uint32_t middle = e.row_cdf[row] + e.row_cdf[row + 1];
  int small = 0;
  for (std::uint32_t column = 0; column < 64; ++column) {
    if (cdf[column + 1] - cdf[column] > 8) continue;
    ++small;
    const auto sample = sample_environment(e, {cdf[column] + cdf[column + 1], middle});
    EXPECT_EQ(detail::locate(e, sample.direction).patch.column, column);
  }
  EXPECT_EQ(small, 62);  // all but the two beside the sun
}

TEST(EnvironmentSampling, DensityIsPositiveWhereverRadianceIs) {
  const Environment maps[] = {
      random_map(32, 16, 1), sunny_map(8, 4, 0, 0, 1.0f, 0.0f), sunny_map(8, 4, 7, 3, 1e-30f, 0.0f),
      sunny_map(1, 2, 0, 1, 1.0f, 0.0f), sunny_map(256, 128, 9, 9, 1e30f, 1e-5f)};
  for (const Environment& map : maps) {
    const EnvironmentView e = map.view();
    testing::RandomBits random(9);
    for (int i = 0; i < 200000; ++i) {
      Vec3 d = uniform_sphere(random.next_2d());
      if (i % 3 == 0)
        d = Vec3(glm::normalize(Vec3d(d) * Vec3d(1e-3, 1e-3, 1.0)));  // near the poles
      const auto value = evaluate_environment(e, d);
      ASSERT_TRUE(std::isfinite(value.pdf));
      const bool shines = luminance(value.radiance) > 0.0f;
      ASSERT_TRUE(!shines || value.pdf > 0.0f) << d.x << ' ' << d.y << ' ' << d.z;
    }
    for (const Vec3 pole : {Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
      const auto value = evaluate_environment(e, pole);
      EXPECT_EQ(luminance(value.radiance) > 0.0f, value.pdf > 0.0f);
    }
  }
}

// A sample says the same of itself as a look-up of its direction does.
TEST(EnvironmentSampling, SampleAgreesWithLookUp) {
  for (const Environment& map : {random_map(32, 16, 1), random_map(1024, 512, 2)}) {
    const EnvironmentView e = map.view(2.0, kTurn);
    testing::RandomBits random(10);
    int far = 0;
    for (int i = 0; i < 100000; ++i) {
      const auto s = sample_environment(e, random.next());
      ASSERT_NEAR(glm::length(Vec3d(s.direction)), 1.0, 4e-7);
      ASSERT_GT(s.pdf, 0.0f);
      const auto value = evaluate_environment(e, s.direction);
      far += std::abs(value.pdf / s.pdf - 1.0f) > 0.01f;
      for (int c = 0; c < 3; ++c)
        far += std::abs(value.radiance[c] - s.radiance[c]) > 0.01f * s.radiance[c];
    }
    EXPECT_LT(far, 100);  // next to black texels relative change has no bound
  }
}

// pdf · |det J| = 1 within patches, the map from bits to directions being smooth there.
TEST(EnvironmentSampling, DensityTimesJacobianIsOne) {
  const Environment map = random_map(8, 4, 5);
  const EnvironmentView e = map.view();
  const auto bits = [](double u, double v) {
    return Bits2{static_cast<std::uint32_t>(u * 4294967296.0),
                 static_cast<std::uint32_t>(v * 4294967296.0)};
  };
  const auto at = [&](double u, double v) { return sample_environment(e, bits(u, v)).direction; };
  const double h = 1.0 / 8192.0;
  testing::RandomBits random(11);
  int tested = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec2 p = random.next_2d() * 0.99f + 0.005f;
    const double u = p.x, v = p.y;
    const auto patch = [&](double x, double y) {
      const Bits2 b = bits(x, y);
      const std::uint32_t row = detail::find_in_cdf(e.row_cdf, e.height + 1, b.y).entry;
      const auto column = detail::find_in_cdf(detail::patch_columns(e, row), e.width, b.x);
      const bool inner = column.fraction > 0.1f && column.fraction < 0.9f;
      return inner ? row * e.width + column.entry : kNone;
    };
    const std::uint32_t here = patch(u, v);
    if (here == kNone || patch(u + h, v) != here || patch(u - h, v) != here ||
        patch(u, v + h) != here || patch(u, v - h) != here) {
      continue;
    }
    const double pdf = sample_environment(e, bits(u, v)).pdf;
    EXPECT_NEAR(pdf * testing::jacobian(at, u, v, h), 1.0, 0.01);
    ++tested;
  }
  EXPECT_GT(tested, 1000);
}

TEST(EnvironmentSampling, IsMonotoneInBothCoordinates) {
  const Environment map = random_map(16, 8, 6);
  const EnvironmentView e = map.view();
  float last = -1.0f;
  for (std::uint32_t i = 0; i < 65536; ++i) {
    const Vec3 d = sample_environment(e, {0x12345678u, i << 16}).direction;
    const auto row = detail::find_in_cdf(e.row_cdf, e.height + 1, i << 16).entry;
    ASSERT_GE(d.z, e.row_z[row] - 1e-6);
    ASSERT_LE(d.z, e.row_z[row + 1] + 1e-6);
  }
  for (std::uint32_t i = 0; i < 65536; ++i) {
    const Vec2 uv =
        equirectangular_from_direction(sample_environment(e, {i << 16, 0x7654321u}).direction);
    const float x = uv.x < 0.5f / 16.0f ? uv.x + 1.0f : uv.x;
    ASSERT_GE(x, last - 1e-6f);
    last = x;
  }
}

}  // namespace
}  // namespace komorebi
