#pragma once

#include "core/slab.h"

namespace komorebi {

/// A ray as the triangle test needs it: the axis z that it follows most, and the shear that makes
/// it the positive z axis (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection").
struct ShearRay {
  Vec3 origin;
  int x, y, z;       ///< axes; z has the largest direction component
  float sx, sy, sz;  ///< d.x/d.z, d.y/d.z, 1/d.z
};

struct TriangleHit {
  float t;
  float u, v;  ///< weights of the second and third corner
};

inline ShearRay make_shear_ray(const Vec3& origin, const Vec3& direction) {
  const float ax = direction.x < 0.0f ? -direction.x : direction.x;
  const float ay = direction.y < 0.0f ? -direction.y : direction.y;
  const float az = direction.z < 0.0f ? -direction.z : direction.z;
  ShearRay ray;
  ray.origin = origin;
  ray.z = ax > ay ? (ax > az ? 0 : 2) : (ay > az ? 1 : 2);
  ray.x = ray.z == 2 ? 0 : ray.z + 1;
  ray.y = ray.x == 2 ? 0 : ray.x + 1;
  ray.sx = direction[ray.x] / direction[ray.z];
  ray.sy = direction[ray.y] / direction[ray.z];
  ray.sz = 1.0f / direction[ray.z];
  return ray;
}

/// Zero area, decided in double: float differences and their products are exact there for corners
/// whose coordinates lie within a factor of 2²⁹, and otherwise wrong by 1e-16 of the triangle.
/// Such triangles keep their index and are never hit. Not-a-number counts as degenerate too.
inline bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ux = double(b.x) - double(a.x), vx = double(c.x) - double(a.x);
  const double uy = double(b.y) - double(a.y), vy = double(c.y) - double(a.y);
  const double uz = double(b.z) - double(a.z), vz = double(c.z) - double(a.z);
  const double nx = uy * vz - uz * vy;
  const double ny = uz * vx - ux * vz;
  const double nz = ux * vy - uy * vx;
  return !(nx < 0.0 || nx > 0.0 || ny < 0.0 || ny > 0.0 || nz < 0.0 || nz > 0.0);
}

/// The padded box that decides with the triangle, and that every box of a tree is a union of.
inline Aabb triangle_bounds(const Vec3& a, const Vec3& b, const Vec3& c) {
  Aabb box;
  box.lo = Vec3(min_of(min_of(a.x, b.x), c.x), min_of(min_of(a.y, b.y), c.y),
                min_of(min_of(a.z, b.z), c.z));
  box.hi = Vec3(max_of(max_of(a.x, b.x), c.x), max_of(max_of(a.y, b.y), c.y),
                max_of(max_of(a.z, b.z), c.z));
  return padded(box, max_abs(box) * kPadding);
}

/// Two-sided ray–triangle test: the specification that every kernel repeats operation by
/// operation, in this order and without fused multiply-adds. The triangle is not degenerate.
///
/// Watertight: the edge function of two corners is the exact negative when a neighbour names them
/// in the other order, and rounding is monotone, so its sign is right unless it is zero; then all
/// three are computed in double, where products of floats are exact and the sign is right again.
///
/// Independent of the tree: `range` (in [t_min, t_max]) is what the instance leaves of the ray. A
/// hit counts only where the triangle's own padded box leaves something of `range`, and t is moved
/// into that interval (it is an interval around the true t, so the move is within rounding). Every
/// box above contains that interval exactly; so a box may be skipped when its interval is empty or
/// begins behind the closest hit, and no tree can change what is hit.
inline bool intersect_triangle(const ShearRay& ray, const SlabRay& slab, Interval range,
                               float t_min, float t_max, const Vec3& a, const Vec3& b,
                               const Vec3& c, TriangleHit* hit) {
  const float a_z = a[ray.z] - ray.origin[ray.z];
  const float b_z = b[ray.z] - ray.origin[ray.z];
  const float c_z = c[ray.z] - ray.origin[ray.z];
  const float a_x = (a[ray.x] - ray.origin[ray.x]) - ray.sx * a_z;
  const float a_y = (a[ray.y] - ray.origin[ray.y]) - ray.sy * a_z;
  const float b_x = (b[ray.x] - ray.origin[ray.x]) - ray.sx * b_z;
  const float b_y = (b[ray.y] - ray.origin[ray.y]) - ray.sy * b_z;
  const float c_x = (c[ray.x] - ray.origin[ray.x]) - ray.sx * c_z;
  const float c_y = (c[ray.y] - ray.origin[ray.y]) - ray.sy * c_z;
  float u = c_x * b_y - c_y * b_x;
  float v = a_x * c_y - a_y * c_x;
  float w = b_x * a_y - b_y * a_x;
  if (u == 0.0f || v == 0.0f || w == 0.0f) {
    u = float(double(c_x) * double(b_y) - double(c_y) * double(b_x));
    v = float(double(a_x) * double(c_y) - double(a_y) * double(c_x));
    w = float(double(b_x) * double(a_y) - double(b_y) * double(a_x));
  }
  const bool front = u >= 0.0f && v >= 0.0f && w >= 0.0f;
  const bool back = u <= 0.0f && v <= 0.0f && w <= 0.0f;
  if (!front && !back) return false;
  const float determinant = (u + v) + w;
  if (determinant == 0.0f) return false;
  const float height = (u * (ray.sz * a_z) + v * (ray.sz * b_z)) + w * (ray.sz * c_z);
  float t = height / determinant;
  if (!(t >= -kFloatMax && t <= kFloatMax)) return false;

  const Interval inside = slab_interval(slab, triangle_bounds(a, b, c), range);
  if (inside.is_empty()) return false;
  t = max_of(inside.begin, min_of(t, inside.end));
  if (!(t_min < t && t < t_max)) return false;
  hit->t = t + 0.0f;  // never −0
  hit->u = v / determinant;
  hit->v = w / determinant;
  return true;
}

}  // namespace komorebi
