// Fast GI in an open cavity, by formulas: from a point of a sphere the cosine sees every other
// part of it alike, so that a chord is longer than d with probability 1 − d²/4.

#include <gtest/gtest.h>

#include "support/cavity.h"

namespace komorebi::testing {
namespace {

constexpr double kPi = glm::pi<double>();
constexpr int kRings = 64, kCut = 16;
constexpr double kAlbedo = 0.7, kSky = 0.5, kDistance = 1.0, kFactor = 0.6;

/// The bottom of a cavity is in view, further from the hole than the distance.
std::shared_ptr<Scene> bottom_of_cavity() {
  return committed(make_scene({{cavity(kRings, kCut).mesh}},
                              camera_at({0.1, 0.1, 0.2}, {0.05, 0.1, -1}, 24, 16),
                              Vec3(static_cast<float>(kSky))));
}

/// What a point of the wall sees past what is nearer than the distance: mean over the wall.
double seen_by_wall() {
  constexpr int kSteps = 96;
  const double rim = std::cos(kPi * kCut / kRings), near = 1.0 - 0.5 * kDistance * kDistance;
  double hidden = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = -1.0 + (rim + 1.0) * (i + 0.5) / kSteps;  // of the point
    for (int j = 0; j < kSteps; ++j) {
      const double c = near + (1.0 - near) * (j + 0.5) / kSteps;  // to the other, from the middle
      const double across = std::sqrt((1.0 - z * z) * (1.0 - c * c));
      for (int k = 0; k < kSteps; ++k) {
        hidden += z * c + across * std::cos(2.0 * kPi * (k + 0.5) / kSteps) < rim ? 1.0 : 0.0;
      }
    }
  }
  return 1.0 - hidden / std::pow(kSteps, 3) * 0.5 * (1.0 - near);
}

Settings fast_gi(FastGiMethod method, std::uint32_t bounces) {
  Settings s;
  s.method = Method::kWorldLight;
  s.clay_color = Vec3(static_cast<float>(kAlbedo));
  s.samples = 256;
  s.bounces = bounces;
  s.use_fast_gi = true;
  s.fast_gi_method = method;
  s.fast_gi_distance = static_cast<float>(kDistance);
  s.fast_gi_factor = static_cast<float>(kFactor);
  return s;
}

void expect_light(const Settings& settings, double exact) {
  const Estimate e = estimate(render(bottom_of_cavity(), settings));
  EXPECT_NEAR(e.mean, exact, 4.0 * e.error + 2e-3 * exact);  // facets
  EXPECT_LT(e.error, 5e-3 * exact);
}

TEST(FastGi, ReplacesTheLastLightByAmbientOcclusion) {
  const double open = cavity(kRings, kCut).open, wall = seen_by_wall();
  ASSERT_GT(wall, open + 0.1);
  for (const std::uint32_t after : {1u, 2u, 4u}) {
    Settings settings = fast_gi(FastGiMethod::kReplace, 9);
    settings.fast_gi_bounces = after;
    const double whole = after > 1 ? cavity_light(kAlbedo, kAlbedo, open, after - 2) : 0.0;
    const double reached = kAlbedo * std::pow(kAlbedo * (1.0 - open), after - 1);
    const double seen = after > 1 ? wall : 1.0 - 0.25 * kDistance * kDistance;
    expect_light(settings, kSky * (whole + reached * kFactor * seen));
  }
}

TEST(FastGi, AddsWhiteLightAtEveryVertex) {
  const double open = cavity(kRings, kCut).open, wall = seen_by_wall();
  for (const std::uint32_t bounces : {0u, 1u, 3u}) {
    double added = kAlbedo * (1.0 - 0.25 * kDistance * kDistance);
    for (std::uint32_t i = 1; i <= bounces; ++i) {
      added += kAlbedo * std::pow(kAlbedo * (1.0 - open), i) * wall;
    }
    expect_light(fast_gi(FastGiMethod::kAdd, bounces),
                 kSky * cavity_light(kAlbedo, kAlbedo, open, bounces) + kFactor * added);
  }
}

TEST(FastGi, IsOffWhereItHasNothingToSay) {
  const auto scene = bottom_of_cavity();
  Settings off = fast_gi(FastGiMethod::kReplace, 1);
  off.samples = 4;
  Settings on = off;
  off.use_fast_gi = false;
  const auto plain = render(scene, off);
  EXPECT_NE(render(scene, on), plain);
  on.fast_gi_bounces = 0;
  EXPECT_EQ(render(scene, on), plain);
  on.fast_gi_bounces = 3;  // paths do not come so far
  EXPECT_EQ(render(scene, on), plain);
  on.fast_gi_bounces = 1;
  on.fast_gi_factor = 0.0f;
  EXPECT_EQ(render(scene, on), plain);
  on.fast_gi_method = FastGiMethod::kAdd;
  EXPECT_EQ(render(scene, on), plain);
  on = fast_gi(FastGiMethod::kAdd, 1);
  on.samples = 4;
  on.method = off.method = Method::kAmbientOcclusion;
  EXPECT_EQ(render(scene, on), render(scene, off));
}

TEST(FastGi, OfBadNumbersIsRefused) {
  for (const float bad : {-1.0f, std::nanf("")}) {
    Settings settings = fast_gi(FastGiMethod::kAdd, 1);
    settings.fast_gi_distance = bad;
    EXPECT_THROW(check_settings(settings, 8, 8), std::invalid_argument);
    settings = fast_gi(FastGiMethod::kAdd, 1);
    settings.fast_gi_factor = bad;
    EXPECT_THROW(check_settings(settings, 8, 8), std::invalid_argument);
  }
}

}  // namespace
}  // namespace komorebi::testing
