// Camera rays against an oracle in doubles that knows lenses and sensors, not matrices' inverses.
#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace komorebi {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

// A camera as an artist sets it up, by Blender's rules.
struct Settings {
  bool orthographic = false;
  double lens = 50.0, sensor_width = 36.0, sensor_height = 24.0;  // mm
  char fit = 'A';                                                 // A(uto), H, V
  double scale = 6.0;                                             // orthographic
  double shift_x = 0.0, shift_y = 0.0;
  double aspect_x = 1.0, aspect_y = 1.0;  // of a pixel
  std::uint32_t width = 1920, height = 1080;
  double clip_start = 0.1, clip_end = 1000.0;
  Vec3d location{7.36, -6.93, 4.96};
  Vec3d euler{63.6 * kDegree, 0.0, 46.7 * kDegree};
};

// The half extents of the picture at distance 1 (orthographic: at any), and its middle.
struct Frustum {
  double half_width, half_height, center_x, center_y;
};

Frustum frustum(const Settings& s) {
  const double x = s.width * s.aspect_x, y = s.height * s.aspect_y;
  const bool horizontal = s.fit == 'H' || (s.fit == 'A' && x >= y);
  const double sensor = s.fit == 'V' ? s.sensor_height : s.sensor_width;
  const double size = s.orthographic ? s.scale : sensor / s.lens;  // of the fitted side
  const double per_unit = size / (horizontal ? x : y);
  return {0.5 * x * per_unit, 0.5 * y * per_unit, s.shift_x * size, s.shift_y * size};
}

Mat3d rotation(const Vec3d& e) {  // XYZ Euler: x first
  const double cx = std::cos(e.x), sx = std::sin(e.x), cy = std::cos(e.y), sy = std::sin(e.y);
  const double cz = std::cos(e.z), sz = std::sin(e.z);
  const Mat3d x(1, 0, 0, 0, cx, sx, 0, -sx, cx), y(cy, 0, -sy, 0, 1, 0, sy, 0, cy);
  return Mat3d(cz, sz, 0, -sz, cz, 0, 0, 0, 1) * y * x;
}

Mat4d clip_from_world(const Settings& s) {
  const Frustum f = frustum(s);
  const double n = s.clip_start, d = s.clip_end - s.clip_start;
  Mat4d projection(0.0);
  projection[0][0] = 1.0 / f.half_width;
  projection[1][1] = 1.0 / f.half_height;
  if (s.orthographic) {
    projection[2][2] = -2.0 / d;
    projection[3] = glm::dvec4(-f.center_x / f.half_width, -f.center_y / f.half_height,
                               -(s.clip_end + n) / d, 1.0);
  } else {
    projection[2] = glm::dvec4(f.center_x / f.half_width, f.center_y / f.half_height,
                               -(s.clip_end + n) / d, -1.0);
    projection[3][2] = -2.0 * s.clip_end * n / d;
  }
  const Mat3d r = glm::transpose(rotation(s.euler));
  Mat4d view(r);
  view[3] = glm::dvec4(-(r * s.location), 1.0);
  return projection * view;
}

CameraView camera(const Settings& s, const Vec3d& origin) {
  CameraDesc desc;
  desc.kind = s.orthographic ? CameraKind::kOrthographic : CameraKind::kPerspective;
  desc.clip_from_world = clip_from_world(s);
  desc.clip_start = s.clip_start;
  desc.clip_end = s.clip_end;
  desc.width = s.width;
  desc.height = s.height;
  return make_camera(desc, origin);
}

// Where a world point falls on the film, and its depth: geometry alone, in doubles.
struct Projected {
  double x, y, depth;
};
Projected project(const Settings& s, const Vec3d& world) {
  const Vec3d p = glm::transpose(rotation(s.euler)) * (world - s.location);
  const Frustum f = frustum(s);
  const double w = s.orthographic ? 1.0 : -p.z;
  return {(((p.x / w - f.center_x) / f.half_width) * 0.5 + 0.5) * s.width,
          (((p.y / w - f.center_y) / f.half_height) * 0.5 + 0.5) * s.height, -p.z};
}

