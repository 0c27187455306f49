// Ambient occlusion and sky light against formulas: the mean over a probe's pixels must lie within
// four standard errors (and the stated size of the approximation) of the exact value.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/made_curves.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

// Half width of "infinite" planes, 10⁴ times the distance of the point: what they leave open is
// about 10⁻⁴ of the sky, and so is what the float grid of such a plane's points does.
constexpr double kHuge = 1e4;
constexpr double kPlaneTolerance = 5e-4;

Settings ao_settings(AoSampling sampling) {
  Settings s;
  s.samples = 256;
  s.ao_sampling = sampling;
  s.pixel_filter = PixelFilter::kBox;
  return s;
}

Polygons ground() {
  return quad({-kHuge, -kHuge, 0}, {2 * kHuge, 0, 0}, {0, 2 * kHuge, 0});
}

void expect_value(const std::shared_ptr<Scene>& scene, const Settings& settings, double exact,
                  double tolerance) {
  const Estimate e = estimate(render(scene, settings));
  EXPECT_NEAR(e.mean, exact, 4.0 * e.error + tolerance) << "standard error " << e.error;
  EXPECT_LT(e.error, 0.01);  // a picture of pure noise may not pass
}

class ClosedForm : public ::testing::TestWithParam<AoSampling> {};

TEST_P(ClosedForm, PlaneBesideTangentSphere) {
  // A unit sphere stands on the plane. Seen from the plane at distance r its cosine-weighted share
  // is cos θ sin² α = (1/d)(1/d²), d² = 1 + r².
  const auto ball = sphere(96, {0, 0, 1}, 1.0, false).mesh();
  const auto plane = quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}).mesh();
  for (const double r : {1.0, 2.0, 5.0}) {
    const double d = std::sqrt(1.0 + r * r);
    const auto scene =
        committed(make_scene({{ball}, {plane}}, probe_at({r, 0, 0}, {0, 0, 1}, 1e-3)));
    // The polyhedron's silhouette lies within the sphere's: its share is smaller by about 4e-4.
    expect_value(scene, ao_settings(GetParam()), 1.0 - 1.0 / (d * d * d), 1e-3 / (d * d * d));
  }
}

TEST_P(ClosedForm, PlaneBesideTangentSphereThatIsAPoint) {
  const std::vector<float> at = {0, 0, 1}, radius = {1};
  const auto ball =
      Mesh::build(PointsInput{"ball", at, radius}, Builder::kSah, shared_pool(), Cancel());
  const auto plane = quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}).mesh();
  for (const double r : {1.0, 2.0, 5.0}) {
    const double d = std::sqrt(1.0 + r * r);
    const auto scene =
        committed(make_scene({{ball}, {plane}}, probe_at({r, 0, 0}, {0, 0, 1}, 1e-3)));
    expect_value(scene, ao_settings(GetParam()), 1.0 - 1.0 / (d * d * d), 1e-5);
  }
}

TEST_P(ClosedForm, PlaneUnderALongCurve) {
  // Right under a long horizontal cylinder of radius r, its axis at height h, the plane loses r / h
  // of its light; a ribbon, which turns to every ray, covers the same.
  for (const CurveShape shape :
       {CurveShape::kRibbon, CurveShape::kThick, CurveShape::kThickLinear}) {
    Curves curve;
    curve.shape = shape;
    for (int k = -20; k <= 20; ++k) curve.key({20.0 * k, 0, 1}, 0.25);
    curve.end_curve();
    const auto hair = Mesh::build(curve.input(), Builder::kSah, shared_pool(), Cancel());
    const auto plane = quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}).mesh();
    // The camera is under the curve.
    CameraDesc probe = probe_at({0.3, 0, 0}, {0, 0, 1}, 1e-3);
    probe.clip_start = 0.6;
    probe.clip_from_world = glm::ortho(-1e-3, 1e-3, -1e-3, 1e-3, 0.6, 1.5) *
                            glm::lookAt(Vec3d(0.3, 0, 1), Vec3d(0.3, 0, 0), Vec3d(0, 1, 0));
    const auto scene = committed(make_scene({{hair}, {plane}}, probe));
    expect_value(scene, ao_settings(GetParam()), 0.75, 1e-5);
  }
}

