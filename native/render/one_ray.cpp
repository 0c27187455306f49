#include "render/one_ray.h"

#include "bvh/traverse.h"
#include "render/light.h"

namespace komorebi {

Ray start_ray(const RenderContext& context, std::uint32_t x, std::uint32_t y,
              std::uint32_t sample) {
  const Sampler sampler(context.seed, x, y);
  const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const Vec2 film =
      centre + sample_filter(context.filter, sampler.sample_2d(kDimensionPixel, sample));
  Ray ray = camera_ray(context.camera, film, sampler.sample_2d(kDimensionLens, sample),
                       sampler.sample_1d(kDimensionTime, sample));
  ray.mask = kMaskCamera;
  return ray;
}

PixelSample background(const RenderContext& context, const Vec3& direction) {
  PixelSample result;
  if (context.transparent) return result;
  result.radiance = environment_radiance(context.environment, direction);
  result.alpha = 1.0f;
  return result;
}

PixelSample seen_surface(const Vec3& normal, float depth) {
  PixelSample result;
  result.alpha = 1.0f;
  result.depth = depth;
  result.normal = normal;
  return result;
}

PixelSample render_sample(const RenderContext& context, std::uint32_t x, std::uint32_t y,
                          std::uint32_t sample) {
  const Ray ray = start_ray(context, x, y, sample);
  const Hit hit = intersect_scalar(context.scene, ray);
  if (!hit.valid()) return background(context, ray.direction);

  const SurfacePoint point = surface_point(context.scene, hit, ray);
  const Sampler sampler(context.seed, x, y);
  PixelSample result = seen_surface(point.normal, camera_depth(context.camera, point.position));
  for (std::uint32_t j = 0; j < context.light_samples; ++j) {
    const LightSample light =
        sample_light(context, point, sampler, sample * context.light_samples + j);
    if (light.contribution == Vec3(0.0f)) continue;
    if (occluded_scalar(context.scene, light_ray(context, point, hit, light.direction, ray.time))) {
      continue;
    }
    result.radiance += light.contribution;
  }
  result.radiance /= static_cast<float>(context.light_samples);
  return result;
}

}  // namespace komorebi
