#pragma once

#include "core/sampler.h"
#include "core/surface_point.h"
#include "core/terminator.h"
#include "render/context.h"

namespace komorebi {

/// One direction to ask for light, with what it brings to the pixel if nothing is in the way.
struct LightSample {
  Vec3 direction{0.0f};
  Vec3 contribution{0.0f};  ///< f · L · cos / pdf; null: no ray needs to be cast
};

/// Draws light ray `index` of a surface point: `index` counts over the pixel's camera samples and
/// their light rays together (sample · light_samples + j), so that all rays of a pixel are one
/// low-discrepancy set. Every surface is a white (or clay) Lambertian reflector.
LightSample sample_light(const RenderContext& context, const SurfacePoint& point,
                         const Sampler& sampler, std::uint32_t index);

/// The density, by solid angle, of sample_light drawing a direction for a surface of this normal,
/// `origin` being its leaving_origin.
float light_pdf(const RenderContext& context, const Vec3& normal, const Vec3& origin,
                const Vec3& direction);

/// The shadow terminator of a point at its ray's time, on the side that light comes from.
Terminator terminator(const RenderContext& context, const Hit& hit, float time,
                      const Vec3& geometric_normal);

/// Multiplies what a ray brings by what the terminator leaves of it, and returns how much of the
/// lift the ray starts at. Cosines to the shading normal (positive) and the geometric one.
float terminate(const RenderContext& context, const Terminator& terminator, float cosine,
                float geometric_cosine, Vec3& contribution);

/// The share of a map's light from a direction above the surface that Cycles finds by rays which it
/// samples by the surface, and which see what diffuse rays see; the rest it finds by rays to where
/// the map is bright, which see what shadow rays see. The power heuristic over the two densities
/// (Veach 1997, §9.2.4), whatever density the direction was drawn by here.
float surface_share(const RenderContext& context, const Vec3& normal, const Vec3& direction);

/// What arrives of a contribution, given whether a ray of light_mask gets through and one of
/// surface_mask.
inline float arriving_share(const RenderContext& context, const Vec3& normal, const Vec3& direction,
                            bool light_passes, bool surface_passes) {
  const float of_map = light_passes ? context.map_factor : 0.0f;
  const float of_surface = surface_passes ? context.surface_factor : 0.0f;
  if (of_map == of_surface) return of_map;
  const float share = surface_share(context, normal, direction);
  return (1.0f - share) * of_map + share * of_surface;
}

/// The shadow ray of a light sample.
Ray light_ray(const RenderContext& context, const SurfacePoint& point, const Hit& hit,
              const Vec3& direction, float time);

/// What Fast GI adds to a surface's light, of the sum over its rays by added_light_context.
inline Vec3 added_light(const RenderContext& context, float seen) {
  return context.albedo *
         (context.fast_gi.factor * seen / static_cast<float>(context.light_samples));
}

}  // namespace komorebi
