// A camera in time: at each of its poses it is the camera that stands there.
#include <gtest/gtest.h>

#include <cmath>

#include "core/sampler.h"
#include "render/filter.h"
#include "render/one_ray.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

constexpr std::uint32_t kWidth = 150, kHeight = 90;

Mat4d pose(int step) {
  const double s = step;
  return glm::rotate(glm::translate(Mat4d(1.0), Vec3d(300.0 + s, -2.0 + 0.3 * s * s, 1.0)), 0.2 * s,
                     glm::normalize(Vec3d(1, 2, 0.5)));
}

CameraDesc camera_of(CameraKind kind, const Mat4d& world_from_camera, double zoom = 1.0) {
  CameraDesc camera;
  camera.kind = kind;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.clip_start = 0.1;
  camera.clip_end = 50.0;
  camera.world_from_camera = world_from_camera;
  const double x = 0.4, y = 0.24, shift = 0.1;  // half extents and a lens shift
  const Mat4d projection = kind == CameraKind::kOrthographic
                               ? glm::ortho(-5 * x, 5 * x, -5 * y, 5 * y, 0.1, 50.0)
                               : glm::frustum(0.1 * zoom * (shift - x), 0.1 * zoom * (shift + x),
                                              -0.1 * zoom * y, 0.1 * zoom * y, 0.1, 50.0);
  camera.clip_from_world = projection * glm::inverse(world_from_camera);
  return camera;
}

CameraDesc moving(CameraDesc camera) {
  for (int step = -2; step <= 2; ++step) {
    camera.motion.poses.push_back(glm::scale(pose(step), Vec3d(3.0)));  // scale is ignored
  }
  return camera;
}

void expect_the_cameras_of_each_pose(const CameraDesc& made,
                                     const std::function<CameraDesc(int)>& at_step) {
  const Vec3d origin(300, 0, 0);
  CameraView view = make_camera(made, origin);
  const CameraTables tables(made, origin, view);
  tables.lend(view);
  for (int step = -2; step <= 2; ++step) {
    const CameraView still = make_camera(at_step(step), origin);
    for (std::uint32_t i = 0; i < 50; ++i) {
      const Vec2 film(3.0f * float(i), 90.0f - 1.7f * float(i)), lens(0.02f * float(i), 0.3f);
      const Ray ray = camera_ray(view, film, lens, 0.25f * float(step + 2));
      const Ray expected = camera_ray(still, film, lens, 0.0f);
      ASSERT_LT(glm::length(ray.origin - expected.origin), 2e-6f) << step << " " << i;
      ASSERT_LT(glm::length(ray.direction - expected.direction), 1e-6f) << step << " " << i;
      ASSERT_NEAR(ray.t_max, expected.t_max, 1e-4f);
    }
  }
}

TEST(CameraMotion, IsAtEachPoseTheCameraThere) {
  for (const CameraKind kind :
       {CameraKind::kPerspective, CameraKind::kOrthographic, CameraKind::kPanorama}) {
    for (const bool lens : {false, true}) {
      for (const bool stereo : {false, true}) {
        if (stereo && kind == CameraKind::kOrthographic) continue;
        const auto at = [&](int step) {
          CameraDesc camera = camera_of(kind, pose(step));
          if (lens) camera.lens = {0.2, 5, 0.3, 1.2, 4.0};
          if (stereo) camera.stereo = {0.03, 2.0, 1.0, 1.2};
          return camera;
        };
        expect_the_cameras_of_each_pose(moving(at(0)), at);
      }
    }
  }
}

TEST(CameraMotion, ZoomsLinearlyOnEitherSideOfTheRest) {
  const auto zoom = [](int step) { return step < 0 ? 1.0 - 0.25 * step : 1.0 - 0.2 * step; };
  CameraDesc camera = moving(camera_of(CameraKind::kPerspective, pose(0)));
  camera.motion.zoom_open = zoom(-2);
  camera.motion.zoom_close = zoom(2);
  const auto at = [&](int step) {
    return camera_of(CameraKind::kPerspective, pose(step), zoom(step));
  };
  expect_the_cameras_of_each_pose(camera, at);
  camera.motion.poses.assign(3, pose(0));
  expect_the_cameras_of_each_pose(
      camera, [&](int step) { return camera_of(CameraKind::kPerspective, pose(0), zoom(step)); });
}

