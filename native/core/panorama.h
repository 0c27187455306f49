#pragma once

#include "core/math.h"

namespace komorebi {

/// Ways to lay directions out on a plane; the numbers are those of dumped scenes.
enum class PanoramaKind : std::uint32_t {
  kEquirectangular = 0,
  kFisheyeEquidistant = 1,
  kFisheyeEquisolid = 2,
  kMirrorBall = 3,
  kFisheyePolynomial = 4,
  kEquiangularCubeFace = 5,
  kCentralCylindrical = 6,
};

/// A panorama, made by make_panorama (render/panorama.h). A point of the film, in pixels from the
/// middle of the picture, becomes a point (a, b) of the projection's own plane by one linear map:
///
///     equirectangular        longitude and latitude in turns
///     fisheye equidistant    the circle of the field of view has radius 1
///     fisheye equisolid      millimetres on the sensor
///     fisheye polynomial     millimetres on the sensor
///     mirror ball            the ball has radius 1
///     equiangular cube face  angles from the axis in turns
///     central cylindrical    longitude in turns, height in radii of the cylinder
struct PanoramaView {
  PanoramaKind kind = PanoramaKind::kEquirectangular;
  double middle_a = 0.0, middle_b = 0.0;  ///< of the picture
  double a_per_pixel = 0.0, b_per_pixel = 0.0;
  double limit = 0.0;  ///< largest radius with a ray; of the polynomial: largest angle, in radians
  double scale = 0.0;  ///< equidistant: turns a radius; equisolid: sin of half the angle a radius
  double polynomial[5] = {};  ///< angle from the axis in radians, negated, by powers of the radius
};

namespace detail {

// The direction at an angle from the axis, of which sine and cosine are given, towards (a, b).
inline Vec3d fisheye_direction(double a, double b, double radius, double sin, double cos) {
  const bool off_axis = radius > 0.0;
  return Vec3d(off_axis ? a / radius * sin : 0.0, off_axis ? b / radius * sin : sin, -cos);
}

inline Vec3d mirror_ball_direction(double a, double b) {
  const double square = 1.0 - a * a - b * b;
  if (!(square >= 0.0)) return Vec3d(0.0);
  // The ball's normal n is (a, b, −√square); what comes along v = +Z goes on along v − 2 (n·v) n.
  const double h = 2.0 * std::sqrt(square);
  return Vec3d(h * a, h * b, 1.0 - 2.0 * square);
}

// (tan a, tan b, −1), scaled so that no tangent can be infinite.
inline Vec3d cube_face_direction(double a, double b) {
  const auto [sin_a, cos_a] = sin_cos_turns(a);
  const auto [sin_b, cos_b] = sin_cos_turns(b);
  const double product = cos_a * cos_b;
  const double sign = product < 0.0 ? -1.0 : 1.0;
  return Vec3d(sign * sin_a * cos_b, sign * cos_a * sin_b, -sign * product);
}

inline double polynomial_angle(const double (&k)[5], double r) {
  return -((((k[4] * r + k[3]) * r + k[2]) * r + k[1]) * r + k[0]);
}

}  // namespace detail

/// The direction at a point of the film, in the space of Blender's cameras (they look along −Z, +X
/// is right and +Y is up), not normalised; null where the projection has none. The projections are
/// those of Cycles: Kannala and Brandt, "A Generic Camera Model and Calibration Method", PAMI 2006,
/// names the fisheye lenses.
inline Vec3d panorama_direction(const PanoramaView& view, double x, double y) {
  const double a = view.middle_a + x * view.a_per_pixel;
  const double b = view.middle_b + y * view.b_per_pixel;
  switch (view.kind) {
    case PanoramaKind::kEquirectangular: {
      const auto longitude = sin_cos_turns(a), latitude = sin_cos_turns(b);
      return Vec3d(latitude.cos * longitude.sin, latitude.sin, -(latitude.cos * longitude.cos));
    }
    case PanoramaKind::kCentralCylindrical: {
      const auto longitude = sin_cos_turns(a);
      return Vec3d(longitude.sin, b, -longitude.cos);
    }
    case PanoramaKind::kEquiangularCubeFace:
      return detail::cube_face_direction(a, b);
    case PanoramaKind::kMirrorBall:
      return detail::mirror_ball_direction(a, b);
    case PanoramaKind::kFisheyeEquidistant:
    case PanoramaKind::kFisheyeEquisolid:
    case PanoramaKind::kFisheyePolynomial:
      break;
  }
  const double radius = std::sqrt(a * a + b * b);
  if (view.kind == PanoramaKind::kFisheyePolynomial) {
    const double angle = detail::polynomial_angle(view.polynomial, radius);
    if (!(angle <= view.limit && -angle <= view.limit)) return Vec3d(0.0);
    const auto [sin, cos] = sin_cos_turns(angle * (0.5 / kPi));
    return detail::fisheye_direction(a, b, radius, sin, cos);
  }
  if (!(radius <= view.limit)) return Vec3d(0.0);
  if (view.kind == PanoramaKind::kFisheyeEquidistant) {
    const auto [sin, cos] = sin_cos_turns(radius * view.scale);
    return detail::fisheye_direction(a, b, radius, sin, cos);
  }
  const double half = radius * view.scale;  // sin(θ/2); sin θ and cos θ follow from it
  const double square = half < 1.0 ? half * half : 1.0;
  return detail::fisheye_direction(a, b, radius, 2.0 * std::sqrt(square * (1.0 - square)),
                                   1.0 - 2.0 * square);
}

}  // namespace komorebi
