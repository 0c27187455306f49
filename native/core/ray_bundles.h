#pragma once

#include "core/ray.h"

namespace komorebi {

/// Rays that leave common points, as arrays: what ambient occlusion and sky light cast. What the
/// rays of a point share is stored once a point. World space, as Ray; t_min is 0.
struct RayBundles {
  // One entry a point.
  const float *origin_x, *origin_y, *origin_z, *time;
  const std::uint32_t *self_instance, *self_primitive;
  const std::uint32_t* first_ray;  ///< [point_count + 1]; point p has rays first_ray[p]…[p + 1] − 1
  std::uint32_t point_count = 0;
  std::uint32_t mask = kMaskAll;
  /// Where ray i's entries stand below, [ray_count]; null: at i.
  const std::uint32_t* place = nullptr;
  // One entry a ray.
  const float *direction_x, *direction_y, *direction_z, *t_max;
  const std::uint32_t* path_key;  ///< null: all 0; only a scene with a filter reads it

  std::uint32_t ray_count() const { return point_count == 0 ? 0 : first_ray[point_count]; }

  /// Ray `i` of point `p`, as a single ray.
  Ray ray(std::uint32_t p, std::uint32_t i) const {
    const std::uint32_t at = place == nullptr ? i : place[i];
    Ray ray;
    ray.origin = Vec3(origin_x[p], origin_y[p], origin_z[p]);
    ray.direction = Vec3(direction_x[at], direction_y[at], direction_z[at]);
    ray.t_max = t_max[at];
    ray.time = time[p];
    ray.mask = mask;
    ray.self_instance = self_instance[p];
    ray.self_primitive = self_primitive[p];
    if (path_key != nullptr) ray.path_key = path_key[at];
    return ray;
  }
};

}  // namespace komorebi