TEST_P(ClosedForm, ACurveAloneSeesAllOfTheSky) {
  // A straight curve shadows none of its own surface, at any scale and 10 km from the origin.
  for (const CurveShape shape :
       {CurveShape::kRibbon, CurveShape::kThick, CurveShape::kThickLinear}) {
    for (const auto& [scale, far] : {std::pair{1.0, 0.0}, {1e-4, 0.0}, {1.0, 1e4}}) {
      Curves curve;
      curve.shape = shape;
      for (int k = 0; k < 6; ++k) curve.key(Vec3d(0.3 * k - 0.75, 0, 0.1 * k), 0.1);
      curve.end_curve();
      const auto hair = Mesh::build(curve.input(), Builder::kSah, shared_pool(), Cancel());
      const Vec3d place(far, -far, 0.3 * far);
      const Mat4d put = glm::scale(glm::translate(Mat4d(1.0), place), Vec3d(scale));
      const auto scene = committed(
          make_scene({{hair, put}},
                     camera_at(place + scale * Vec3d(1, -3, 2), place, 48, 32, scale), Vec3(0.5f)));
      Settings settings = ao_settings(GetParam());
      settings.samples = 16;
      settings.method = Method::kWorldLight;
      settings.environment_sampling = EnvironmentSampling::kCosine;
      settings.clay_color = Vec3(1.0f);
      const std::vector<float> rgba = render(scene, settings);
      for (std::size_t i = 0; i < rgba.size(); i += 4) {
        ASSERT_NEAR(rgba[i], 0.5f, 1e-5f) << i / 4 << ", scale " << scale << ", far " << far;
      }
      const std::vector<float> depth = render(scene, settings, "Depth");
      EXPECT_GT(std::count_if(depth.begin(), depth.end(), [](float d) { return d < 1e9f; }), 60);
    }
  }
}

TEST_P(ClosedForm, InsideCornerOfTwoPlanes) {
  const auto floor = ground().mesh();
  const auto wall = quad({0, -kHuge, 0}, {0, 2 * kHuge, 0}, {0, 0, kHuge}).mesh();
  const auto scene =
      committed(make_scene({{floor}, {wall}}, probe_at({-1, 0, 0}, {0, 0, 1}, 1e-2)));
  expect_value(scene, ao_settings(GetParam()), 0.5, kPlaneTolerance);
}

TEST_P(ClosedForm, InsideCornerOfThreePlanes) {
  const auto floor = ground().mesh();
  const auto wall_x = quad({0, -kHuge, 0}, {0, 2 * kHuge, 0}, {0, 0, kHuge}).mesh();
  const auto wall_y = quad({-kHuge, 0, 0}, {2 * kHuge, 0, 0}, {0, 0, kHuge}).mesh();
  const auto scene =
      committed(make_scene({{floor}, {wall_x}, {wall_y}}, probe_at({-1, -1, 0}, {0, 0, 1}, 1e-2)));
  expect_value(scene, ao_settings(GetParam()), 0.25, kPlaneTolerance);
}

TEST_P(ClosedForm, PointUnderDisk) {
  // A disk of radius 1 at height h above the point covers sin² α = 1 / (1 + h²).
  Polygons disk;
  constexpr int kCorners = 1000;
  const auto centre = disk.vertex({0, 0, 0.5});
  for (int i = 0; i < kCorners; ++i) {
    const double phi = 2.0 * glm::pi<double>() * i / kCorners;
    disk.vertex({std::cos(phi), std::sin(phi), 0.5});
  }
  for (int i = 0; i < kCorners; ++i) disk.face({centre, 1 + i, 1 + (i + 1) % kCorners});
  // The camera is under the disk; the floor is seen through the orthographic probe from 0.4 up.
  CameraDesc probe = probe_at({0, 0, 0}, {0, 0, 1}, 1e-3);
  probe.clip_start = 0.6;
  probe.clip_from_world = glm::ortho(-1e-3, 1e-3, -1e-3, 1e-3, 0.6, 1.5) *
                          glm::lookAt(Vec3d(0, 0, 1), Vec3d(0, 0, 0), Vec3d(0, 1, 0));
  const auto floor = quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}).mesh();
  const auto scene = committed(make_scene({{floor}, {disk.mesh()}}, probe));
  expect_value(scene, ao_settings(GetParam()), 1.0 - 1.0 / 1.25, 1e-4);
}

TEST_P(ClosedForm, DistanceLimitLetsTheFarDiskThrough) {
  const auto roof = quad({-10, -10, 2}, {20, 0, 0}, {0, 20, 0}).mesh();
  CameraDesc probe = probe_at({0, 0, 0}, {0, 0, 1}, 1e-3);
  const auto floor = quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}).mesh();
  const auto scene = committed(make_scene({{floor}, {roof}}, probe));
  Settings settings = ao_settings(GetParam());
  settings.ao_distance = 1.9f;
  const Estimate open = estimate(render(scene, settings));
  EXPECT_NEAR(open.mean, 1.0, 4.0 * open.error + 1e-9);
  // Within t the roof at height h covers the cone cos θ > h / t: sin² of that angle.
  settings.ao_distance = 4.0f;
  expect_value(scene, settings, 1.0 - 0.75, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Sampling, ClosedForm,
                         ::testing::Values(AoSampling::kCosine, AoSampling::kUniform),
                         [](const auto& p) {
                           return p.param == AoSampling::kCosine ? "Cosine" : "Uniform";
                         });

