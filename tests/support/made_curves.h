#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "render/mesh.h"

namespace komorebi::testing {

/// Curves that own their arrays.
struct Curves {
  std::vector<float> xyz, radius;
  std::vector<std::int32_t> offsets{0};
  CurveShape shape = CurveShape::kRibbon;

  void key(const Vec3d& at, double r) {
    for (int c = 0; c < 3; ++c) xyz.push_back(static_cast<float>(at[c]));
    radius.push_back(static_cast<float>(r));
  }
  void end_curve() { offsets.push_back(static_cast<std::int32_t>(radius.size())); }

  CurvesInput input(const std::string& name = "test") const {
    CurvesInput in;
    in.name = name;
    in.key2xyz = xyz;
    in.key2radius = radius;
    in.curve_offsets = offsets;
    in.shape = shape;
    return in;
  }
};

/// Hair on a sphere of radius 1 around null, each as long as `length`, bent and thinner at the tip.
inline Curves made_fur(std::uint32_t strands, std::uint32_t segments, double length, double width,
                       double bend, CurveShape shape, unsigned seed = 1) {
  Curves curves;
  curves.shape = shape;
  std::mt19937 random(seed);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const auto in_ball = [&] {
    Vec3d v(uniform(), uniform(), uniform());
    while (glm::dot(v, v) > 1.0 || glm::dot(v, v) < 1e-3) v = {uniform(), uniform(), uniform()};
    return v;
  };
  for (std::uint32_t s = 0; s < strands; ++s) {
    Vec3d at = glm::normalize(in_ball());
    Vec3d along = glm::normalize(at + 0.4 * in_ball());
    const Vec3d turn = bend * in_ball() / double(segments);
    for (std::uint32_t k = 0; k <= segments; ++k) {
      curves.key(at, width * (1.0 - 0.7 * double(k) / double(segments)));
      at += length / double(segments) * along;
      along = glm::normalize(along + turn + 0.3 * bend / double(segments) * in_ball());
    }
    curves.end_curve();
  }
  return curves;
}

inline Curves scaled_fur(Curves curves, double scale) {
  for (float& x : curves.xyz) x = static_cast<float>(scale * double(x));
  for (float& r : curves.radius) r = static_cast<float>(scale * double(r));
  return curves;
}

/// Keys or points in time, rows as RoundMotion takes them: `move(position, time)` and
/// `grow(radius, time)` at `others` + 1 times, of which the middle one becomes the rest.
struct MovedKeys {
  std::vector<float> rest_xyz, rest_radius, xyz, radius;

  template <class Move, class Grow>
  MovedKeys(const std::vector<float>& at, const std::vector<float>& wide, int others,
            const Move& move, const Grow& grow) {
    for (int i = 0; i <= others; ++i) {
      const double time = double(i) / others;
      const bool is_rest = 2 * i == others;
      for (std::size_t k = 0; k < wide.size(); ++k) {
        const Vec3d p = move(Vec3d(at[3 * k], at[3 * k + 1], at[3 * k + 2]), time);
        for (int c = 0; c < 3; ++c) (is_rest ? rest_xyz : xyz).push_back(static_cast<float>(p[c]));
        (is_rest ? rest_radius : radius).push_back(static_cast<float>(grow(double(wide[k]), time)));
      }
    }
  }
  RoundMotion motion() const { return {xyz, radius, {}}; }

  /// What stands still where these are at a time.
  Curves still(const Curves& like, int others, double time) const {
    const std::size_t count = like.radius.size(), half = std::size_t(others) / 2;
    const double place = time * others;
    const auto from = std::min(static_cast<std::size_t>(place), std::size_t(others) - 1);
    const double f = place - double(from);
    const auto row = [&](const std::vector<float>& moved, const std::vector<float>& rest,
                         std::size_t set, std::size_t i, std::size_t width) {
      if (set == half) return double(rest[i]);
      return double(moved[(set < half ? set : set - 1) * width * count + i]);
    };
    Curves at = like;
    for (std::size_t i = 0; i < at.xyz.size(); ++i) {
      at.xyz[i] = static_cast<float>((1.0 - f) * row(xyz, rest_xyz, from, i, 3) +
                                     f * row(xyz, rest_xyz, from + 1, i, 3));
    }
    for (std::size_t i = 0; i < count; ++i) {
      at.radius[i] = static_cast<float>((1.0 - f) * row(radius, rest_radius, from, i, 1) +
                                        f * row(radius, rest_radius, from + 1, i, 1));
    }
    return at;
  }
};

}  // namespace komorebi::testing
