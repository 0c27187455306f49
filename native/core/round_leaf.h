#pragma once

#include <bit>

#include "core/curve.h"
#include "core/sphere.h"

namespace komorebi {

/// A leaf of a tree over curves or points: one item, and a capsule that contains it, so that most
/// rays need not look at its keys, which lie elsewhere. The ends of the capsule's axis are places
/// on a grid over the whole set (MeshView::leaf_grid); the radius is the upper half of a float.
struct RoundLeaf {
  std::uint32_t item;
  std::uint32_t
      entry;  ///< of a curve's segment2key, so that nothing else stands between it and the keys
  std::uint16_t begin[3], end[3];
  std::uint16_t radius;
};
static_assert(sizeof(RoundLeaf) == 24);

namespace detail {

inline Vec3d grid_place(const LeafGrid& grid, const std::uint16_t* at) {
  return Vec3d(grid.origin) + Vec3d(at[0], at[1], at[2]) * Vec3d(grid.step);
}

inline void put_on_grid(const LeafGrid& grid, const Vec3d& place, std::uint16_t* at) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto step = double(grid.step[axis]);
    const double q = step > 0.0 ? (place[axis] - double(grid.origin[axis])) / step + 0.5 : 0.0;
    at[axis] = static_cast<std::uint16_t>(q < 0.0 ? 0.0 : q > 65535.0 ? 65535.0 : q);
  }
}

inline double distance_from_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d e = b - a;
  const double length2 = glm::dot(e, e);
  double s = length2 > 0.0 ? glm::dot(p - a, e) / length2 : 0.0;
  s = s < 0.0 ? 0.0 : s > 1.0 ? 1.0 : s;
  const Vec3d from = p - (a + s * e);
  return std::sqrt(glm::dot(from, from));
}

/// The float whose upper half is kept, not below `radius`.
inline std::uint16_t radius_above(double radius) {
  const double more = radius * (1.0 + 1e-6);
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(more));
  return static_cast<std::uint16_t>((bits >> 16) + 1);
}

}  // namespace detail

/// The grid of a set with those bounds.
inline LeafGrid make_leaf_grid(const Aabb& bounds) {
  LeafGrid grid;
  if (bounds.is_empty()) return grid;
  grid.origin = bounds.lo;
  grid.step = (bounds.hi - bounds.lo) / 65535.0f;
  return grid;
}

namespace detail {

/// The radius that a capsule around `axis` a–b needs to hold an item of a set of curves at a time.
/// The distance from the axis is convex, and so greatest at the ends of straight pieces; what bends
/// is nearer to them than an eighth of the second derivative.
inline double curve_reach(const MeshView& set, const CurveItem& item, const MotionPlace& time,
                          const Vec3d& a, const Vec3d& b) {
  const CurveSegment segment = curve_segment(set, item.entry, time);
  double reach = 0.0;
  for (std::uint32_t i = item.first; i <= item.last; ++i) {
    const Vec4d at = segment.point(piece_begin(set, i));
    reach = std::max(reach, distance_from_segment(at.at, a, b) + std::max(at.radius, 0.0));
  }
  if (set.shape == CurveShape::kThick) {
    const double step = 1.0 / double(set.pieces);
    const Vec4d bend = 0.125 * step * step * segment.bend();
    reach += (bend.at.x + bend.at.y) + (bend.at.z + bend.radius);
  }
  return reach;
}

}  // namespace detail

/// A capsule around the item where it is at the middle one of `times`, wide enough for all of them
/// and, since all that its width is made of is a convex function of time between sets, for what
/// lies between.
/// @param times  of a set that stands still kAtRest alone
inline RoundLeaf make_round_leaf(const MeshView& set, std::uint32_t item, const MotionPlace* times,
                                 std::size_t time_count) {
  RoundLeaf leaf{};
  leaf.item = item;
  const LeafGrid& grid = set.leaf_grid;
  const MotionPlace& middle = times[time_count / 2];
  double radius = 0.0;
  if (set.kind == PrimitiveKind::kSphere) {
    detail::put_on_grid(grid, round_key(set, item, middle).at, leaf.begin);
    std::copy_n(leaf.begin, 3, leaf.end);
    const Vec3d a = detail::grid_place(grid, leaf.begin);
    for (std::size_t i = 0; i < time_count; ++i) {
      const Vec4d sphere = round_key(set, item, times[i]);
      radius = std::max(radius, detail::distance_from_segment(sphere.at, a, a) + sphere.radius);
    }
    leaf.radius = detail::radius_above(radius);
    return leaf;
  }
  const CurveItem its = curve_item(set, item);
  leaf.entry = its.entry;
  const CurveSegment segment = curve_segment(set, its.entry, middle);
  detail::put_on_grid(grid, segment.point(piece_begin(set, its.first)).at, leaf.begin);
  detail::put_on_grid(grid, segment.point(piece_begin(set, its.last)).at, leaf.end);
  const Vec3d a = detail::grid_place(grid, leaf.begin), b = detail::grid_place(grid, leaf.end);
  for (std::size_t i = 0; i < time_count; ++i) {
    radius = std::max(radius, detail::curve_reach(set, its, times[i], a, b));
  }
  leaf.radius = detail::radius_above(radius);
  return leaf;
}

/// Whether a ray passes the capsule by: then it does not meet the item.
inline bool misses_leaf(const LeafGrid& grid, const RoundLeaf& leaf, const RoundRay& ray) {
  const Vec3d a = detail::grid_place(grid, leaf.begin) - ray.origin;
  const Vec3d b = detail::grid_place(grid, leaf.end) - ray.origin;
  const auto radius = double(std::bit_cast<float>(std::uint32_t{leaf.radius} << 16));
  const Vec4d from{Vec3d(glm::dot(a, ray.x), glm::dot(a, ray.y), 0.0), 0.0};
  const Vec4d to{Vec3d(glm::dot(b, ray.x), glm::dot(b, ray.y), 0.0), 0.0};
  return detail::misses_chord(from, to, radius);
}

}  // namespace komorebi
