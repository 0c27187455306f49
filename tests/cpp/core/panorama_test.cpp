// Panoramas against the definitions of their projections: from a direction back to the film, by
// angles from libm.
#include "core/panorama.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <string>

#include "core/panorama_point.h"
#include "render/camera.h"
#include "support/camera_poses.h"

namespace komorebi {
namespace {

constexpr std::uint32_t kWidth = 320, kHeight = 200;
const Vec3d kLocation(3.0, -2.0, 1.5), kEuler(1.1, 0.2, -0.6);

CameraDesc camera_desc(PanoramaKind kind) {
  CameraDesc desc;
  desc.kind = CameraKind::kPanorama;
  desc.world_from_camera = testing::pose(kEuler, kLocation);
  desc.width = kWidth, desc.height = kHeight;
  desc.clip_start = 0.25, desc.clip_end = 90.0;
  desc.panorama.kind = kind;
  desc.panorama.fov = 3.3;
  desc.panorama.sensor_width = 36.0, desc.panorama.sensor_height = 22.5;
  desc.panorama.shift_x = 0.07, desc.panorama.shift_y = -0.04;
  desc.panorama.longitude_min = -2.0, desc.panorama.longitude_max = 2.8;
  desc.panorama.latitude_min = -0.9, desc.panorama.latitude_max = 1.3;
  desc.panorama.height_min = -0.7, desc.panorama.height_max = 1.9;
  const double k[] = {-1e-3, -0.09, -2e-4, 3e-6, -2e-8};
  std::copy_n(k, 5, desc.panorama.polynomial);
  return desc;
}

// Where a direction (right, up, back) falls, in pixels from the lower left corner.
struct Film {
  double x, y;
};
Film project(const PanoramaDesc& p, const Vec3d& d) {
  const double longitude = std::atan2(d.x, -d.z), latitude = std::asin(d.y);
  const double angle = std::acos(-d.z), round = std::atan2(d.y, d.x);
  const auto polar = [&](double r, double width, double height) {
    return Film{r * std::cos(round) / width + 0.5, r * std::sin(round) / height + 0.5};
  };
  Film uv{};
  switch (p.kind) {
    case PanoramaKind::kEquirectangular:
      uv.x = (longitude - p.longitude_min) / (p.longitude_max - p.longitude_min);
      uv.y = (latitude - p.latitude_min) / (p.latitude_max - p.latitude_min);
      break;
    case PanoramaKind::kCentralCylindrical:
      uv.x = (longitude - p.longitude_min) / (p.longitude_max - p.longitude_min);
      uv.y = (std::tan(latitude) - p.height_min) / (p.height_max - p.height_min);
      break;
    case PanoramaKind::kFisheyeEquidistant:
      uv = polar(angle / p.fov, 1.0, 1.0);
      break;
    case PanoramaKind::kFisheyeEquisolid:
      uv = polar(2.0 * p.focal_length * std::sin(0.5 * angle), p.sensor_width, p.sensor_height);
      break;
    case PanoramaKind::kFisheyePolynomial: {
      double low = 0.0, high = 60.0;  // the radius of that angle, by bisection
      for (int i = 0; i < 100; ++i) {
        const double r = 0.5 * (low + high);
        double theta = 0.0;
        for (int n = 0; n < 5; ++n) theta -= p.polynomial[n] * std::pow(r, n);
        (theta < angle ? low : high) = r;
      }
      uv = polar(low, p.sensor_width, p.sensor_height);
      break;
    }
    case PanoramaKind::kMirrorBall: {  // the normal halves the way in and the way out
      const Vec3d normal = glm::normalize(d - Vec3d(0.0, 0.0, 1.0));
      uv = {0.5 * normal.x + 0.5, 0.5 * normal.y + 0.5};
      break;
    }
    case PanoramaKind::kEquiangularCubeFace:
      uv = {std::atan2(d.x, -d.z) * 2.0 / kPi + 0.5, std::atan2(d.y, -d.z) * 2.0 / kPi + 0.5};
      break;
  }
  return {(uv.x - p.shift_x) * kWidth, (uv.y - p.shift_y) * kHeight};
}

const PanoramaKind kKinds[] = {PanoramaKind::kEquirectangular,   PanoramaKind::kFisheyeEquidistant,
                               PanoramaKind::kFisheyeEquisolid,  PanoramaKind::kMirrorBall,
                               PanoramaKind::kFisheyePolynomial, PanoramaKind::kEquiangularCubeFace,
                               PanoramaKind::kCentralCylindrical};

// Whether a film point of pixels from the lower left corner lies in the circle; sure: not on it.
struct Inside {
  bool yes, sure;
};
Inside inside(const PanoramaDesc& p, double x, double y) {
  const double u = x / kWidth + p.shift_x - 0.5, v = y / kHeight + p.shift_y - 0.5;
  double r = 0.0, limit = 1.0;
  switch (p.kind) {
    case PanoramaKind::kFisheyeEquidistant:
    case PanoramaKind::kMirrorBall:
      r = 2.0 * std::hypot(u, v);
      break;
    case PanoramaKind::kFisheyeEquisolid:
      r = std::hypot(u * p.sensor_width, v * p.sensor_height);
      limit = 2.0 * p.focal_length * std::sin(p.fov / 4.0);
      break;
    case PanoramaKind::kFisheyePolynomial: {
      const double mm = std::hypot(u * p.sensor_width, v * p.sensor_height);
      for (int n = 0; n < 5; ++n) r -= p.polynomial[n] * std::pow(mm, n);
      r = std::abs(r);
      limit = 0.5 * p.fov;
      break;
    }
    default:
      break;
  }
  return {r <= limit, std::abs(r - limit) > 1e-9};
}

template <typename F>
void for_film_points(F f) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int i = 0; i < 2000; ++i) {
    f(Vec2(static_cast<float>(kWidth) * unit(engine), static_cast<float>(kHeight) * unit(engine)));
  }
}

