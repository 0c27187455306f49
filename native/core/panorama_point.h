#pragma once

#include "core/panorama.h"

namespace komorebi {

namespace detail {

inline double turns_of(double y, double x) {
  return atan2_radians(y, x) * (0.5 / kPi);
}

/// The radius whose angle from the axis this is, by Newton's method from where the polynomial's
/// linear part has it. Twenty steps are what Cycles takes too.
inline double polynomial_radius(const double (&k)[5], double angle) {
  double r = (-angle - k[0]) / k[1];
  for (int step = 0; step < 20; ++step) {
    const double slope = -(((4.0 * k[4] * r + 3.0 * k[3]) * r + 2.0 * k[2]) * r + k[1]);
    const double change = (polynomial_angle(k, r) - angle) / slope;
    r -= change;
    if (change <= 1e-13 * r && -change <= 1e-13 * r) break;
  }
  return r;
}

/// How far from the middle of a fisheye's plane an angle from the axis lies, in radians.
inline double fisheye_radius(const PanoramaView& view, double angle) {
  const double turns = angle * (0.5 / kPi);
  switch (view.kind) {
    case PanoramaKind::kFisheyeEquisolid:
      return sin_cos_turns(0.5 * turns).sin / view.scale;
    case PanoramaKind::kFisheyePolynomial:
      return polynomial_radius(view.polynomial, angle);
    default:
      return turns / view.scale;
  }
}

}  // namespace detail

/// Where on the film, in pixels from the middle of the picture, a direction of any length is seen:
/// the way back of panorama_direction, also for what lies beyond its limits. Longitudes are −1/2 to
/// 1/2 a turn, so that what crosses the seam leaps, as in Cycles. Not finite where a projection
/// leads nowhere.
inline glm::dvec2 panorama_point(const PanoramaView& view, const Vec3d& direction) {
  using namespace detail;
  const Vec3d& d = direction;
  double a = 0.0, b = 0.0;
  switch (view.kind) {
    case PanoramaKind::kEquirectangular:
      a = turns_of(d.x, -d.z);
      b = turns_of(d.y, std::sqrt(d.x * d.x + d.z * d.z));
      break;
    case PanoramaKind::kCentralCylindrical:
      a = turns_of(d.x, -d.z);
      b = d.y / std::sqrt(d.x * d.x + d.z * d.z);
      break;
    case PanoramaKind::kEquiangularCubeFace:
      a = turns_of(d.x, -d.z);
      b = turns_of(d.y, -d.z);
      break;
    case PanoramaKind::kMirrorBall: {
      const double length = std::sqrt(glm::dot(d, d));
      const double square = 0.5 * (1.0 - d.z / length);  // 1 − a² − b²
      const double h = 2.0 * length * std::sqrt(square > 0.0 ? square : 0.0);
      a = h > 0.0 ? d.x / h : 0.0;
      b = h > 0.0 ? d.y / h : 0.0;
      break;
    }
    case PanoramaKind::kFisheyeEquidistant:
    case PanoramaKind::kFisheyeEquisolid:
    case PanoramaKind::kFisheyePolynomial: {
      const double across = std::sqrt(d.x * d.x + d.y * d.y);
      const double radius = fisheye_radius(view, atan2_radians(across, -d.z));
      a = across > 0.0 ? d.x / across * radius : radius;
      b = across > 0.0 ? d.y / across * radius : 0.0;
      break;
    }
  }
  return {(a - view.middle_a) / view.a_per_pixel, (b - view.middle_b) / view.b_per_pixel};
}

}  // namespace komorebi
