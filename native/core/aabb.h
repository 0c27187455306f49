#pragma once

#include "core/vector.h"

namespace komorebi {

inline constexpr float kFloatMax = 3.402823466e+38f;

inline float min_of(float a, float b) {
  return b < a ? b : a;
}
inline float max_of(float a, float b) {
  return a < b ? b : a;
}

/// Axis-aligned box. The empty box has lo > hi on every axis: it is the neutral element of
/// `united`, and what stands in it (a degenerate triangle, an instance that cannot be seen) is in
/// no tree and is never hit.
struct Aabb {
  Vec3 lo{kFloatMax};
  Vec3 hi{-kFloatMax};

  bool is_empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
};

/// The smallest box around both: min and max only, so a union contains its parts exactly.
inline Aabb united(const Aabb& a, const Aabb& b) {
  Aabb box;
  box.lo = Vec3(min_of(a.lo.x, b.lo.x), min_of(a.lo.y, b.lo.y), min_of(a.lo.z, b.lo.z));
  box.hi = Vec3(max_of(a.hi.x, b.hi.x), max_of(a.hi.y, b.hi.y), max_of(a.hi.z, b.hi.z));
  return box;
}

inline bool contains(const Aabb& outer, const Aabb& inner) {
  return outer.lo.x <= inner.lo.x && outer.lo.y <= inner.lo.y && outer.lo.z <= inner.lo.z &&
         outer.hi.x >= inner.hi.x && outer.hi.y >= inner.hi.y && outer.hi.z >= inner.hi.z;
}

/// Half the surface: what the chance of a random ray to meet the box is proportional to.
inline float half_area(const Aabb& box) {
  if (box.is_empty()) return 0.0f;
  const float x = box.hi.x - box.lo.x;
  const float y = box.hi.y - box.lo.y;
  const float z = box.hi.z - box.lo.z;
  return x * y + y * z + z * x;
}

/// The centre; each coordinate is halved before the sum, so that it cannot overflow.
inline Vec3 centre(const Aabb& box) {
  return Vec3(0.5f * box.lo.x + 0.5f * box.hi.x, 0.5f * box.lo.y + 0.5f * box.hi.y,
              0.5f * box.lo.z + 0.5f * box.hi.z);
}

/// The largest absolute coordinate on the box.
inline float max_abs(const Aabb& box) {
  return max_of(max_abs(box.lo), max_abs(box.hi));
}

/// The box grown by `by` on every side.
inline Aabb padded(const Aabb& box, float by) {
  Aabb grown;
  grown.lo = Vec3(box.lo.x - by, box.lo.y - by, box.lo.z - by);
  grown.hi = Vec3(box.hi.x + by, box.hi.y + by, box.hi.z + by);
  return grown;
}

}  // namespace komorebi
