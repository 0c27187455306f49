// Look-up in equirectangular maps, and what the class does with odd ones.
#include "render/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/direction_test.h"
#include "support/environment_maps.h"

namespace komorebi {
namespace {

using testing::make_map;
using testing::random_map;

Vec3 texel_of(const EnvironmentView& e, std::uint32_t column, std::uint32_t row) {
  return detail::environment_texel(e, column, row);
}

Vec3 direction_at(double u, double v) {
  const double phi = 2.0 * kPi * (0.5 - u), latitude = kPi * (v - 0.5);
  return Vec3(Vec3d(std::cos(latitude) * std::cos(phi), std::cos(latitude) * std::sin(phi),
                    std::sin(latitude)));
}

TEST(Environment, AxesLieWhereBlenderDrawsThem) {
  // from the left edge: −X, +Y at a quarter, +X in the middle, −Y at three quarters, −X again
  const auto uv = [](Vec3 d) { return equirectangular_from_direction(d); };
  EXPECT_FLOAT_EQ(uv({1, 0, 0}).x, 0.5f);
  EXPECT_FLOAT_EQ(uv({0, 1, 0}).x, 0.25f);
  EXPECT_FLOAT_EQ(uv({0, -1, 0}).x, 0.75f);
  EXPECT_FLOAT_EQ(uv({-1, -1e-6f, 0}).x, 1.0f);
  EXPECT_NEAR(uv({-1, 1e-6f, 0}).x, 0.0f, 1e-6f);
  EXPECT_FLOAT_EQ(uv({1, 0, 0}).y, 0.5f);
  EXPECT_FLOAT_EQ(uv({0, 0, 1}).y, 1.0f);
  EXPECT_NEAR(uv({0, 0, -1}).y, 0.0f, 1e-7f);
}

TEST(Environment, DirectionsAndMapCoordinatesGoRound) {
  testing::RandomBits random(1);
  for (int i = 0; i < 100000; ++i) {
    const Vec2 uv = random.next_2d();
    const Vec3 d = direction_from_equirectangular(uv);
    ASSERT_NEAR(glm::length(Vec3d(d)), 1.0, 3e-7);
    ASSERT_LT(glm::length(Vec3d(d) - Vec3d(direction_at(uv.x, uv.y))), 6e-7);
    const Vec2 back = equirectangular_from_direction(d);
    const double from_pole = std::min(uv.y, 1.0f - uv.y);
    ASSERT_NEAR(back.y, uv.y, 2e-7);
    if (from_pole < 1e-4) continue;  // longitude means little there
    ASSERT_NEAR(std::remainder(double{back.x} - double{uv.x}, 1.0), 0.0, 3e-7 / from_pole);
  }
}

TEST(Environment, TexelCentresAreExact) {
  const Environment map = random_map(32, 16, 1);
  const EnvironmentView e = map.view();
  for (std::uint32_t row = 0; row < 16; ++row) {
    for (std::uint32_t column = 0; column < 32; ++column) {
      const Vec3 got = environment_radiance(e, direction_at((column + 0.5) / 32, (row + 0.5) / 16));
      const Vec3 want = texel_of(e, column, row);
      // a direction is a float: 1e-5 of a texel, and a neighbour may be a thousand times as bright
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], want[c], 1e-5 * 20.0 + 1e-5 * want[c]);
    }
  }
}

// Bilinear in doubles from the definition: at u·W − 1/2, v·H − 1/2, repeating both ways.
Vec3d bilinear(const EnvironmentView& e, double u, double v) {
  const double x = u * e.width - 0.5, y = v * e.height - 0.5;
  const double s = x - std::floor(x), t = y - std::floor(y);
  const auto at = [&](double column, double row) {
    const auto w = static_cast<long>(e.width), h = static_cast<long>(e.height);
    const long c = ((static_cast<long>(column) % w) + w) % w,
               r = ((static_cast<long>(row) % h) + h) % h;
    return Vec3d(texel_of(e, static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(r)));
  };
  const double c = std::floor(x), r = std::floor(y);
  return (1 - t) * ((1 - s) * at(c, r) + s * at(c + 1, r)) +
         t * ((1 - s) * at(c, r + 1) + s * at(c + 1, r + 1));
}

TEST(Environment, IsBilinearAndRepeats) {
  for (const auto& [width, height] : {std::pair{32u, 16u}, {7u, 5u}, {2u, 1u}, {1u, 3u}}) {
    const Environment map = random_map(width, height, 2);
    const EnvironmentView e = map.view();
    testing::RandomBits random(3);
    for (int i = 0; i < 20000; ++i) {
      const Vec2 uv = i % 4 == 0
                          ? random.next_2d() * Vec2(1.0f / float(width), 1.0f / float(height))
                          : random.next_2d();
      const Vec3 got = environment_radiance(e, direction_at(uv.x, uv.y));
      const Vec3d want = bilinear(e, uv.x, uv.y);
      const double pole = std::min(uv.y, 1.0f - uv.y) + 1e-6;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(got[c], want[c], 2e-5 * 20.0 + 1e-5 / pole) << uv.x << ' ' << uv.y;
    }
  }
}

