#pragma once

#include "bvh/traverse.h"
#include "render/lamp_light.h"

namespace komorebi {

/// Calls visit(contribution, visible) for the rays of a point that could bring light of lamps, one
/// after another: the specification of LampCaster, which agrees to the bit.
template <class Visit>
void for_each_lamp_ray(const RenderContext& context, const SurfacePoint& point, const Hit& hit,
                       const Sampler& sampler, std::uint32_t vertex, std::uint32_t sample,
                       float time, const Visit& visit) {
  LampPoint lit{leaving_origin(point), point.normal, point.geometric_normal,
                terminator(context, hit, time, point.geometric_normal)};
  for (std::uint32_t j = 0; j < lamp_rays(context); ++j) {
    const LampRay drawn = draw_lamp_ray(context, lit, sampler, vertex, sample, j);
    if (drawn.contribution == Vec3(0.0f)) continue;
    if (drawn.flags & lamps_left_out(context.lamp_mask)) continue;
    Ray ray;
    ray.origin = lit.origin;
    ray.direction = drawn.direction;
    ray.t_max = drawn.t_max;
    ray.time = time;
    ray.mask = context.lamp_mask;
    ray.path_key = lamp_path_key(context, sampler, vertex, sample, j);
    ray.self_instance = hit.instance;
    ray.self_primitive = hit.primitive;
    if (drawn.lift > 0.0f) {
      ray.origin += drawn.lift * lit.end.lift;
      if (drawn.below) ray.self_instance = ray.self_primitive = kNone;
    }
    const bool free = (drawn.flags & kLampNoShadow) || !occluded_scalar(context.scene, ray);
    visit(drawn.contribution, free);
  }
}

/// What all of them bring.
inline Vec3 lamp_light(const RenderContext& context, const SurfacePoint& point, const Hit& hit,
                       const Sampler& sampler, std::uint32_t vertex, std::uint32_t sample,
                       float time) {
  Vec3 light(0.0f);
  for_each_lamp_ray(context, point, hit, sampler, vertex, sample, time,
                    [&](const Vec3& contribution, bool visible) {
                      if (visible) light += contribution;
                    });
  return light;
}

}  // namespace komorebi