TEST(Panorama, RaysPassThroughTheirPixel) {
  const Mat3d rotation = testing::euler_rotation(kEuler);
  for (const PanoramaKind kind : kKinds) {
    const CameraDesc desc = camera_desc(kind);
    const Vec3d origin(0.5, 1.0, -2.0);
    const CameraView view = make_camera(desc, origin);
    int rays = 0, none = 0;
    for_film_points([&](const Vec2& film) {
      const Ray ray = camera_ray(view, film, Vec2(0.5f), 0.25f);
      const Inside expected = inside(desc.panorama, double{film.x}, double{film.y});
      if (!expected.sure) return;
      ASSERT_EQ(has_ray(ray.t_max), expected.yes) << film.x << ' ' << film.y;
      ASSERT_NEAR(glm::length(Vec3d(ray.direction)), 1.0, 1e-7);
      ASSERT_EQ(ray.time, 0.25f);
      if (!expected.yes) return static_cast<void>(++none);
      ++rays;
      const Vec3d seen = glm::transpose(rotation) * Vec3d(ray.direction);
      const Film at = project(desc.panorama, seen);
      // A direction is rounded to floats; the rim of the ball packs half the world.
      const double tolerance = kind == PanoramaKind::kMirrorBall ? 2e-2 : 2e-3;
      ASSERT_NEAR(at.x, double{film.x}, tolerance) << "kind " << static_cast<int>(kind);
      ASSERT_NEAR(at.y, double{film.y}, tolerance) << "kind " << static_cast<int>(kind);
      const Vec3d start = origin + Vec3d(ray.origin) - kLocation;
      ASSERT_LT(glm::length(start - 0.25 * Vec3d(ray.direction)), 1e-6);
      ASSERT_FLOAT_EQ(ray.t_max, 89.75f);
    });
    EXPECT_GT(rays, 500);
    const bool round = kind != PanoramaKind::kEquirectangular &&
                       kind != PanoramaKind::kEquiangularCubeFace &&
                       kind != PanoramaKind::kCentralCylindrical;
    EXPECT_EQ(none > 50, round);
  }
}

TEST(Panorama, DirectionsLeadBackToTheFilm) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  for (const PanoramaKind kind : kKinds) {
    const PanoramaDesc desc = camera_desc(kind).panorama;
    const PanoramaView view = make_panorama(desc, kWidth, kHeight);
    for (int i = 0; i < 2000; ++i) {
      const Vec3d d(coordinate(engine), coordinate(engine), coordinate(engine));
      const bool round = kind != PanoramaKind::kEquirectangular &&
                         kind != PanoramaKind::kEquiangularCubeFace &&
                         kind != PanoramaKind::kCentralCylindrical;
      const Vec3d unit = glm::normalize(d);
      if (round && unit.z > 0.98) continue;  // the rim, where all directions meet
      const Film at = project(desc, unit);
      const glm::dvec2 back = panorama_point(view, 3.0 * d);
      const double tolerance = 1e-9 * (1.0 + std::abs(at.x) + std::abs(at.y));
      ASSERT_NEAR(back.x, at.x - 0.5 * kWidth, tolerance) << "kind " << static_cast<int>(kind);
      ASSERT_NEAR(back.y, at.y - 0.5 * kHeight, tolerance) << "kind " << static_cast<int>(kind);
    }
  }
  // What leads nowhere is said by a number that is not finite.
  PanoramaDesc none = camera_desc(PanoramaKind::kFisheyePolynomial).panorama;
  std::fill_n(none.polynomial, 5, 0.0);
  EXPECT_FALSE(
      std::isfinite(panorama_point(make_panorama(none, kWidth, kHeight), Vec3d(0.1, 0.2, -1.0)).x));
}

