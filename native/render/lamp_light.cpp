#include "render/lamp_light.h"

namespace komorebi {
namespace {

/// Cycles' shadow ray from a point above a coarse smooth surface goes to the same point of the
/// lamp.
void lift(const Terminator& end, float share, const LampSample& drawn, const Vec3& normal,
          LampRay& ray) {
  ray.lift = share;
  if (!(share > 0.0f)) return;
  if (drawn.distance < kFloatMax) {
    ray.direction = drawn.distance * drawn.direction - share * end.lift;
    ray.t_max = 1.0f;
  }
  ray.below = !(glm::dot(ray.direction, normal) > 0.0f);
}

}  // namespace

std::uint32_t lamp_rays(const RenderContext& context) {
  if (context.lamps.count == 0) return 0;
  if (context.lamp_samples > 0) return context.lamp_samples;
  return is_dark(context) ? context.light_samples : (context.light_samples + 1) / 2;
}

LampRay draw_lamp_ray(const RenderContext& context, const LampPoint& point, const Sampler& sampler,
                      std::uint32_t vertex, std::uint32_t sample, std::uint32_t j) {
  const std::uint32_t rays = lamp_rays(context);
  const Bits2 bits = sampler.bits_2d(vertex_dimension(vertex, kVertexLamp), sample * rays + j);
  LampRay ray;
  const LampChoice choice = choose_lamp(context.lamps, point.origin, point.normal, vertex,
                                        bits.x * 2.3283064365386963e-10);
  if (choice.lamp == kNone || !(choice.probability > 0.0f)) return ray;
  const Lamp& lamp = context.lamps.lamps[choice.lamp];
  const LampSample drawn =
      sample_lamp(lamp, point.origin, point.normal, Vec2(choice.u, to_unit_float(bits.y)));
  const float cosine = glm::dot(drawn.direction, point.normal);
  if (!(drawn.pdf > 0.0f && cosine > 0.0f)) return ray;
  const bool bends = context.lifts_lamp_rays && point.end.cutoff > 0.0f;
  const float geometric_cosine = glm::dot(drawn.direction, point.geometric_normal);
  if (!bends && !(geometric_cosine > 0.0f)) return ray;
  const float weight =
      kInvPi * cosine / (drawn.pdf * choice.probability * static_cast<float>(rays));
  ray.contribution = context.albedo * drawn.radiance * weight;
  ray.direction = drawn.direction;
  ray.t_max = drawn.distance;
  ray.flags = lamp.flags;
  if (context.cuts_cosines && point.end.frequency > 1.0f) {
    ray.contribution *= cosine_left(point.end.frequency, cosine);
  }
  if (bends) {
    lift(point.end, lifted_share(point.end.cutoff, cosine, geometric_cosine), drawn,
         point.geometric_normal, ray);
  }
  return ray;
}

}  // namespace komorebi