TEST(Environment, RotationTurnsTheMap) {
  const Environment map = random_map(16, 8, 3);
  const Mat3d turn(glm::dvec3(0.36, 0.48, -0.8), glm::dvec3(-0.8, 0.6, 0.0),
                   glm::dvec3(0.48, 0.64, 0.6));
  const EnvironmentView plain = map.view(), turned = map.view(1.0, turn);
  testing::RandomBits random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 world = uniform_sphere(random.next_2d());
    const Vec3 texture(turn * Vec3d(world));
    const Vec3 a = environment_radiance(turned, world), b = environment_radiance(plain, texture);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(a[c], b[c], 1e-3);
    const auto sample = sample_environment(turned, random.next());
    const Vec3 again = environment_radiance(turned, sample.direction);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(again[c], sample.radiance[c], 1e-3);
  }
}

TEST(Environment, StrengthScalesRadianceAlone) {
  const Environment map = random_map(16, 8, 3);
  const EnvironmentView one = map.view(1.0), four = map.view(4.0);
  testing::RandomBits random(4);
  for (int i = 0; i < 1000; ++i) {
    const Bits2 bits = random.next();
    const auto a = sample_environment(one, bits), b = sample_environment(four, bits);
    ASSERT_EQ(a.direction, b.direction);
    ASSERT_EQ(a.pdf, b.pdf);
    ASSERT_EQ(4.0f * a.radiance, b.radiance);
    ASSERT_EQ(environment_pdf(four, a.direction), environment_pdf(one, a.direction));
  }
}

TEST(Environment, BadTexelsAreMadeHarmlessAndCounted) {
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  const Environment map =
      make_map(3, 2, {1, 2, 3, nan, 5, 6, 7, -8, 9, inf, 1, 1, -1, -2, 3, 1, 1, -inf});
  EXPECT_EQ(map.nonfinite_texels(), 3u);
  EXPECT_EQ(map.negative_texels(), 2u);
  const EnvironmentView e = map.view();
  EXPECT_EQ(texel_of(e, 0, 0), Vec3(1, 2, 3));
  EXPECT_EQ(texel_of(e, 1, 0), Vec3(0, 0, 0));
  EXPECT_EQ(texel_of(e, 2, 0), Vec3(7, 0, 9));
  EXPECT_EQ(texel_of(e, 0, 1), Vec3(0, 0, 0));
  EXPECT_EQ(texel_of(e, 1, 1), Vec3(0, 0, 3));
}

TEST(Environment, NothingFiniteIsClamped) {
  const Environment map = make_map(1, 1, {3e38f, 1e38f, 1e-30f});
  const EnvironmentView e = map.view();
  EXPECT_EQ(environment_radiance(e, Vec3(1, 2, 3)), Vec3(3e38f, 1e38f, 1e-30f));
  const auto sample = sample_environment(e, {1u << 30, 77});
  EXPECT_NEAR(sample.pdf, kInvFourPi, 1e-6);
}

TEST(Environment, BlackMapIsAUniformSphere) {
  const Environment map = make_map(4, 2, std::vector<float>(24, 0.0f));
  EXPECT_TRUE(map.black());
  const EnvironmentView e = map.view(2.0);
  testing::RandomBits random(4);
  for (int i = 0; i < 100; ++i) {
    const auto sample = sample_environment(e, random.next());
    EXPECT_EQ(sample.radiance, Vec3(0.0f));
    EXPECT_EQ(sample.pdf, kInvFourPi);
    EXPECT_EQ(environment_pdf(e, sample.direction), kInvFourPi);
  }
}

TEST(Environment, OneTexelIsAUniformSphere) {
  const Environment map = make_map(1, 1, {0.2f, 0.4f, 0.6f});
  const EnvironmentView e = map.view();
  testing::RandomBits random(4);
  for (int i = 0; i < 1000; ++i) {
    const auto sample = sample_environment(e, random.next());
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sample.radiance[c], 0.2f + 0.2f * float(c), 1e-6);
    EXPECT_NEAR(sample.pdf, kInvFourPi, 1e-6);
    EXPECT_NEAR(environment_pdf(e, sample.direction), kInvFourPi, 1e-6);
  }
}

TEST(Environment, ConstantColour) {
  const EnvironmentView e = constant_environment(Vec3(1, 2, 3));
  EXPECT_EQ(environment_radiance(e, Vec3(0, 0, 1)), Vec3(1, 2, 3));
  EXPECT_EQ(evaluate_environment(e, Vec3(0, 1, 0)).pdf, kInvFourPi);
}

// No such direction should ever come; if one does, it must not read outside the map.
TEST(Environment, SenselessDirectionsAreHarmless) {
  const Environment map = random_map(4, 3, 1);
  const EnvironmentView e = map.view();
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  for (const Vec3 d :
       {Vec3(0.0f), Vec3(nan), Vec3(inf, 0, -inf), Vec3(0, 0, inf), Vec3(1e-45f, 0, 0)}) {
    const auto at = detail::locate(e, d);
    EXPECT_LT(at.patch.column, 4u);
    EXPECT_LE(at.patch.row, 3u);
  }
}

TEST(Environment, RefusesWhatDoesNotFit) {
  EXPECT_THROW(make_map(2, 2, {1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(make_map(0, 2, {}), std::invalid_argument);
  const Environment map = random_map(4, 2, 1);
  EXPECT_THROW(map.view(-1.0), std::invalid_argument);
  EXPECT_THROW(map.view(std::nan("")), std::invalid_argument);
  EXPECT_THROW(map.view(1.0, Mat3d(2.0)), std::invalid_argument);
  EXPECT_THROW(map.view(1.0, Mat3d(std::nan(""))), std::invalid_argument);
}

}  // namespace
}  // namespace komorebi