TEST(Panorama, DepthIsDistance) {
  const CameraView view = make_camera(camera_desc(PanoramaKind::kMirrorBall), Vec3d(1.0));
  EXPECT_NEAR(camera_depth(view, Vec3(2.0f, 0.0f, 4.0f)),
              glm::length(Vec3d(3.0, 1.0, 5.0) - kLocation), 1e-6);
}

// Both the lens and the eyes of stereo: rays of one film point meet at the distance in focus.
TEST(Panorama, LensRaysMeetAtTheirDistance) {
  for (const PanoramaKind kind : kKinds) {
    CameraDesc desc = camera_desc(kind);
    const CameraView pinhole = make_camera(desc, Vec3d(0.0));
    desc.lens = {0.2, 7, 0.1, 1.5, 3.0};
    const CameraView view = make_camera(desc, Vec3d(0.0));
    double largest = 0.0;
    for_film_points([&](const Vec2& film) {
      const double x = double{film.x} - 160.0, y = double{film.y} - 100.0;
      const CameraRay sharp = film_ray(pinhole, x, y, {}), ray = film_ray(view, x, y, {0.9f, 0.2f});
      if (sharp.t_max < 0.0) return;
      const Vec3d focus = kLocation + 3.0 * sharp.direction;
      const Vec3d leaves = ray.origin - 0.25 * ray.direction;
      ASSERT_LT(glm::length(glm::cross(focus - leaves, ray.direction)), 1e-12);
      ASSERT_LT(std::abs(glm::dot(leaves - kLocation, sharp.direction)), 1e-12);
      largest = std::max(largest, glm::length(leaves - kLocation));
    });
    const Vec2 p = aperture_point(view.aperture, {0.9f, 0.2f});
    EXPECT_NEAR(largest, 0.2 * std::hypot(static_cast<double>(p.x) / 1.5, static_cast<double>(p.y)),
                1e-9);
  }
}

TEST(SphericalStereo, EyesStandAsideAndMeet) {
  const Mat3d rotation = testing::euler_rotation(kEuler);
  for (const double convergence : {0.0, 2.5}) {
    CameraDesc desc = camera_desc(PanoramaKind::kEquirectangular);
    const CameraView middle = make_camera(desc, Vec3d(0.0));
    desc.stereo = {0.04, convergence, 0.5, 0.8};
    const CameraView right = make_camera(desc, Vec3d(0.0));
    int apart = 0, between = 0, united = 0;
    for_film_points([&](const Vec2& film) {
      const double x = double{film.x} - 160.0, y = double{film.y} - 100.0;
      const CameraRay from = film_ray(middle, x, y, {}), ray = film_ray(right, x, y, {});
      const Vec3d offset = ray.origin - 0.25 * ray.direction - kLocation;
      const double altitude = std::asin(std::abs(glm::dot(from.direction, rotation[1])));
      const double fade = altitude <= 0.5   ? 1.0
                          : altitude >= 0.8 ? 0.0
                                            : std::cos((altitude - 0.5) / 0.3 * kPi / 2.0);
      (fade == 1.0 ? apart : fade == 0.0 ? united : between) += 1;
      ASSERT_NEAR(glm::length(offset), 0.04 * fade, 1e-12);
      ASSERT_NEAR(glm::dot(offset, from.direction), 0.0, 1e-12);
      ASSERT_NEAR(glm::dot(offset, rotation[1]), 0.0, 1e-12);
      ASSERT_GE(glm::dot(glm::cross(from.direction, rotation[1]), offset), -1e-15);
      const Vec3d meeting = kLocation + 2.5 * from.direction;
      const Vec3d expected =
          convergence > 0.0 ? glm::normalize(meeting - kLocation - offset) : from.direction;
      ASSERT_LT(glm::length(ray.direction - expected), 1e-12);
    });
    EXPECT_GT(std::min({apart, between, united}), 20);
  }
}