TEST(CameraMotion, RefusesWhatStandsForNothing) {
  const CameraDesc good = moving(camera_of(CameraKind::kPerspective, pose(0)));
  const auto refused = [](const CameraDesc& camera) {
    EXPECT_THROW(CameraTables(camera, Vec3d(0.0), make_camera(camera, Vec3d(0.0))),
                 std::invalid_argument);
  };
  CameraDesc camera = good;
  camera.motion.poses.pop_back();
  refused(camera);
  camera = good;
  camera.motion.poses[1][0] = glm::dvec4(0.0);
  refused(camera);
  camera = good;
  camera.motion.poses[2] = pose(1);
  refused(camera);
  camera = good;
  camera.motion.poses[4][3][1] = NAN;
  refused(camera);
  camera = good;
  camera.motion.zoom_open = 0.0;
  refused(camera);
  camera = good;
  camera.motion.poses.clear();
  camera.motion.zoom_open = 2.0;
  refused(camera);
  for (const std::vector<float>& curve :
       {std::vector<float>{1.0f}, {0.0f, 0.0f}, {1.0f, -1.0f}, {1.0f, NAN}}) {
    camera = good;
    camera.shutter.curve = curve;
    refused(camera);
  }
  camera = good;
  camera.shutter.rolling = true;
  camera.shutter.rolling_duration = 1.5;
  refused(camera);
}

TEST(Shutter, OpensAsItsCurveSays) {
  const ShutterTable even(ShutterDesc{{0.7f, 0.7f, 0.7f}}, 10), none(ShutterDesc{}, 10);
  EXPECT_TRUE(even.view().is_plain());
  EXPECT_EQ(shutter_time(none.view(), 0.25f, 3), 0.25f);
  // Up to 2 at a quarter, down to 0 at a half, and a shorter, even end.
  const ShutterTable table(ShutterDesc{{0.0f, 2.0f, 0.0f, 0.5f, 0.5f}}, 10);
  const auto cdf = [](double t) {  // its integral over [0, t], of 1.625 quarters... in fourths
    t *= 4.0;
    const auto linear = [](double x, double a, double b) { return a * x + 0.5 * (b - a) * x * x; };
    double sum = linear(std::min(t, 1.0), 0.0, 2.0);
    if (t > 1.0) sum += linear(std::min(t - 1.0, 1.0), 2.0, 0.0);
    if (t > 2.0) sum += linear(std::min(t - 2.0, 1.0), 0.0, 0.5);
    if (t > 3.0) sum += 0.5 * (t - 3.0);
    return sum / 2.75;
  };
  float last = 0.0f;
  for (int i = 0; i < 10000; ++i) {
    const float u = (static_cast<float>(i) + 0.5f) / 10000.0f;
    const float time = shutter_time(table.view(), u, 0);
    ASSERT_GE(time, last);
    ASSERT_LT(time, 1.0f);
    ASSERT_NEAR(cdf(static_cast<double>(time)), static_cast<double>(u), 2e-6) << u;
    last = time;
  }
}

TEST(Shutter, RollsFromTheTopDown) {
  const ShutterTable table(ShutterDesc{{}, true, 0.2}, 100);
  EXPECT_NEAR(shutter_time(table.view(), 0.5f, 100), 0.1, 1e-6);
  EXPECT_NEAR(shutter_time(table.view(), 0.5f, 50), 0.5, 1e-6);
  EXPECT_NEAR(shutter_time(table.view(), 0.0f, 0), 0.8, 1e-6);
  EXPECT_NEAR(shutter_time(table.view(), 1.0f, 0), 1.0, 1e-6);
}

}  // namespace
}  // namespace komorebi::testing
