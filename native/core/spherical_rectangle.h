#pragma once

#include "core/math.h"

namespace komorebi {

/// A rectangle as a point sees it, and points of it that are even in solid angle: Ureña, Fajardo
/// and King, "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013. In doubles,
/// since angles of a small rectangle are differences of large ones; arcsines in place of the
/// paper's arccosines, which lose 2π twice.
struct SphericalRectangle {
  double x0, x1, y0, y1;  ///< edges, from the point, along the rectangle's axes
  double height;          ///< of the point above the plane, positive
  double solid_angle;     ///< 0 where it is too small to be known

  struct Place {
    double x, y;
  };
  /// Where u and v, each in [0, 1), come to lie.
  Place sample(double u, double v) const;

 private:
  friend SphericalRectangle make_spherical_rectangle(double, double, double, double, double);
  double below_, above_;  // z of the normals of the planes through the edges y0 and y1
  double angle_from_;     // where the first angle starts
};

namespace detail {

inline double clamped(double x, double lo, double hi) {
  return x < lo ? lo : x > hi ? hi : x;
}

inline double arcsine(double x) {
  const double s = clamped(x, -1.0, 1.0);
  return atan2_radians(s, std::sqrt((1.0 - s) * (1.0 + s)));
}

}  // namespace detail

inline SphericalRectangle make_spherical_rectangle(double x0, double x1, double y0, double y1,
                                                   double height) {
  using detail::arcsine;
  const auto tilt = [height](double edge) {
    return edge / std::sqrt(edge * edge + height * height);
  };
  const double n0 = -tilt(y0), n1 = tilt(x1), n2 = tilt(y1), n3 = -tilt(x0);
  const double g2 = arcsine(-n2 * n3), g3 = arcsine(-n3 * n0);
  SphericalRectangle r{};
  r.x0 = x0;
  r.x1 = x1;
  r.y0 = y0;
  r.y1 = y1;
  r.height = height;
  r.below_ = n0;
  r.above_ = n2;
  r.angle_from_ = g2 + g3;
  const double solid_angle = -(arcsine(-n0 * n1) + arcsine(-n1 * n2) + g2 + g3);
  constexpr double kLeast = 1e-9;  // known to a millionth
  r.solid_angle = solid_angle > kLeast ? solid_angle : 0.0;
  return r;
}

inline SphericalRectangle::Place SphericalRectangle::sample(double u, double v) const {
  const auto [sin, cos] = sin_cos_turns((u * solid_angle + angle_from_) / (2.0 * kPi));
  const double rise = cos * below_ + above_;
  const double length = std::sqrt(rise * rise + below_ * below_ * sin * sin);
  const double s = sin < 0.0 ? -sin : sin;
  const double size = length > 0.0 ? detail::clamped(s / length, 0.0, 1.0) : 0.0;
  const double c = (rise < 0.0) != (sin < 0.0) ? -size : size;
  const double across = std::sqrt((1.0 - c) * (1.0 + c));
  const double x = across > 0.0 ? c * height / across : c * 1e300;
  Place place{detail::clamped(x, x0, x1), 0.0};
  const double d2 = place.x * place.x + height * height;
  const double h0 = y0 / std::sqrt(d2 + y0 * y0), h1 = y1 / std::sqrt(d2 + y1 * y1);
  const double h = h0 + v * (h1 - h0);
  const double rest = (1.0 - h) * (1.0 + h);
  place.y = detail::clamped(rest > 0.0 ? h * std::sqrt(d2 / rest) : y1, y0, y1);
  return place;
}

}  // namespace komorebi
