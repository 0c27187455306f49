#pragma once

#include "core/vector.h"

namespace komorebi {

/// Which rays see an instance (Blender's ray visibility; one bit each).
enum RayMask : std::uint32_t {
  kMaskCamera = 1u << 0,
  kMaskDiffuse = 1u << 1,
  kMaskShadow = 1u << 2,
  kMaskRays = kMaskCamera | kMaskDiffuse | kMaskShadow,
  /// The same bits, so far up (an instance keeps eight), are for rays that see shadow catchers
  /// alone (as Cycles).
  kMaskCatcherShift = 3,
  kMaskAll = 0xffffffffu,
};

/// A ray in world space (metres, relative to the scene's origin). `direction` need not have unit
/// length; hits are reported for t_min < t < t_max, in units of `direction`.
struct Ray {
  Vec3 origin{0.0f};
  float t_min = 0.0f;
  Vec3 direction{0.0f, 0.0f, 1.0f};
  float t_max = 3.402823466e+38f;
  float time = 0.0f;                    ///< 0 = shutter opens, 1 = shutter closes
  std::uint32_t mask = kMaskAll;        ///< instances with no common bit are not seen
  std::uint32_t self_instance = kNone;  ///< the primitive that the ray leaves is never hit
  std::uint32_t self_primitive = kNone;
  std::uint32_t path_key = 0;  ///< what a filter decides by (core/hit_filter.h, core/path_key.h)
};

/// Closest hit. `u` and `v` weight the second and third corner; the first has 1 − u − v.
struct Hit {
  float t = 0.0f;
  float u = 0.0f;
  float v = 0.0f;
  std::uint32_t instance = kNone;   ///< kNone: the ray missed
  std::uint32_t primitive = kNone;  ///< Blender's loop-triangle index in the mesh
  bool valid() const { return instance != kNone; }
};

/// Rays as arrays, one entry a ray: what the tracer and the integrator's stages work on.
/// A plain view; RayBatch (render/ray_batch.h) owns such arrays.
struct RaySpan {
  const float *origin_x, *origin_y, *origin_z;
  const float *direction_x, *direction_y, *direction_z;
  const float *t_min, *t_max, *time;
  const std::uint32_t *mask, *self_instance, *self_primitive;
  std::uint32_t count = 0;
  const std::uint32_t* path_key = nullptr;  ///< null: all 0; only a scene with a filter reads it

  Ray operator[](std::uint32_t i) const {
    Ray ray;
    ray.origin = Vec3(origin_x[i], origin_y[i], origin_z[i]);
    ray.t_min = t_min[i];
    ray.direction = Vec3(direction_x[i], direction_y[i], direction_z[i]);
    ray.t_max = t_max[i];
    ray.time = time[i];
    ray.mask = mask[i];
    ray.self_instance = self_instance[i];
    ray.self_primitive = self_primitive[i];
    if (path_key != nullptr) ray.path_key = path_key[i];
    return ray;
  }
};

}  // namespace komorebi