std::vector<Settings> table() {
  std::vector<Settings> all(1);
  const auto add = [&](auto change) {
    for (const bool orthographic : {false, true}) {
      Settings s;
      s.orthographic = orthographic;
      change(s);
      all.push_back(s);
    }
  };
  for (const char fit : {'A', 'H', 'V'}) {
    add([&](Settings& s) { s.fit = fit; });
    add([&](Settings& s) { s.fit = fit, s.width = 1080, s.height = 1920; });
    add([&](Settings& s) { s.fit = fit, s.shift_x = 0.3, s.shift_y = -0.7; });
    add([&](Settings& s) { s.fit = fit, s.aspect_x = 2.0; });
    add([&](Settings& s) { s.fit = fit, s.aspect_y = 1.46, s.width = 720, s.height = 576; });
    add([&](Settings& s) { s.fit = fit, s.sensor_width = 22.3, s.sensor_height = 14.9; });
  }
  add([](Settings& s) { s.width = s.height = 2048; });
  add([](Settings& s) { s.width = s.height = 1; });
  add([](Settings& s) { s.width = 2048, s.height = 3; });
  add([](Settings& s) { s.lens = 8.0, s.scale = 100.0; });
  add([](Settings& s) { s.lens = 200.0, s.scale = 0.1, s.width = 2048; });
  add([](Settings& s) { s.clip_start = 1e-3, s.clip_end = 1e5; });
  add([](Settings& s) { s.clip_start = 5.0, s.clip_end = 12.0; });
  add([](Settings& s) { s.euler = Vec3d(0.0); });
  add([](Settings& s) { s.euler = Vec3d(180 * kDegree, 0.3, -2.0); });
  add([](Settings& s) { s.shift_x = 2.0, s.shift_y = 2.0, s.lens = 24.0; });
  return all;
}

// Rays in the corners, edges and middle, and at random in between.
template <typename F>
void for_film_points(const Settings& s, F f) {
  const float w = static_cast<float>(s.width), h = static_cast<float>(s.height);
  for (const float x : {0.0f, 0.5f, 0.5f * w, w - 0.5f, w}) {
    for (const float y : {0.0f, 0.5f, 0.5f * h, h - 0.5f, h}) f(Vec2(x, y));
  }
  std::mt19937 engine(99);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int i = 0; i < 200; ++i) f(Vec2(w * unit(engine), h * unit(engine)));
}

Vec3d along(const Ray& ray, double t, const Vec3d& origin) {
  return origin + Vec3d(ray.origin) + t * Vec3d(ray.direction);
}

TEST(Camera, RaysPassThroughTheirPixelWithinAThousandth) {
  int number = 0;
  for (const Settings& s : table()) {
    SCOPED_TRACE("setting " + std::to_string(number++));
    const Vec3d origin(0.5, -0.25, 1.0);
    const CameraView view = camera(s, origin);
    const Frustum f = frustum(s);
    for_film_points(s, [&](const Vec2& film) {
      const Ray ray = camera_ray(view, film, Vec2(0.5f), 0.0f);
      const double per_depth =
          1.0 / std::abs(glm::dot(Vec3d(ray.direction), rotation(s.euler) * Vec3d(0.0, 0.0, -1.0)));
      for (const double depth : {s.clip_start, 1.0, 10.0, 100.0, s.clip_end}) {
        if (depth < s.clip_start || depth > s.clip_end) continue;
        const Projected at = project(s, along(ray, (depth - s.clip_start) * per_depth, origin));
        // The origin is a float: half a unit in the last place of each coordinate comes on top,
        // seen from `depth` and, away from the axis, at a slant. Parallel rays keep their
        // direction's rounding, however far they run.
        const double pixel = 2.0 * std::min(f.half_width / s.width, f.half_height / s.height) *
                             (s.orthographic ? 1.0 : depth);
        const double run = s.orthographic ? depth - s.clip_start : 0.0;
        const double grid = 0x1p-24 * (double{max_abs(ray.origin)} + run) / pixel;
        const double tolerance = 1e-3 + std::sqrt(3.0) * per_depth * grid;
        ASSERT_NEAR(at.x, film.x, tolerance) << "depth " << depth;
        ASSERT_NEAR(at.y, film.y, tolerance) << "depth " << depth;
      }
    });
  }
}