/// Everywhere on a convex body the sky is open: exactly 1, not nearly. One self-hit would show.
TEST(ConvexBody, SeesTheWholeSkyAtEveryScaleAndPlace) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const double away : {0.0, 1e4}) {
      const Vec3d centre(away, -away, 0.5 * away);
      const auto ball = sphere(32, Vec3d(0), scale, false).mesh();
      const Mat4d place = glm::translate(Mat4d(1.0), centre);
      const auto scene = committed(make_scene(
          {{ball, place}}, camera_at(centre + scale * Vec3d(3, -2, 1), centre, 96, 96, scale),
          Vec3(1.0f)));
      Settings settings;
      settings.samples = 16;
      const auto picture = render(scene, settings);
      for (std::size_t i = 0; i < picture.size(); i += 4) {
        ASSERT_EQ(picture[i], 1.0f)
            << "scale " << scale << ", away " << away << ", pixel " << i / 4;
      }
    }
  }
}

/// A body whose own vertices lie 10 km from its object's origin, as after "apply transform".
TEST(ConvexBody, SeesTheWholeSkyWhenItsVerticesAreFarFromTheOrigin) {
  const Vec3d centre(1e4, 1e4, 100.0);
  const auto body = box(centre - 1.0, centre + 1.0).mesh();
  const auto scene =
      committed(make_scene({{body}}, camera_at(centre + Vec3d(4, -3, 2), centre, 96, 96)));
  Settings settings;
  settings.samples = 16;
  for (const float value : render(scene, settings)) ASSERT_EQ(value, 1.0f);
}

/// Smooth shading of a polyhedron loses only what lies below the facets, never light from above.
TEST(ConvexBody, SmoothShadingStaysCloseToOne) {
  const auto ball = sphere(48, Vec3d(0), 1.0, true).mesh();
  const auto scene = committed(make_scene({{ball}}, camera_at({3, -2, 1}, Vec3d(0), 96, 96)));
  Settings settings;
  settings.samples = 64;
  const Estimate e = estimate(render(scene, settings));
  EXPECT_LT(e.mean, 1.0);
  EXPECT_GT(e.mean, 0.995);
}

/// No ray escapes a closed room through its seams.
TEST(ClosedRoom, IsBlack) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const auto room = sphere(48, Vec3d(0), scale, false).mesh();
    const auto scene =
        committed(make_scene({{room}}, camera_at(Vec3d(0), {scale, 0, 0}, 96, 96, scale * 0.1)));
    Settings settings;
    settings.samples = 16;
    const auto picture = render(scene, settings);
    for (std::size_t i = 0; i < picture.size(); i += 4) {
      ASSERT_EQ(picture[i], 0.0f) << "scale " << scale << ", pixel " << i / 4;
      ASSERT_EQ(picture[i + 3], 1.0f);
    }
  }
}

/// Nor from the very edges and corners, where a point may round to the other side of a wall.
TEST(ClosedRoom, IsBlackInItsCorners) {
  const auto room = box({-2, -2, -1.5}, {2, 2, 1.5}).mesh();
  for (const Vec3d& corner : {Vec3d(2, 2, 1.5), Vec3d(-2, 2, -1.5), Vec3d(2, -2, 0)}) {
    const Vec3d eye = corner * 0.9;
    const auto scene = committed(make_scene({{room}}, camera_at(eye, corner, 200, 200, 1e-3)));
    Settings settings;
    settings.samples = 32;
    for (const float value : render(scene, settings)) ASSERT_TRUE(value == 0.0f || value == 1.0f);
    const Estimate e = estimate(render(scene, settings));
    ASSERT_EQ(e.mean, 0.0);
  }
}

/// White furnace: a convex body of albedo 1 in a sky of 1 vanishes, whatever the sampling.
TEST(Furnace, AWhiteBodyVanishesInAWhiteWorld) {
  const auto ball = sphere(32, Vec3d(0), 1.0, false).mesh();
  const auto scene = committed(make_scene({{ball}}, camera_at({3, -2, 1}, Vec3d(0), 64, 64)));
  Settings settings;
  settings.method = Method::kWorldLight;
  settings.clay_color = Vec3(1.0f);
  settings.samples = 64;
  for (const auto sampling :
       {EnvironmentSampling::kProduct, EnvironmentSampling::kMis, EnvironmentSampling::kCosine}) {
    settings.environment_sampling = sampling;
    for (const float value : render(scene, settings)) ASSERT_NEAR(value, 1.0f, 1e-6f);
  }
  settings.environment_sampling = EnvironmentSampling::kEnvironment;
  const Estimate e = estimate(render(scene, settings));
  EXPECT_NEAR(e.mean, 1.0, 4.0 * e.error);
}

}  // namespace
}  // namespace komorebi::testing
