#pragma once

#include <algorithm>
#include <cmath>

#include "core/local_ray.h"
#include "core/motion.h"

namespace komorebi {

/// A ray in one instance's local space as curves and spheres take it: the local ray that triangles
/// take, and in doubles a frame in which the ray is the z axis. What is as thin as a hair is small
/// against the ray's length, so that floats would leave nothing of its width.
struct RoundRay {
  LocalRay local;
  Vec3d origin;
  Vec3d x, y, z;     ///< orthonormal, right-handed; z is the direction
  double length;     ///< of the direction that distances are in units of
  MotionPlace time;  ///< where it finds the set (round_time)

  /// A point seen along the ray: across it, and how far along it in units of space.
  Vec3d seen(const Vec3d& point) const {
    const Vec3d from = point - origin;
    return Vec3d(glm::dot(from, x), glm::dot(from, y), glm::dot(from, z));
  }
};

/// The frame's axes across by Duff et al. 2017 ("Building an Orthonormal Basis, Revisited"). A null
/// direction gives a length of 0, and such a ray hits nothing.
inline void set_round_frame(const Vec3d& origin, const Vec3d& direction, RoundRay& ray) {
  ray.origin = origin;
  ray.length = std::sqrt(glm::dot(direction, direction));
  ray.z = ray.length > 0.0 ? direction / ray.length : Vec3d(0.0, 0.0, 1.0);
  const double sign = ray.z.z < 0.0 ? -1.0 : 1.0;
  const double a = -1.0 / (sign + ray.z.z);
  const double b = ray.z.x * ray.z.y * a;
  ray.x = Vec3d(1.0 + sign * ray.z.x * ray.z.x * a, sign * b, -sign * ray.z.x);
  ray.y = Vec3d(b, sign + ray.z.y * ray.z.y * a, -ray.z.y);
}

inline RoundRay make_round_ray(const LocalRay& local, const Vec3& direction,
                               const MotionPlace& time) {
  RoundRay ray;
  ray.local = local;
  ray.time = time;
  set_round_frame(Vec3d(local.shear.origin), Vec3d(direction), ray);
  return ray;
}

/// Moves the distance of a hit into the interval that the primitive's own padded box leaves of the
/// ray, as intersect_triangle does and for its reason: no tree can change what is hit. False if
/// nothing is left or it is out of the ray's reach.
inline bool settle_distance(const RoundRay& ray, const Aabb& box, double depth, float* t) {
  const Interval inside = slab_interval(ray.local.slab, box, ray.local.range);
  if (inside.is_empty()) return false;
  const double at = depth / ray.length;
  if (!(at >= -double(kFloatMax) && at <= double(kFloatMax))) return false;
  const float moved = max_of(inside.begin, min_of(static_cast<float>(at), inside.end));
  if (!(ray.local.t_min < moved && moved < ray.local.t_max)) return false;
  *t = moved + 0.0f;  // never −0
  return true;
}

}  // namespace komorebi
