#pragma once

#include "core/sampler.h"
#include "render/context.h"

namespace komorebi {

/// Light rays of a vertex after a bounce. In sponza, by four bounces under a map, two take a
/// quarter off the variance and cost as much (28 % more time).
inline constexpr std::uint32_t kLaterLightSamples = 1;

/// So many surfaces scatter every path; from then on a path ends by Russian roulette. Where one
/// did, it was 10 % sooner through and had 11 % more variance (sponza).
inline constexpr std::uint32_t kSureScatters = 2;

/// A place that a path leaves.
struct ScatterPoint {
  Vec3 normal, geometric_normal;  ///< on the side that the path goes on from
  Vec3 origin;                    ///< leaving_origin
  float frequency = 1.0f;         ///< Terminator::frequency
  float time = 0.0f;
  std::uint32_t instance = kNone, primitive = kNone;
};

/// The ray by which a path goes on from its vertex `vertex`, in proportion to the cosine, and the
/// path's throughput from there on; false where it ends. `throughput` includes the vertex's albedo.
///
/// Rays that miss bring nothing: light rays find all of the sky, with a density above 0 wherever
/// light comes from. To let both bring it, weighted by their densities, would take away noise (a
/// second light ray takes a quarter), but needs the product's density in a given direction, which
/// nothing evaluates yet. There are no light sources that only scattered rays find, hence no
/// caustics either.
bool scatter(const RenderContext& context, std::uint32_t vertex, const ScatterPoint& point,
             const Sampler& sampler, std::uint32_t sample, Vec3& throughput, Ray& ray);

/// By which the light rays of a later vertex are drawn.
RenderContext later_context(const RenderContext& context, std::uint32_t vertex);

/// Among shadow catchers alone.
RenderContext alone_context(const RenderContext& context);

}  // namespace komorebi
