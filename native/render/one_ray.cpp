#include "render/one_ray.h"

#include "bvh/traverse.h"
#include "core/path_key.h"
#include "render/ambient.h"
#include "render/light.h"
#include "render/material_values.h"
#include "render/one_lamp_ray.h"
#include "render/pass_row.h"
#include "render/scatter.h"
#include "render/shade.h"
#include "render/world_program.h"

namespace komorebi {

Ray start_ray(const RenderContext& context, std::uint32_t x, std::uint32_t y,
              std::uint32_t sample) {
  const Sampler sampler(context.seed, x, y);
  const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const Vec2 film =
      centre + sample_filter(context.filter, sampler.sample_2d(kDimensionPixel, sample));
  const float time =
      shutter_time(context.camera.shutter, sampler.sample_1d(kDimensionTime, sample), y);
  Ray ray = camera_ray(context.camera, film, sampler.sample_2d(kDimensionLens, sample), time);
  ray.mask = kMaskCamera;
  ray.path_key = path_key(sampler.pixel_seed, kDimensionPixel, sample);
  return ray;
}

PixelSample background(const RenderContext& context, const Vec3& direction) {
  PixelSample result;
  if (context.transparent) return result;
  result.radiance = clamp_light(world_radiance(context, direction), context.clamp_direct);
  result.alpha = 1.0f;
  return result;
}

PixelSample missed(const RenderContext& context, const Vec3& direction, float t_max, float* row) {
  PixelSample result;
  if (has_ray(t_max)) {
    result = background(context, direction);
    put_environment(context, direction, row);
    put_world_values(context, direction, row);
  } else {
    result.alpha = 1.0f;
  }
  put_matte(context.passes, result, row);
  return result;
}

namespace {

/// Calls visit(drawn, visible) for the rays that could bring light to a point; of one that only
/// some of Cycles' rays would see the share is left that these find.
template <class Visit>
void for_each_light_ray(const RenderContext& context, const SurfacePoint& point, const Hit& hit,
                        const Sampler& sampler, std::uint32_t sample, float time,
                        const Visit& visit) {
  const Terminator end = terminator(context, hit, time, point.geometric_normal);
  SurfacePoint lit = point;
  if (context.bends_round && end.cutoff > 0.0f) lit.geometric_normal = point.normal;
  for (std::uint32_t j = 0; j < context.light_samples; ++j) {
    const std::uint32_t index = sample * context.light_samples + j;
    LightSample drawn = sample_light(context, lit, sampler, index);
    if (drawn.contribution == Vec3(0.0f)) continue;
    const float geometric_cosine = glm::dot(drawn.direction, point.geometric_normal);
    const float share = terminate(context, end, glm::dot(drawn.direction, point.normal),
                                  geometric_cosine, drawn.contribution);
    Ray ray = light_ray(context, point, hit, drawn.direction, time);
    ray.path_key = path_key(sampler.pixel_seed, context.light_dimension, index);
    if (share > 0.0f) {
      ray.origin += share * end.lift;
      // What lies below its own triangle has to pass over its edge.
      if (!(geometric_cosine > 0.0f)) ray.self_instance = ray.self_primitive = kNone;
    }
    bool visible = !occluded_scalar(context.scene, ray);
    if (context.surface_mask != 0) {
      ray.mask = context.surface_mask;
      ray.t_max = context.surface_distance;
      const float arriving = arriving_share(context, point.normal, drawn.direction, visible,
                                            !occluded_scalar(context.scene, ray));
      drawn.contribution *= arriving;
      visible = arriving > 0.0f;
    }
    visit(drawn, visible);
  }
}

/// The mean over a point's light rays; their part where scattered rays bring some of it.
Vec3 mean_light(const RenderContext& context, const SurfacePoint& point, const Hit& hit,
                const Sampler& sampler, std::uint32_t sample, float time, bool shares = false) {
  Vec3 light(0.0f);
  for_each_light_ray(
      context, point, hit, sampler, sample, time, [&](const LightSample& drawn, bool visible) {
        if (!visible) return;
        if (!shares) {
          light += drawn.contribution;
          return;
        }
        light += drawn.contribution * light_ray_share(context, point.normal, point.geometric_normal,
                                                      leaving_origin(point), drawn.direction);
      });
  return light / static_cast<float>(context.light_samples);
}

/// What lamps bring to a point, and what Fast GI adds.
Vec3 more_light(const RenderContext& context, const SurfacePoint& point, const Hit& hit,
                const Sampler& sampler, std::uint32_t vertex, std::uint32_t sample, float time) {
  Vec3 light = lamp_light(context, point, hit, sampler, vertex, sample, time);
  if (!context.fast_gi.adds) return light;
  float seen = 0.0f;
  for_each_light_ray(added_light_context(context, vertex), point, hit, sampler, sample, time,
                     [&](const LightSample& drawn, bool visible) {
                       if (visible) seen += drawn.contribution.x;
                     });
  return light + added_light(context, seen);
}

/// Adds what comes to the surface in view from others, vertex by vertex.
void add_bounces(const RenderContext& context, MaterialShader& shader, SurfacePoint point, Hit hit,
                 Vec3 throughput, const Sampler& sampler, std::uint32_t sample, float time,
                 Vec3& radiance) {
  for (std::uint32_t vertex = 0; vertex < context.bounces; ++vertex) {
    const Terminator end = terminator(context, hit, time, point.geometric_normal);
    const ScatterPoint from{
        point.normal, point.geometric_normal, leaving_origin(point), end.frequency,
        time,         hit.instance,           hit.primitive};
    Ray ray;
    if (!scatter(context, vertex, from, sampler, sample, throughput, ray)) return;
    hit = intersect_scalar(context.scene, ray);
    if (!hit.valid()) {
      if (!shares_light(context, vertex)) return;
      radiance += scattered_sky(context, throughput, from.normal, from.origin, ray.direction);
      return;
    }
    point = surface_point(context.scene, hit, ray);
    const Shading shading =
        shade_surface(context, shader, hit, ray, sampler.pixel_seed, sample, vertex + 1, point);
    const RenderContext later = later_context(context, vertex + 1);
    Vec3 light =
        mean_light(later, point, hit, sampler, sample, time, shares_light(context, vertex + 1));
    if (has_more_light(later)) {
      light += more_light(later, point, hit, sampler, vertex + 1, sample, time);
    }
    radiance += indirect_light(context, vertex + 1, throughput, shading, light);
    throughput *= shading.albedo;
  }
}

/// The light that a shadow catcher would get if there were nothing but shadow catchers.
Vec3 light_alone(const RenderContext& given, MaterialShader& shader, const SurfacePoint& point,
                 const Hit& hit, const Shading& shading, const Sampler& sampler,
                 std::uint32_t sample, float time) {
  const RenderContext context = alone_context(given);
  Vec3 light = mean_light(context, point, hit, sampler, sample, time);
  if (has_more_light(context)) light += more_light(context, point, hit, sampler, 0, sample, time);
  Vec3 radiance = direct_light(context, shading, light);
  add_bounces(context, shader, point, hit, shading.albedo, sampler, sample, time, radiance);
  return radiance;
}

}  // namespace

PixelSample render_sample(const RenderContext& context, std::uint32_t x, std::uint32_t y,
                          std::uint32_t sample, float* row) {
  const PassLayout& layout = context.passes;
  clear_row(layout, row);
  const Ray ray = start_ray(context, x, y, sample);
  const Hit hit = intersect_scalar(context.scene, ray);
  if (!hit.valid()) return missed(context, ray.direction, ray.t_max, row);
  if (is_holdout(context, hit)) {
    const PixelSample hole;
    put_values(context, hit, row);
    MaterialValues().put_one(context, hit, ray, row);
    put_matte(layout, hole, row);
    return hole;
  }
  SurfacePoint point = surface_point(context.scene, hit, ray);
  const Sampler sampler(context.seed, x, y);
  MaterialShader shader;
  const Shading shading =
      shade_surface(context, shader, hit, ray, sampler.pixel_seed, sample, 0, point);
  put_surface(context, hit, ray, point.normal, camera_depth(context.camera, point.position),
              shading, sample, row);
  MaterialValues().put_one(context, hit, ray, row);
  PixelSample result;
  result.alpha = 1.0f - shading.holdout;
  const AmbientPasses of_light = passes_of_light_rays(context);
  for_each_light_ray(context, point, hit, sampler, sample, ray.time,
                     [&](const LightSample& drawn, bool visible) {
                       if (!visible) return;
                       result.radiance += drawn.contribution;
                       add_ambient(layout, of_light, drawn.direction, drawn.contribution.x, row);
                     });
  Vec3 light = result.radiance / static_cast<float>(context.light_samples);
  if (has_more_light(context)) {
    light += more_light(context, point, hit, sampler, 0, sample, ray.time);
  }
  result.radiance = direct_light(context, shading, light);
  add_bounces(context, shader, point, hit, shading.albedo, sampler, sample, ray.time,
              result.radiance);
  for (const AmbientCast& cast : ambient_casts(context)) {
    for_each_light_ray(cast.context, point, hit, sampler, sample, ray.time,
                       [&](const LightSample& drawn, bool visible) {
                         if (!visible) return;
                         add_ambient(layout, cast.passes, drawn.direction, drawn.contribution.x,
                                     row);
                       });
  }
  if (layout.keeps_ambient()) finish_ambient(context, row);
  if (!is_catcher(context, hit.instance)) {
    put_matte(layout, result, row);
  } else {
    put_environment(context, ray.direction, row);
    layout.put(row, Quantity::kCatcherLight,
               light_alone(context, shader, point, hit, shading, sampler, sample, ray.time));
  }
  return result;
}

}  // namespace komorebi
