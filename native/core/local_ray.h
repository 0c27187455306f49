#pragma once

#include "core/scene_view.h"
#include "core/triangle.h"

namespace komorebi {

/// A ray in one instance's local space, ready for its mesh's tree. Distances stay the world's: the
/// direction is transformed and not normalised.
struct LocalRay {
  SlabRay slab;
  ShearRay shear;
  Interval range;  ///< what the instance's world box leaves of (t_min, t_max)
  float t_min, t_max;
};

inline SlabRay make_world_slab(const Ray& ray) {
  return make_slab_ray(ray.origin, ray.direction, Vec3(max_abs(ray.origin) * kPadding));
}

/// m · v with the sums in a fixed order.
inline Vec3 product(const Mat3& m, const Vec3& v) {
  return Vec3((m[0].x * v.x + m[1].x * v.y) + m[2].x * v.z,
              (m[0].y * v.x + m[1].y * v.y) + m[2].y * v.z,
              (m[0].z * v.x + m[1].z * v.y) + m[2].z * v.z);
}

inline Vec3 absolute(const Vec3& v) {
  return Vec3(v.x < 0.0f ? -v.x : v.x, v.y < 0.0f ? -v.y : v.y, v.z < 0.0f ? -v.z : v.z);
}

inline Mat3 absolute(const Mat3& m) {
  return Mat3(absolute(m[0]), absolute(m[1]), absolute(m[2]));
}

/// A ray's direction in an instance's space.
inline Vec3 local_direction(const InstanceView& instance, const Ray& ray) {
  return product(instance.local_from_world, ray.direction);
}

/// Rounding of the way into local space per axis, the ray origin's part apart: the direction's
/// error acts over the length of the ray, which up to a hit is at most the ray origin's distance
/// from `position` (bounded per ray) and that of the hit from it (here).
inline Vec3 local_error(const InstanceView& instance) {
  const Aabb& box = instance.world_bounds;
  const Vec3 to_lower = absolute(box.lo - instance.position);
  const Vec3 to_upper = absolute(box.hi - instance.position);
  const Vec3 reach(max_of(to_lower.x, to_upper.x), max_of(to_lower.y, to_upper.y),
                   max_of(to_lower.z, to_upper.z));
  return product(absolute(instance.local_from_world), reach) * kPadding;
}

/// Takes a ray into an instance; false if the instance cannot be hit by it: no common mask bit, or
/// the ray misses its world box (its own box, not a node's, so that the tree over the instances
/// decides nothing).
///
/// The local origin carries the rounding of M·(o − p), bounded per axis by |M|·|o − p|, so that
/// also a flattened or sheared instance's boxes are conservative for the true ray; the direction's
/// part of the error is bounded through the instance's extent (local_error).
inline bool enter_instance(const InstanceView& instance, const Ray& ray, const SlabRay& world,
                           LocalRay* local) {
  if ((instance.mask & ray.mask) == 0) return false;
  if (instance.world_bounds.is_empty()) return false;
  local->range = slab_interval(world, instance.world_bounds, Interval{ray.t_min, ray.t_max});
  if (local->range.is_empty()) return false;
  const Vec3 offset = ray.origin - instance.position;
  const Vec3 origin = product(instance.local_from_world, offset);
  const Vec3 direction = local_direction(instance, ray);
  const Vec3 spread = product(absolute(instance.local_from_world), absolute(offset));
  const Vec3 error = spread * kPadding + local_error(instance);
  const Vec3 shift = error + Vec3(max_abs(origin) * kPadding);
  local->slab = make_slab_ray(origin, direction, shift);
  if (!is_usable(local->slab)) return false;
  local->shear = make_shear_ray(origin, direction);
  local->t_min = ray.t_min;
  local->t_max = ray.t_max;
  return true;
}

}  // namespace komorebi
