#pragma once

#include <vector>

#include "render/context.h"
#include "render/material_shader.h"
#include "render/surface_batch.h"

namespace komorebi {

/// Albedo for which the light rays of a path's vertex (0: what the camera sees) are drawn: that of
/// all its surfaces. Where surfaces have materials, or after a bounce, it is 1, and what the rays
/// bring is multiplied by the albedo of each afterwards.
inline Vec3 lit_albedo(const RenderContext& context, std::uint32_t vertex) {
  const bool alike = vertex == 0 && !context.has_materials;
  return alike && context.method == Method::kWorldLight ? context.clay_albedo : Vec3(1.0f);
}

/// The shading of every hit of a vertex where there are no materials. What is seen under ambient
/// occlusion is white: it shows how open a surface is, and bounces how bright its surroundings
/// would be.
inline Shading clay_shading(const RenderContext& context, std::uint32_t vertex) {
  const bool white = vertex == 0 && context.method == Method::kAmbientOcclusion;
  const Vec3 albedo = white ? Vec3(1.0f) : context.clay_albedo;
  return {albedo, Vec3(0.0f), albedo, 0.0f};
}

/// A hit as its material is asked about it.
ShadeTask shade_task(const RenderContext& context, const Hit& hit, const SurfacePoint& point,
                     const Vec3& direction, float time, std::uint32_t pixel_seed,
                     std::uint32_t sample, std::uint32_t vertex);

/// The shading of one hit; `point` becomes that of the lobe that its path takes.
Shading shade_surface(const RenderContext& context, MaterialShader& shader, const Hit& hit,
                      const Ray& ray, std::uint32_t pixel_seed, std::uint32_t sample,
                      std::uint32_t vertex, SurfacePoint& point);

/// The same for all surfaces of a batch. Its arrays grow once.
class BatchShader {
 public:
  /// @param light_samples  of each path at this vertex
  void shade(const RenderContext& context, std::uint32_t vertex, const Hit* hits,
             const RaySpan& rays, std::uint32_t light_samples, SurfaceBatch& surfaces);

 private:
  MaterialShader shader_;
  std::vector<std::uint64_t> order_;  // material, then surface
  std::vector<ShadeTask> tasks_;
  std::vector<Shading> shadings_;
};

/// `light`, scaled so that the sum of its channels stays within a limit (Cycles' Clamp).
inline Vec3 clamp_light(const Vec3& light, float limit) {
  const Vec3 a = glm::abs(light);
  const float sum = a.x + a.y + a.z;
  return sum > limit ? light * (limit / sum) : light;
}

/// What the vertex in view brings to the pixel, of the mean `light` of its light rays.
inline Vec3 direct_light(const RenderContext& context, const Shading& shading, const Vec3& light) {
  const Vec3 reflected = context.has_materials ? shading.albedo * light : light;
  return clamp_light(reflected, context.clamp_direct) +
         clamp_light(shading.emission, context.clamp_direct);
}

/// What a later vertex does, by the path's throughput up to it. As in Cycles what shines counts as
/// one bounce less than what it lights.
inline Vec3 indirect_light(const RenderContext& context, std::uint32_t vertex,
                           const Vec3& throughput, const Shading& shading, const Vec3& light) {
  const Vec3 reflected = clamp_light(throughput * shading.albedo * light, context.clamp_indirect);
  if (!context.indirect_emission) return reflected;
  return reflected + clamp_light(throughput * shading.emission,
                                 vertex == 1 ? context.clamp_direct : context.clamp_indirect);
}

}  // namespace komorebi
