#pragma once

#include "core/motion.h"
#include "core/scene_view.h"

namespace komorebi {

/// x, y, z and radius.
struct Vec4d {
  Vec3d at;
  double radius;
};
inline Vec4d operator+(const Vec4d& a, const Vec4d& b) {
  return {a.at + b.at, a.radius + b.radius};
}
inline Vec4d operator-(const Vec4d& a, const Vec4d& b) {
  return {a.at - b.at, a.radius - b.radius};
}
inline Vec4d operator*(double s, const Vec4d& a) {
  return {s * a.at, s * a.radius};
}

/// Between which sets of keys or points a time lies; that of a set which stands still.
inline constexpr MotionPlace kAtRest{0, 0.0};
inline MotionPlace round_time(const MeshView& set, float time) {
  return set.position_sets == 1 ? kAtRest
                                : motion_place(set.position_sets, static_cast<double>(time));
}

/// A key, or point, as one of the sets has it.
inline Vec4d set_key(const MeshView& set, std::uint32_t key, std::uint32_t which) {
  const float* k = set.points + 4 * (std::size_t{which} * set.point_count + key);
  return {Vec3d(k[0], k[1], k[2]), double(k[3])};
}

/// A key of a set of curves, or a point, at a time (round_time): linear between sets, radius and
/// all, as Cycles has it. In doubles, since a float on the way could be off by a hair.
inline Vec4d round_key(const MeshView& set, std::uint32_t key, const MotionPlace& time) {
  if (set.position_sets == 1) return set_key(set, key, 0);
  return (1.0 - time.fraction) * set_key(set, key, time.step) +
         time.fraction * set_key(set, key, time.step + 1);
}

}  // namespace komorebi
