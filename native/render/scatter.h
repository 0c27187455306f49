#pragma once

#include "core/sampler.h"
#include "render/context.h"

namespace komorebi {

/// Light rays of a vertex after a bounce. In sponza, by four bounces under a map, two take a
/// quarter off the variance and cost as much (28 % more time).
inline constexpr std::uint32_t kLaterLightSamples = 1;

/// Rays to lamps of such a vertex. Variance times time by two bounces, beside one ray: 0.81 by two
/// and 0.85 by four in lamp_nodes, 0.92 and 0.90 in lamps.
inline constexpr std::uint32_t kLaterLampSamples = 2;

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
/// Light rays find all of the sky, with a density above 0 wherever light comes from; rays that miss
/// share it with them where that pays (shares_light). There are no light sources that only
/// scattered rays find, hence no caustics either.
bool scatter(const RenderContext& context, std::uint32_t vertex, const ScatterPoint& point,
             const Sampler& sampler, std::uint32_t sample, Vec3& throughput, Ray& ray);

/// Cuts the last part of the cosine off a scattered path's throughput (core/terminator.h); false
/// where nothing is left.
bool cut_scattered(float frequency, const Vec3& normal, const Vec3& direction, Vec3& throughput);

/// Whether the sky's light at a vertex is brought by both its light rays and the scattered ray that
/// leaves it: at those from which paths go on, but the first. There light rays have little noise
/// (in sponza under a map 1 % of the variance of four bounces), and passes are made of them. Nor at
/// those where Fast GI or the world's Max Bounces tell apart who has found it.
inline bool shares_light(const RenderContext& context, std::uint32_t vertex) {
  return context.shares_light && vertex > 0 && vertex < context.bounces &&
         vertex < context.fast_gi.last_vertex &&
         (vertex <= context.world_max_bounces || context.sky.width == 0);
}

/// The share that the light ray of such a vertex brings of the light from a direction above its
/// surface, by the balance heuristic over the densities of both rays (Veach 1997, §9.2.4).
float light_ray_share(const RenderContext& context, const Vec3& normal,
                      const Vec3& geometric_normal, const Vec3& origin, const Vec3& direction);

/// What the ray that left such a vertex, by `normal` from `origin`, brings where it meets nothing,
/// given the path's throughput from there on. It is light of that vertex, which clamps it apart
/// from what light rays bring, as in Cycles.
Vec3 scattered_sky(const RenderContext& context, const Vec3& throughput, const Vec3& normal,
                   const Vec3& origin, const Vec3& direction);

/// By which the light rays of a later vertex are drawn.
RenderContext later_context(const RenderContext& context, std::uint32_t vertex);

/// Among shadow catchers alone.
RenderContext alone_context(const RenderContext& context);

}  // namespace komorebi
