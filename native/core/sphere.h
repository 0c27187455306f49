#pragma once

#include "core/round_key.h"
#include "core/round_ray.h"
#include "core/scene_view.h"

namespace komorebi {

/// The padded box of a sphere at a time; empty if it has no radius.
inline Aabb sphere_bounds(const MeshView& mesh, std::uint32_t index, const MotionPlace& time) {
  const Vec4d sphere = round_key(mesh, index, time);
  if (!(sphere.radius > 0.0)) return Aabb{};
  const Aabb box{Vec3(sphere.at - sphere.radius), Vec3(sphere.at + sphere.radius)};
  return padded(box, max_abs(box) * kPadding);
}

/// The depth at which a ray enters a sphere; false if it misses.
inline bool sphere_depth(const MeshView& mesh, std::uint32_t index, const RoundRay& ray,
                         double* depth) {
  const Vec4d sphere = round_key(mesh, index, ray.time);
  const Vec3d seen = ray.seen(sphere.at);
  const double inside = sphere.radius * sphere.radius - (seen.x * seen.x + seen.y * seen.y);
  if (!(inside > 0.0)) return false;
  *depth = seen.z - std::sqrt(inside);
  return true;
}

/// The hit of a ray with a sphere from outside: as in Cycles a sphere has no inside.
inline bool intersect_sphere(const MeshView& mesh, std::uint32_t index, const RoundRay& ray,
                             float* t) {
  double depth;
  if (!sphere_depth(mesh, index, ray, &depth)) return false;
  return settle_distance(ray, sphere_bounds(mesh, index, ray.time), depth, t);
}

}  // namespace komorebi
