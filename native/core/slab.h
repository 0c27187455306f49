#pragma once

#include "core/aabb.h"

namespace komorebi {

/// Part of a ray, in units of its direction; empty when begin > end (or either is not a number).
struct Interval {
  float begin;
  float end;
  bool is_empty() const { return !(begin <= end); }
};

/// Relative error that boxes and rays are padded by: 16 half-ulps.
///
/// Why it is enough. The triangle test (core/triangle.h) moves a vertex by at most
/// 4·2⁻²⁴·(|v| + |o|) in its sheared frame; the slab test below rounds each plane's distance by at
/// most 3·2⁻²⁴·(|v| + |o|); padding itself rounds once more. That is 8·2⁻²⁴ of the largest
/// coordinates of triangle and ray origin; the boxes carry 16·2⁻²⁴ of the first, the ray 16·2⁻²⁴
/// of the second. Nothing depends on the scene's scale.
inline constexpr float kPadding = 0x1p-20f;

/// A ray as the box test needs it. The near planes are met from an origin moved forward along the
/// ray, the far planes from one moved back, which is the same as growing every box.
struct SlabRay {
  Vec3 near_origin;
  Vec3 far_origin;
  Vec3 inverse;  ///< 1 / direction, finite and never 0
};

/// One axis: a direction too small against the largest component is replaced by a tiny one with
/// its sign, so that the reciprocal is finite and no 0·∞ ever occurs. Over the length of any ray
/// that moves the hit by 1e-20 of that length, far below the padding.
inline float slab_inverse(float d, float tiniest) {
  const float magnitude = d < 0.0f ? -d : d;
  if (magnitude < tiniest) return 1.0f / (d < 0.0f ? -tiniest : tiniest);
  return 1.0f / d;
}

/// `shift`: bound on the error of the origin, per axis, in the same units (≥ 0).
inline SlabRay make_slab_ray(const Vec3& origin, const Vec3& direction, const Vec3& shift) {
  const float tiniest = max_of(max_abs(direction) * 1e-20f, 1e-37f);
  SlabRay ray;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = slab_inverse(direction[axis], tiniest);
    const float forward = inverse < 0.0f ? -shift[axis] : shift[axis];
    ray.inverse[axis] = inverse;
    ray.near_origin[axis] = origin[axis] + forward;
    ray.far_origin[axis] = origin[axis] - forward;
  }
  return ray;
}

/// Whether the box test means anything: false for a ray with infinities or numbers that are none,
/// or so far out that it would even seem to meet the empty box. Such a ray hits nothing.
inline bool is_usable(const SlabRay& ray) {
  for (int axis = 0; axis < 3; ++axis) {
    const float near = ray.near_origin[axis], far = ray.far_origin[axis];
    const float inverse = ray.inverse[axis] < 0.0f ? -ray.inverse[axis] : ray.inverse[axis];
    if (!(near > -1e37f && near < 1e37f && far > -1e37f && far < 1e37f)) return false;
    if (!(inverse > 0.0f && inverse <= kFloatMax)) return false;
  }
  return true;
}

/// The part of `range` that lies in the box: Ize 2013 with the padding moved into box and ray.
/// Only subtraction, a product with a constant, min and max: all monotone in the box's planes, so
/// the interval of a box contains the interval of every box inside it, exactly and not up to
/// rounding. That is what makes hits independent of the tree.
inline Interval slab_interval(const SlabRay& ray, const Aabb& box, Interval range) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool backward = ray.inverse[axis] < 0.0f;
    const float near_plane = backward ? box.hi[axis] : box.lo[axis];
    const float far_plane = backward ? box.lo[axis] : box.hi[axis];
    const float begin = (near_plane - ray.near_origin[axis]) * ray.inverse[axis];
    const float end = (far_plane - ray.far_origin[axis]) * ray.inverse[axis];
    range.begin = max_of(range.begin, begin);
    range.end = min_of(range.end, end);
  }
  return range;
}

}  // namespace komorebi
