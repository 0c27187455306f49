// What lamps light, in pictures: closed forms, shadows, and many of them.

#include <gtest/gtest.h>

#include "support/scenes.h"

namespace komorebi::testing {
namespace {

Settings lamp_settings(std::uint32_t samples = 64) {
  Settings s;
  s.method = Method::kWorldLight;
  s.samples = samples;
  s.light_samples = 2;
  s.clay_color = Vec3(1.0f);
  s.pixel_filter = PixelFilter::kBox;
  return s;
}

LampInput lamp_at(LampKind kind, double radiance, const Vec3d& place) {
  LampInput lamp;
  lamp.kind = kind;
  lamp.radiance = Vec3d(radiance);
  lamp.world_from_lamp = glm::translate(Mat4d(1.0), place);
  return lamp;
}

std::shared_ptr<Scene> lit(const std::vector<LampInput>& lamps,
                           const std::vector<Placed>& more = {}, const Vec3d& at = Vec3d(0.0)) {
  std::vector<Placed> parts = {{quad({-40, -40, 0}, {80, 0, 0}, {0, 80, 0}).mesh()}};
  parts.insert(parts.end(), more.begin(), more.end());
  auto scene = make_scene(parts, probe_at(at, {0, 0, 1}, 1e-3), Vec3(0.0f));
  for (const LampInput& lamp : lamps) scene->add_lamp(lamp);
  return committed(scene);
}

/// White diffuse radiance is irradiance / π.
void expect_irradiance(const std::shared_ptr<Scene>& scene, double exact, double tolerance = 2e-4,
                       const Settings& settings = lamp_settings()) {
  const Estimate e = estimate(render(scene, settings));
  EXPECT_NEAR(kPi * e.mean, exact, 4.0 * kPi * e.error + tolerance * exact) << e.error;
  EXPECT_LT(kPi * e.error, 0.02 * exact + 1e-9);
}

TEST(LampLight, OfASunGoesByTheCosine) {
  LampInput sun = lamp_at(LampKind::kDirection, 3.0, Vec3d(0.0));
  sun.world_from_lamp = glm::rotate(Mat4d(1.0), 1.0, Vec3d(1, 0, 0));
  expect_irradiance(lit({sun}), 3.0 * std::cos(1.0));
  sun.kind = LampKind::kSun;  // ∫ cos over a cone that is all above the surface: π sin² cos
  sun.angle = 0.5;
  expect_irradiance(lit({sun}), 3.0 * kPi * std::pow(std::sin(0.25), 2) * std::cos(1.0));
}

TEST(LampLight, OfBallsFallsWithTheSquareOfTheDistance) {
  for (const double radius : {0.01, 0.5, 1.9}) {
    LampInput ball = lamp_at(LampKind::kSphere, 5.0, {0, 0, 2});
    ball.radius = radius;
    expect_irradiance(lit({ball}), 5.0 * kPi * radius * radius / 4.0);
    ball.kind = LampKind::kDisk;
    expect_irradiance(lit({ball}), 5.0 * kPi * radius * radius / (4.0 + radius * radius));
  }
  const LampInput point = lamp_at(LampKind::kPoint, 5.0, {1.5, 0, 2});
  expect_irradiance(lit({point}), 5.0 * 2.0 / std::pow(2.5, 3));
}

TEST(LampLight, OfAreasIsTheFormFactor) {
  // Corner to parallel rectangle (a × b at height 1): Howell's catalogue, B-4; four times.
  const double a = 0.75, b = 0.4, s = std::sqrt(1 + a * a), t = std::sqrt(1 + b * b);
  const double corner = (a / s * std::atan(b / s) + b / t * std::atan(a / t)) / (2.0 * kPi);
  LampInput plate = lamp_at(LampKind::kRectangle, 5.0, {0, 0, 1});
  plate.size_u = 2 * a;
  plate.size_v = 2 * b;
  expect_irradiance(lit({plate}), 5.0 * kPi * 4.0 * corner);
  for (const double radius : {0.1, 1.0, 8.0}) {
    LampInput disk = lamp_at(LampKind::kEllipse, 5.0, {0, 0, 1});
    disk.size_u = disk.size_v = 2 * radius;
    expect_irradiance(lit({disk}), 5.0 * kPi * radius * radius / (1.0 + radius * radius));
  }
}

TEST(LampLight, IsShadowedUpToTheLampAlone) {
  const auto roof = quad({-3, -3, 1}, {6, 0, 0}, {0, 6, 0}).mesh();
  const LampInput above = lamp_at(LampKind::kPoint, 5.0, {0, 0, 2});
  const LampInput below = lamp_at(LampKind::kPoint, 5.0, {0, 0, 0.9});
  CameraDesc probe = probe_at({0, 0, 0}, {0, 0, 1}, 1e-3);
  probe.clip_from_world = glm::ortho(-1e-3, 1e-3, -1e-3, 1e-3, 0.1, 0.9) *
                          glm::lookAt(Vec3d(0, 0, 0.8), Vec3d(0.0), Vec3d(0, 1, 0));
  const auto render_with = [&](LampInput lamp, bool casts_shadow = true) {
    if (!casts_shadow) lamp.flags = kLampNoShadow;
    auto scene =
        make_scene({{quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh()}, {roof}}, probe, Vec3(0.0f));
    scene->add_lamp(lamp);
    return kPi * estimate(render(committed(scene), lamp_settings(4))).mean;
  };
  EXPECT_EQ(render_with(above), 0.0);
  EXPECT_NEAR(render_with(above, false), 5.0 / 4.0, 1e-4);
  EXPECT_NEAR(render_with(below), 5.0 / 0.81, 1e-4);
}

TEST(LampLight, OfManyIsTheSum) {
  // Chosen by a tree, one by one; and the world's light beside them.
  double sum = 0.0;
  std::vector<LampInput> lamps;
  for (int i = 0; i < 200; ++i) {
    const Vec3d place(std::sin(2.4 * i) * 0.1 * i, std::cos(2.4 * i) * 0.1 * i, 0.5 + i % 7);
    lamps.push_back(lamp_at(LampKind::kPoint, 0.1 + i % 3, place));
    sum += (0.1 + i % 3) * place.z / std::pow(glm::length(place), 3);
  }
  expect_irradiance(lit(lamps), sum, 2e-4, lamp_settings(512));
}

TEST(LampLight, FallsOffAsItsFalloffSays) {
  // Of a point the law itself; a disk overhead has points at distances √(h² + r²).
  const double d = 2.5, radius = 1.5, h = 2.0;
  for (const double power : {0.0, 1.0, 2.0}) {
    for (const double smooth : {0.0, 3.0}) {
      const auto falloff = [&](double at) {
        return std::pow(at, power) * at * at / (at * at + smooth);
      };
      LampInput point = lamp_at(LampKind::kPoint, 5.0, {1.5, 0, 2});
      point.falloff_power = power;
      point.falloff_smooth = smooth;
      expect_irradiance(lit({point}), 5.0 * 2.0 / std::pow(d, 3) * falloff(d));
      LampInput plate = lamp_at(LampKind::kEllipse, 5.0, {0, 0, h});
      plate.size_u = plate.size_v = 2.0 * radius;
      plate.falloff_power = power;
      plate.falloff_smooth = smooth;
      double sum = 0.0;
      constexpr int kSteps = 10000;
      for (int i = 0; i < kSteps; ++i) {
        const double r = radius * (i + 0.5) / kSteps, square = r * r + h * h;
        sum += falloff(std::sqrt(square)) * h * h / (square * square) * 2.0 * kPi * r * radius /
               kSteps;
      }
      expect_irradiance(lit({plate}), 5.0 * sum);
    }
  }
  LampInput sun = lamp_at(LampKind::kDirection, 3.0, Vec3d(0.0));
  sun.falloff_power = 2.0;
  expect_irradiance(lit({sun}), 3.0);
}

TEST(LampLight, OfManyWithAFalloffIsTheSum) {
  double sum = 0.0;
  std::vector<LampInput> lamps;
  for (int i = 0; i < 60; ++i) {
    const Vec3d place(std::sin(2.4 * i) * 0.1 * i, std::cos(2.4 * i) * 0.1 * i, 0.5 + i % 7);
    lamps.push_back(lamp_at(LampKind::kPoint, 0.1 + i % 3, place));
    lamps.back().falloff_power = i % 3;
    lamps.back().falloff_smooth = i % 2;
    const double d = glm::length(place);
    sum += (0.1 + i % 3) * place.z / std::pow(d, 3) * std::pow(d, i % 3) * d * d / (d * d + i % 2);
  }
  expect_irradiance(lit(lamps), sum, 2e-4, lamp_settings(512));
}

TEST(LampLight, EndsAfterItsBounces) {
  // A wall beside the point in view, which a lamp lights that the point does not see.
  const auto wall = quad({1, -2, 0}, {0, 4, 0}, {0, 0, 2}).mesh();
  const auto screen = quad({0.3, -2, 0.4}, {0, 4, 0}, {0, 0, 3}).mesh();
  LampInput lamp = lamp_at(LampKind::kPoint, 5.0, {0.6, 0, 3});
  Settings settings = lamp_settings(64);
  const auto seen = [&](std::uint32_t bounces, double most, std::size_t lamps) {
    settings.bounces = bounces;
    lamp.max_bounces = most;
    return render(lit(std::vector<LampInput>(lamps, lamp), {{wall}, {screen}}), settings);
  };
  for (const std::size_t lamps : {1u, 20u}) {  // 20 in a tree
    const auto once = seen(1, 1024.0, lamps), twice = seen(2, 1024.0, lamps);
    EXPECT_EQ(estimate(seen(2, 0.0, lamps)).mean, 0.0);
    EXPECT_GT(estimate(once).mean, 0.0);
    EXPECT_GT(estimate(twice).mean, 1.05 * estimate(once).mean);
    EXPECT_EQ(seen(1, 1.0, lamps), once);
    EXPECT_EQ(seen(2, 1.0, lamps), once);
    EXPECT_EQ(seen(2, 2.0, lamps), twice);
  }
}

TEST(LampLight, AmbientOcclusionHasNone) {
  Settings settings = lamp_settings(4);
  settings.method = Method::kAmbientOcclusion;
  const LampInput point = lamp_at(LampKind::kPoint, 5.0, {0, 0, 2});
  EXPECT_EQ(render(lit({point}), settings), render(lit({}), settings));
}

TEST(LampLight, MayBeNegative) {
  const LampInput bright = lamp_at(LampKind::kPoint, 5.0, {0, 0, 2});
  const LampInput dark = lamp_at(LampKind::kPoint, -2.0, {0, 0, 2});
  expect_irradiance(lit({bright, dark}), 3.0 / 4.0, 2e-4, lamp_settings(1024));
}

TEST(LampLight, FarFromTheOriginIsTheSame) {
  const Vec3d far(3e6, -2e6, 0.0);
  LampInput ball = lamp_at(LampKind::kSphere, 5.0, far + Vec3d(0, 0, 2));
  ball.radius = 0.5;
  const auto ground = quad({-40, -40, 0}, {80, 0, 0}, {0, 80, 0}).mesh();
  auto scene = make_scene({{ground, glm::translate(Mat4d(1.0), far)}},
                          probe_at(far, {0, 0, 1}, 1e-3), Vec3(0.0f));
  scene->add_lamp(ball);
  expect_irradiance(committed(scene), 5.0 * kPi * 0.25 / 4.0);
}

TEST(LampLight, NextToALampIsCountedWhereItIsClamped) {
  // A point without size at a hair's breadth: beyond the film's range, cut and counted.
  const auto scene = lit({lamp_at(LampKind::kPoint, 1.0, {0, 0, 1e-4})});
  Session session(scene, lamp_settings(1));
  ASSERT_TRUE(session.wait(60.0));
  EXPECT_GT(session.progress().clamped_samples, 0u);
  const auto near = lit({lamp_at(LampKind::kPoint, 1.0, {0, 0, 0.1})});
  expect_irradiance(near, 100.0);
}

}  // namespace
}  // namespace komorebi::testing
