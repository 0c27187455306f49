#include "render/light.h"

#include "core/aabb.h"
#include "core/warp.h"

namespace komorebi {
namespace {

/// A radiance of f · L · cos / pdf for a Lambertian surface of the context's albedo, or null when
/// the direction lies below the shading or the geometric surface, where Cycles has no light either.
Vec3 lambertian(const RenderContext& context, const SurfacePoint& point, const Vec3& direction,
                float cosine, float pdf, const Vec3& radiance) {
  if (!(cosine > 0.0f && pdf > 0.0f)) return Vec3(0.0f);
  if (!(glm::dot(direction, point.geometric_normal) > 0.0f)) return Vec3(0.0f);
  return context.albedo * radiance * (kInvPi * cosine / pdf);
}

LightSample sample_ambient(const RenderContext& context, const SurfacePoint& point, const Vec2& u) {
  const bool cosine_weighted = context.ao_sampling == AoSampling::kCosine;
  const Vec3 local = cosine_weighted ? cosine_hemisphere_disk(u) : uniform_hemisphere(u);
  LightSample sample;
  sample.direction = make_frame(point.normal).to_world(local);
  // The cosine and its density cancel; left in, their rounding would show as noise around 1.
  const Vec3 weight = Vec3(cosine_weighted ? 1.0f : 2.0f * local.z);
  const bool above = glm::dot(sample.direction, point.geometric_normal) > 0.0f;
  sample.contribution = above ? weight : Vec3(0.0f);
  return sample;
}

/// Stretches the part [first, first + count) of the 2³² values of a coordinate to all of them.
std::uint32_t stretched(std::uint32_t bits, std::uint64_t first, std::uint64_t count) {
  return static_cast<std::uint32_t>(((bits - first) << 32) / count);
}

/// One-sample multiple importance sampling with the balance heuristic (Veach 1997, §9.2.4): the
/// strategy is chosen by the first coordinate, which is then stretched to its full range again, so
/// that both strategies see well-stratified points.
LightSample sample_sky(const RenderContext& context, const SurfacePoint& point, Bits2 bits) {
  constexpr std::uint64_t kAll = std::uint64_t{1} << 32;
  const float share = context.cosine_share;
  const auto split = static_cast<std::uint64_t>(share * 4294967296.0f);
  LightSample sample;
  EnvironmentValue sky;
  if (bits.x < split) {
    bits.x = stretched(bits.x, 0, split);
    const Vec2 u(to_unit_float(bits.x), to_unit_float(bits.y));
    sample.direction = make_frame(point.normal).to_world(cosine_hemisphere_disk(u));
    sky = evaluate_environment(context.sky, sample.direction);
  } else {
    bits.x = stretched(bits.x, split, kAll - split);
    const EnvironmentSample drawn = sample_environment(context.sky, bits);
    sample.direction = drawn.direction;
    sky = {drawn.radiance, drawn.pdf};
  }
  const float cosine = glm::dot(sample.direction, point.normal);
  const float pdf = share * (max_of(cosine, 0.0f) * kInvPi) + (1.0f - share) * sky.pdf;
  sample.contribution = lambertian(context, point, sample.direction, cosine, pdf, sky.radiance);
  return sample;
}

LightSample sample_sky_product(const RenderContext& context, const SurfacePoint& point,
                               const Bits2& bits) {
  const EnvironmentSample drawn =
      sample_product(context.sky, context.product, point.normal, leaving_origin(point), bits);
  LightSample sample;
  sample.direction = drawn.direction;
  const float cosine = glm::dot(drawn.direction, point.normal);
  sample.contribution =
      lambertian(context, point, drawn.direction, cosine, drawn.pdf, drawn.radiance);
  return sample;
}

}  // namespace

LightSample sample_light(const RenderContext& context, const SurfacePoint& point,
                         const Sampler& sampler, std::uint32_t index) {
  const Bits2 bits = sampler.bits_2d(context.light_dimension, index);
  if (context.product.bins > 0) return sample_sky_product(context, point, bits);
  if (context.method == Method::kWorldLight) return sample_sky(context, point, bits);
  return sample_ambient(context, point, Vec2(to_unit_float(bits.x), to_unit_float(bits.y)));
}

float light_pdf(const RenderContext& context, const Vec3& normal, const Vec3& origin,
                const Vec3& direction) {
  if (context.product.bins > 0) {
    return product_pdf(context.sky, context.product, normal, origin, direction);
  }
  const float of_cosine = max_of(glm::dot(direction, normal), 0.0f) * kInvPi;
  if (context.method == Method::kWorldLight) {
    const float share = context.cosine_share;
    return share * of_cosine + (1.0f - share) * environment_pdf(context.sky, direction);
  }
  return context.ao_sampling == AoSampling::kCosine ? of_cosine : kInvTwoPi;
}

Terminator terminator(const RenderContext& context, const Hit& hit, float time,
                      const Vec3& geometric_normal) {
  Terminator result;
  if (!context.has_terminators) return result;
  const InstanceView& instance = context.scene.instances[hit.instance];
  const ObjectInfo object = context.tables->object(instance.object_index);
  if (object.terminator_cutoff > 0.0f) {
    result.lift = smooth_lift(context.scene, hit, time, geometric_normal);
    if (result.lift != Vec3(0.0f)) result.cutoff = object.terminator_cutoff;
  }
  result.frequency = object.terminator_frequency;
  return result;
}

float terminate(const RenderContext& context, const Terminator& t, float cosine,
                float geometric_cosine, Vec3& contribution) {
  if (context.cuts_cosines && t.frequency > 1.0f) contribution *= cosine_left(t.frequency, cosine);
  return context.lifts_rays && t.cutoff > 0.0f ? lifted_share(t.cutoff, cosine, geometric_cosine)
                                               : 0.0f;
}

float surface_share(const RenderContext& context, const Vec3& normal, const Vec3& direction) {
  const Vec3 sky = environment_radiance(context.sky, direction);
  const float of_surface = max_of(glm::dot(direction, normal), 0.0f) * kInvPi;
  const float of_map = (sky.x + sky.y + sky.z) / (3.0f * context.sky_flux);
  const float a = of_surface * of_surface, b = of_map * of_map;
  return a + b > 0.0f ? a / (a + b) : 0.0f;
}

Ray light_ray(const RenderContext& context, const SurfacePoint& point, const Hit& hit,
              const Vec3& direction, float time) {
  Ray ray;
  ray.origin = leaving_origin(point);
  ray.direction = direction;
  ray.t_max = context.light_distance;
  ray.time = time;
  ray.mask = context.light_mask;
  ray.self_instance = hit.instance;
  ray.self_primitive = hit.primitive;
  return ray;
}

}  // namespace komorebi