// A perspective camera's eyes turn about the world's vertical.
TEST(SphericalStereo, OfAPerspectiveCameraIsLevel) {
  CameraDesc desc = camera_desc(PanoramaKind::kEquirectangular);
  desc.kind = CameraKind::kPerspective;
  desc.clip_from_world =
      glm::perspective(1.0, 1.6, 0.25, 90.0) * glm::inverse(testing::pose(kEuler, kLocation));
  const CameraView middle = make_camera(desc, Vec3d(0.0));
  desc.stereo = {-0.05, 3.0, 0.0, 0.0};
  const CameraView left = make_camera(desc, Vec3d(0.0));
  for_film_points([&](const Vec2& film) {
    const double x = double{film.x} - 160.0, y = double{film.y} - 100.0;
    const CameraRay from = film_ray(middle, x, y, {}), ray = film_ray(left, x, y, {});
    const double start = glm::length(from.origin - kLocation);
    const Vec3d offset = ray.origin - start * ray.direction - kLocation;
    ASSERT_NEAR(glm::length(offset), 0.05, 1e-12);
    ASSERT_NEAR(offset.z, 0.0, 1e-12);
    ASSERT_LT(glm::dot(offset, glm::cross(from.direction, Vec3d(0.0, 0.0, 1.0))), 0.0);
    const Vec3d meeting = kLocation + 3.0 * from.direction;
    ASSERT_LT(glm::length(glm::cross(meeting - kLocation - offset, ray.direction)), 1e-12);
    ASSERT_DOUBLE_EQ(ray.t_max, from.t_max);
  });
}

TEST(Panorama, RefusesWhatIsNoProjection) {
  const auto refused = [](PanoramaKind kind, auto change) {
    CameraDesc desc = camera_desc(kind);
    EXPECT_NO_THROW(make_camera(desc, Vec3d(0.0)));
    change(desc);
    EXPECT_THROW(make_camera(desc, Vec3d(0.0)), std::invalid_argument);
  };
  const double nan = std::nan("");
  using Kind = PanoramaKind;
  refused(Kind::kFisheyeEquisolid, [](CameraDesc& d) { d.panorama.focal_length = 0.0; });
  refused(Kind::kFisheyeEquisolid, [](CameraDesc& d) { d.panorama.sensor_width = 0.0; });
  refused(Kind::kFisheyePolynomial, [](CameraDesc& d) { d.panorama.sensor_height = -1.0; });
  refused(Kind::kFisheyePolynomial, [&](CameraDesc& d) { d.panorama.polynomial[3] = nan; });
  refused(Kind::kFisheyeEquidistant, [&](CameraDesc& d) { d.panorama.fov = nan; });
  refused(Kind::kEquirectangular, [&](CameraDesc& d) { d.panorama.latitude_min = nan; });
  refused(Kind::kEquirectangular, [](CameraDesc& d) { d.panorama.longitude_max = 1e9; });
  refused(Kind::kCentralCylindrical, [&](CameraDesc& d) { d.panorama.height_max = 1.0 / 0.0; });
  refused(Kind::kMirrorBall, [&](CameraDesc& d) { d.panorama.shift_x = nan; });
  refused(Kind::kMirrorBall, [](CameraDesc& d) { d.world_from_camera[1] = glm::dvec4(0.0); });
  refused(Kind::kMirrorBall, [&](CameraDesc& d) { d.world_from_camera[3][0] = nan; });
  refused(Kind::kMirrorBall, [&](CameraDesc& d) { d.stereo.eye = nan; });
  refused(Kind::kMirrorBall, [](CameraDesc& d) { d.clip_end = d.clip_start; });
}

// Limits in the wrong order, or none, are pictures too: mirrored, or of one column.
TEST(Panorama, LimitsInAnyOrderGiveRays) {
  CameraDesc desc = camera_desc(PanoramaKind::kEquirectangular);
  std::swap(desc.panorama.longitude_min, desc.panorama.longitude_max);
  desc.panorama.latitude_max = desc.panorama.latitude_min;
  const CameraView view = make_camera(desc, Vec3d(0.0));
  for_film_points([&](const Vec2& film) {
    const Ray ray = camera_ray(view, film, Vec2(0.5f), 0.0f);
    ASSERT_NEAR(glm::length(Vec3d(ray.direction)), 1.0, 1e-7);
    ASSERT_TRUE(has_ray(ray.t_max));
  });
}

}  // namespace
}  // namespace komorebi
