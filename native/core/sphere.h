#pragma once

#include "core/round_ray.h"
#include "core/scene_view.h"

namespace komorebi {

inline Vec3d sphere_centre(const MeshView& mesh, std::uint32_t index) {
  const float* p = mesh.points + 4 * std::size_t{index};
  return Vec3d(p[0], p[1], p[2]);
}
inline double sphere_radius(const MeshView& mesh, std::uint32_t index) {
  return double(mesh.points[4 * std::size_t{index} + 3]);
}

/// The padded box of a sphere; empty if it has no radius.
inline Aabb sphere_bounds(const MeshView& mesh, std::uint32_t index) {
  const double radius = sphere_radius(mesh, index);
  if (!(radius > 0.0)) return Aabb{};
  const Vec3d centre = sphere_centre(mesh, index);
  const Aabb box{Vec3(centre - radius), Vec3(centre + radius)};
  return padded(box, max_abs(box) * kPadding);
}

/// The depth at which a ray enters a sphere; false if it misses.
inline bool sphere_depth(const MeshView& mesh, std::uint32_t index, const RoundRay& ray,
                         double* depth) {
  const Vec3d seen = ray.seen(sphere_centre(mesh, index));
  const double radius = sphere_radius(mesh, index);
  const double inside = radius * radius - (seen.x * seen.x + seen.y * seen.y);
  if (!(inside > 0.0)) return false;
  *depth = seen.z - std::sqrt(inside);
  return true;
}

/// The hit of a ray with a sphere from outside: as in Cycles a sphere has no inside.
inline bool intersect_sphere(const MeshView& mesh, std::uint32_t index, const RoundRay& ray,
                             float* t) {
  double depth;
  if (!sphere_depth(mesh, index, ray, &depth)) return false;
  return settle_distance(ray, sphere_bounds(mesh, index), depth, t);
}

}  // namespace komorebi
