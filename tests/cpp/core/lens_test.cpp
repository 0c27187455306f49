// Points of the aperture against areas cut out of polygons, and lens rays against the geometry of a
// thin lens.
#include "core/lens.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <string>
#include <vector>

#include "render/camera.h"
#include "support/camera_poses.h"
#include "support/chi_square.h"

namespace komorebi {
namespace {

using Point = glm::dvec2;

constexpr double kRadius = 0.3, kFocus = 4.0, kClipStart = 0.5, kClipEnd = 50.0;

// What make_camera makes of a lens.
ApertureView aperture(std::uint32_t blades, double rotation) {
  CameraDesc desc;
  desc.clip_from_world = glm::perspective(1.0, 1.5, kClipStart, kClipEnd);
  desc.width = 30, desc.height = 20;
  desc.lens.radius = 1.0;
  desc.lens.blades = blades;
  desc.lens.rotation = rotation;
  return make_camera(desc, Vec3d(0.0)).aperture;
}

// The opening's outline, counter-clockwise; a disk as a polygon of many corners.
std::vector<Point> outline(std::uint32_t blades, double rotation) {
  const std::uint32_t corners = blades ? blades : 4096;
  std::vector<Point> points;
  for (std::uint32_t k = 0; k < corners; ++k) {
    const double angle = rotation + (2 * k + 1) * kPi / corners;
    points.emplace_back(std::cos(angle), std::sin(angle));
  }
  return points;
}

double area_of(const std::vector<Point>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

// The part of a polygon where x·axis ≥ at (Sutherland and Hodgman).
std::vector<Point> cut(const std::vector<Point>& polygon, const Point& axis, double at) {
  std::vector<Point> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double da = glm::dot(a, axis) - at, db = glm::dot(b, axis) - at;
    if (da >= 0.0) result.push_back(a);
    if ((da < 0.0) != (db < 0.0)) result.push_back(a + (b - a) * (da / (da - db)));
  }
  return result;
}

struct Shape {
  std::uint32_t blades;
  double rotation;
};
const Shape kShapes[] = {{0, 0.0}, {3, 0.0}, {4, 0.7}, {5, -1.3}, {6, 3.0}, {16, 0.2}};

TEST(Aperture, IsFilledEvenly) {
  constexpr int kCells = 24, kSamples = 400000;
  for (const Shape& shape : kShapes) {
    const ApertureView view = aperture(shape.blades, shape.rotation);
    const std::vector<Point> whole = outline(shape.blades, shape.rotation);
    std::vector<double> expected(kCells * kCells);
    std::vector<std::uint64_t> observed(kCells * kCells);
    for (int y = 0; y < kCells; ++y) {
      auto row =
          cut(cut(whole, {0, 1}, 2.0 * y / kCells - 1.0), {0, -1}, 1.0 - 2.0 * (y + 1) / kCells);
      for (int x = 0; x < kCells; ++x) {
        const auto cell =
            cut(cut(row, {1, 0}, 2.0 * x / kCells - 1.0), {-1, 0}, 1.0 - 2.0 * (x + 1) / kCells);
        const double share = cell.size() < 3 ? 0.0 : area_of(cell) / area_of(whole);
        expected[static_cast<std::size_t>(y * kCells + x)] = share < 1e-9 ? 0.0 : kSamples * share;
      }
    }
    std::mt19937 engine(shape.blades + 1);
    for (int i = 0; i < kSamples; ++i) {
      const Vec2 p = aperture_point(view, {static_cast<float>(engine() >> 8) * 0x1p-24f,
                                           static_cast<float>(engine() >> 8) * 0x1p-24f});
      const auto cell = [](float v) {
        return std::clamp(static_cast<int>((double{v} + 1.0) * 0.5 * kCells), 0, kCells - 1);
      };
      // a rounding beyond the outline belongs to the cell beside it
      std::size_t at = static_cast<std::size_t>(cell(p.y) * kCells + cell(p.x));
      if (expected[at] == 0.0) {
        at = static_cast<std::size_t>(cell(p.y * 0.999999f) * kCells + cell(p.x * 0.999999f));
      }
      ++observed[at];
    }
    const auto result = testing::chi_square(observed, expected);
    EXPECT_GT(result.p_value, testing::sidak(0.01, 6)) << shape.blades;
  }
}

TEST(Aperture, KeepsAreas) {
  for (const Shape& shape : kShapes) {
    const ApertureView view = aperture(shape.blades, shape.rotation);
    const double area = shape.blades ? area_of(outline(shape.blades, shape.rotation)) : kPi;
    const std::uint32_t sides = shape.blades ? shape.blades : 1;
    const auto at = [&](double u, double v) {
      return Point(aperture_point(view, {static_cast<float>(u), static_cast<float>(v)}));
    };
    for (std::uint32_t i = 0; i < 4 * sides; ++i) {
      for (int j = 0; j < 8; ++j) {
        const double u = (i + 0.41) / (4 * sides), v = (j + 0.37) / 8.0, h = 1.0 / 1024.0 / sides;
        if (!shape.blades && (std::abs(u - v) < 0.02 || std::abs(u + v - 1.0) < 0.02)) continue;
        const Point du = at(u + h, v) - at(u - h, v), dv = at(u, v + h) - at(u, v - h);
        const double jacobian = (du.x * dv.y - du.y * dv.x) / (4.0 * h * h);
        EXPECT_NEAR(std::abs(jacobian) / area, 1.0, 4e-3) << shape.blades << ' ' << u << ' ' << v;
      }
    }
  }
}

TEST(Aperture, StaysInsideAtTheEdgesOfTheSquare) {
  const float edge[] = {0.0f, 1e-7f, 0.2f, 0.5f, 0.99999988f, kOneMinusEpsilon};
  for (const Shape& shape : kShapes) {
    const ApertureView view = aperture(shape.blades, shape.rotation);
    for (const float u : edge) {
      for (const float v : edge) {
        const double r = glm::length(Point(aperture_point(view, {u, v})));
        ASSERT_LT(r, 1.000001) << shape.blades << ' ' << u << ' ' << v;
      }
    }
  }
}

const Vec3d kLocation(3.0, -2.0, 1.5), kEuler(1.1, 0.2, -0.6);

CameraDesc camera_desc(bool orthographic) {
  CameraDesc desc;
  desc.kind = orthographic ? CameraKind::kOrthographic : CameraKind::kPerspective;
  const Mat4d projection = orthographic ? glm::ortho(-3.0, 3.0, -2.0, 2.0, kClipStart, kClipEnd)
                                        : glm::perspective(0.9, 1.5, kClipStart, kClipEnd);
  desc.clip_from_world = projection * glm::inverse(testing::pose(kEuler, kLocation));
  desc.clip_start = kClipStart;
  desc.clip_end = kClipEnd;
  desc.width = 300, desc.height = 200;
  return desc;
}

// Seen from the camera: a ray that leaves the lens at the aperture's point, and meets the pinhole's
// ray of that film point at the focus.
TEST(ThinLens, RaysMeetInFocusAndLeaveTheOpening) {
  const Mat3d rotation = testing::euler_rotation(kEuler);
  for (const bool orthographic : {false, true}) {
    CameraDesc desc = camera_desc(orthographic);
    const CameraView pinhole = make_camera(desc, Vec3d(0.0));
    desc.lens = {kRadius, 5, 0.4, 1.6, kFocus};
    const CameraView view = make_camera(desc, Vec3d(0.0));
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 500; ++i) {
      const double x = 300.0 * unit(engine) - 150.0, y = 200.0 * unit(engine) - 100.0;
      const Vec2 u(static_cast<float>(unit(engine)), static_cast<float>(unit(engine)));
      const auto seen = [&](const CameraRay& ray) {
        return CameraRay{glm::transpose(rotation) * (ray.origin - kLocation),
                         glm::transpose(rotation) * ray.direction, ray.t_max};
      };
      const CameraRay sharp = seen(film_ray(pinhole, x, y, u)), ray = seen(film_ray(view, x, y, u));
      const auto at_depth = [](const CameraRay& r, double depth) {
        return r.origin + r.direction * ((-depth - r.origin.z) / r.direction.z);
      };
      ASSERT_LT(glm::length(at_depth(sharp, kFocus) - at_depth(ray, kFocus)), 1e-11);
      const Vec3d leaves = at_depth(ray, 0.0) - at_depth(sharp, 0.0);
      const Vec2 p = aperture_point(view.aperture, u);
      ASSERT_NEAR(leaves.x, kRadius / 1.6 * static_cast<double>(p.x), 1e-11);
      ASSERT_NEAR(leaves.y, kRadius * static_cast<double>(p.y), 1e-11);
      ASSERT_NEAR(glm::length(ray.direction), 1.0, 1e-14);
      ASSERT_DOUBLE_EQ(ray.t_max, sharp.t_max);
      if (orthographic) {
        ASSERT_NEAR(-ray.origin.z, kClipStart, 1e-12);
      } else {  // as far along the ray as the pinhole's near clip is along its own
        ASSERT_NEAR(glm::length(ray.origin - at_depth(ray, 0.0)), glm::length(sharp.origin), 1e-11);
      }
    }
  }
}

TEST(ThinLens, RefusesWhatIsNoLens) {
  const auto refused = [](auto change) {
    CameraDesc desc = camera_desc(false);
    desc.lens = {kRadius, 6, 0.0, 1.0, kFocus};
    EXPECT_NO_THROW(make_camera(desc, Vec3d(0.0)));
    change(desc.lens);
    EXPECT_THROW(make_camera(desc, Vec3d(0.0)), std::invalid_argument);
  };
  refused([](LensDesc& l) { l.radius = -1.0; });
  refused([](LensDesc& l) { l.radius = std::nan(""); });
  refused([](LensDesc& l) { l.focus_distance = 0.0; });
  refused([](LensDesc& l) { l.focus_distance = std::nan(""); });
  refused([](LensDesc& l) { l.ratio = 0.0; });
  refused([](LensDesc& l) { l.rotation = std::nan(""); });
  refused([](LensDesc& l) { l.blades = 100000; });
}

}  // namespace
}  // namespace komorebi