TEST(Camera, RaysRunFromClipPlaneToClipPlane) {
  for (const Settings& s : table()) {
    const Vec3d origin(1.0, 2.0, 3.0);
    const CameraView view = camera(s, origin);
    for_film_points(s, [&](const Vec2& film) {
      const Ray ray = camera_ray(view, film, Vec2(0.0f), 0.25f);
      ASSERT_NEAR(glm::length(Vec3d(ray.direction)), 1.0, 1e-7);
      ASSERT_EQ(ray.t_min, 0.0f);
      ASSERT_EQ(ray.time, 0.25f);
      const double tolerance = 2e-7 * (s.clip_end + 20.0);
      ASSERT_NEAR(project(s, along(ray, 0.0, origin)).depth, s.clip_start, 2e-6);
      ASSERT_NEAR(project(s, along(ray, ray.t_max, origin)).depth, s.clip_end, tolerance);
    });
  }
}

TEST(Camera, DepthIsPlanarAndMeasuredFromTheCamera) {
  for (const Settings& s : table()) {
    const Vec3d origin(-4.0, 0.0, 2.0);
    const CameraView view = camera(s, origin);
    for_film_points(s, [&](const Vec2& film) {
      const Ray ray = camera_ray(view, film, Vec2(0.0f), 0.0f);
      const Vec3 p = ray.origin + 0.3f * ray.direction;
      const double exact = project(s, origin + Vec3d(p)).depth;
      ASSERT_NEAR(camera_depth(view, p), exact, 1e-6 + 1e-6 * std::abs(exact));
    });
  }
}

// Ten kilometres from the world's origin, with the scene's origin nearby: as precise as at home.
TEST(Camera, DistanceFromTheWorldsOriginCostsNothing) {
  for (const bool orthographic : {false, true}) {
    Settings near, far;
    near.orthographic = far.orthographic = orthographic;
    const Vec3d away(10000.0, -10000.0, 500.0);
    far.location += away;
    const CameraView a = camera(near, Vec3d(0.0)), b = camera(far, away);
    for_film_points(near, [&](const Vec2& film) {
      const Ray p = camera_ray(a, film, Vec2(0.0f), 0.0f),
                q = camera_ray(b, film, Vec2(0.0f), 0.0f);
      ASSERT_LT(glm::length(Vec3d(p.direction) - Vec3d(q.direction)), 1.2e-7);
      ASSERT_LT(glm::length(Vec3d(p.origin) - Vec3d(q.origin)), 1.5e-6);
    });
  }
}

// Blender hands out the projection as floats; that rounding must cost less than a hundredth.
TEST(Camera, SurvivesAProjectionOfFloats) {
  for (const Settings& s : table()) {
    CameraDesc desc;
    desc.kind = s.orthographic ? CameraKind::kOrthographic : CameraKind::kPerspective;
    Settings still = s;
    still.location = still.euler = Vec3d(0.0);
    desc.clip_from_world = Mat4d(glm::mat4(clip_from_world(still)));
    desc.clip_start = s.clip_start;
    desc.clip_end = s.clip_end;
    desc.width = s.width;
    desc.height = s.height;
    const CameraView view = make_camera(desc, Vec3d(0.0));
    for_film_points(s, [&](const Vec2& film) {
      const Ray ray = camera_ray(view, film, Vec2(0.5f), 0.0f);
      const Projected at = project(still, along(ray, 5.0, Vec3d(0.0)));
      ASSERT_NEAR(at.x, film.x, 1e-2);
      ASSERT_NEAR(at.y, film.y, 1e-2);
    });
  }
}

TEST(Camera, RefusesWhatIsNoCamera) {
  CameraDesc desc;
  desc.clip_from_world = clip_from_world(Settings{});
  desc.width = desc.height = 10;
  EXPECT_NO_THROW(make_camera(desc, Vec3d(0.0)));
  const auto refused = [&](auto change) {
    CameraDesc bad = desc;
    change(bad);
    EXPECT_THROW(make_camera(bad, Vec3d(0.0)), std::invalid_argument);
  };
  refused([](CameraDesc& d) { d.clip_from_world[2][1] = std::nan(""); });
  refused([](CameraDesc& d) { d.clip_from_world = Mat4d(0.0); });
  refused([](CameraDesc& d) { d.clip_from_world[0] = d.clip_from_world[1]; });
  refused([](CameraDesc& d) { d.kind = CameraKind::kOrthographic; });
  refused([](CameraDesc& d) { d.clip_from_world = Mat4d(1.0); });
  refused([](CameraDesc& d) { d.width = 0; });
  refused([](CameraDesc& d) { d.clip_end = d.clip_start; });
  refused([](CameraDesc& d) { d.clip_start = 0.0; });
}

}  // namespace
}  // namespace komorebi
