#include "render/scatter.h"

#include <cmath>

#include "core/path_key.h"
#include "core/terminator.h"
#include "core/warp.h"
#include "render/light.h"
#include "render/shade.h"

namespace komorebi {
namespace {

float scattered_share(const RenderContext& context, const Vec3& normal, const Vec3& origin,
                      const Vec3& direction) {
  const float scattered = max_of(glm::dot(direction, normal), 0.0f) * kInvPi;
  const float both = scattered + light_pdf(context, normal, origin, direction);
  return both > 0.0f ? scattered / both : 0.0f;
}

}  // namespace

bool scatter(const RenderContext& context, std::uint32_t vertex, const ScatterPoint& point,
             const Sampler& sampler, std::uint32_t sample, Vec3& throughput, Ray& ray) {
  const float most = glm::max(glm::max(throughput.x, throughput.y), throughput.z);
  if (!(most > 0.0f)) return false;
  if (vertex >= kSureScatters) {
    // The root: paths live longer than their share of the light, as in Cycles.
    const float survival = glm::min(std::sqrt(most), 1.0f);
    const float u = sampler.sample_1d(vertex_dimension(vertex, kVertexRoulette), sample);
    if (!(u < survival)) return false;
    throughput /= survival;
  }
  const Vec2 u = sampler.sample_2d(vertex_dimension(vertex, kVertexScatter), sample);
  ray.direction = make_frame(point.normal).to_world(cosine_hemisphere_disk(u));
  if (!(glm::dot(ray.direction, point.geometric_normal) > 0.0f)) return false;
  if (context.cuts_cosines && point.frequency > 1.0f &&
      !cut_scattered(point.frequency, point.normal, ray.direction, throughput)) {
    return false;
  }
  ray.origin = point.origin;
  ray.t_min = 0.0f;
  ray.t_max = context.light_distance;  // beyond, there is nothing but sky
  ray.time = point.time;
  ray.mask = context.scatter_mask;
  ray.self_instance = point.instance;
  ray.self_primitive = point.primitive;
  ray.path_key = path_key(sampler.pixel_seed, vertex_dimension(vertex, kVertexScatter), sample);
  return true;
}

bool cut_scattered(float frequency, const Vec3& normal, const Vec3& direction, Vec3& throughput) {
  const float cosine = glm::dot(direction, normal);
  if (!(cosine > 0.0f)) return false;
  throughput *= cosine_left(frequency, cosine);
  return true;
}

float light_ray_share(const RenderContext& context, const Vec3& normal,
                      const Vec3& geometric_normal, const Vec3& origin, const Vec3& direction) {
  // A lifted ray may go where none is scattered to.
  if (!(glm::dot(direction, geometric_normal) > 0.0f)) return 1.0f;
  return 1.0f - scattered_share(context, normal, origin, direction);
}

Vec3 scattered_sky(const RenderContext& context, const Vec3& throughput, const Vec3& normal,
                   const Vec3& origin, const Vec3& direction) {
  const float share = scattered_share(context, normal, origin, direction);
  const Vec3 sky = environment_radiance(context.sky, direction);
  return clamp_light(throughput * (share * sky), context.clamp_indirect);
}

RenderContext later_context(const RenderContext& given, std::uint32_t vertex) {
  RenderContext context = given;
  context.albedo = lit_albedo(given, vertex);
  context.light_samples = kLaterLightSamples;
  context.lamp_samples = kLaterLampSamples;
  context.light_dimension = vertex_dimension(vertex, kVertexLightDirection);
  if (vertex == given.fast_gi.last_vertex) end_in_ambient(context);
  if (vertex > given.world_max_bounces && context.sky.width > 0) {
    context.surface_mask = context.scatter_mask;
    context.map_factor = 0.0f;
  }
  return context;
}

RenderContext alone_context(const RenderContext& given) {
  RenderContext context = given;
  context.light_mask <<= kMaskCatcherShift;
  context.surface_mask <<= kMaskCatcherShift;
  context.scatter_mask <<= kMaskCatcherShift;
  context.lamp_mask <<= kMaskCatcherShift;
  context.fast_gi.adds = false;  // as in Cycles
  return context;
}

}  // namespace komorebi
