#pragma once

#include "core/local_ray.h"
#include "core/motion.h"

namespace komorebi {

/// An instance between two of its keys: matrices are interpolated linearly, which the keys are
/// close enough for (render/instance_motion.h), in double and rounded as those of an instance that
/// stands still.
inline InstanceView moved_instance(const InstanceView& instance, const MotionKey* key,
                                   double fraction) {
  const double s = 1.0 - fraction;
  Mat3d linear;
  for (int c = 0; c < 3; ++c) {
    linear[c] =
        s * Vec3d(key[0].world_from_local[c]) + fraction * Vec3d(key[1].world_from_local[c]);
  }
  InstanceView at = instance;
  at.world_from_local = Mat3(linear);
  at.local_from_world = Mat3(glm::inverse(linear));  // without one, enter_instance is false
  at.position = Vec3(s * Vec3d(key[0].position) + fraction * Vec3d(key[1].position));
  at.world_bounds = key[0].world_bounds;
  return at;
}

/// An instance as a ray of that time meets it; `room` is for one that moves.
inline const InstanceView& instance_at(const SceneView& scene, std::uint32_t index, float time,
                                       InstanceView& room) {
  const InstanceView& instance = scene.instances[index];
  if (instance.motion == kNoMotion) return instance;
  const InstanceMotion& motion = scene.motions[instance.motion];
  const MotionPlace place = motion_place(motion.key_count, static_cast<double>(time));
  room =
      moved_instance(instance, scene.motion_keys + motion.first_key + place.step, place.fraction);
  return room;
}

/// enter_instance for some of a moving instance's time; false for rays of another. The box that
/// decides is that of the ray's own segment.
/// @param at  becomes the instance at the ray's time
inline bool enter_group(const SceneView& scene, const MotionGroup& group, const Ray& ray,
                        const SlabRay& world, InstanceView* at, LocalRay* local) {
  const InstanceView& instance = scene.instances[group.instance];
  if ((instance.mask & ray.mask) == 0) return false;
  const InstanceMotion& motion = scene.motions[instance.motion];
  const MotionPlace place = motion_place(motion.key_count, static_cast<double>(ray.time));
  if (place.step < group.first_segment || place.step >= group.end_segment) return false;
  const MotionKey* key = scene.motion_keys + motion.first_key + place.step;
  if (slab_interval(world, key->world_bounds, Interval{ray.t_min, ray.t_max}).is_empty()) {
    return false;
  }
  *at = moved_instance(instance, key, place.fraction);
  return enter_instance(*at, ray, world, local);
}

}  // namespace komorebi
