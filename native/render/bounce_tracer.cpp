#include "render/bounce_tracer.h"

#include <algorithm>

#include "render/shade.h"

namespace komorebi {

BounceTracer::BounceTracer(const RenderContext& context)
    : context_(context),
      caster_(later_context(context, 1)),
      lamp_caster_(later_context(context, 1)),
      added_light_(later_context(context, 1), 1) {}

bool BounceTracer::find_surfaces(std::uint32_t vertex, const Cancel& cancel) {
  const RaySpan rays = rays_.span();
  hits_.resize(rays.count);
  intersect(context_.scene, rays, hits_.data());
  ray_count_ += rays.count;
  surfaces_.clear(rays.count);
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if (!hits_[i].valid()) continue;
    const PathState& state = states_[i];
    surfaces_.push(i, hits_[i], rays.time[i], state.pixel_seed, state.sample * kLaterLightSamples);
  }
  surfaces_.fill(context_, hits_.data(), rays);
  shader_.shade(context_, vertex, hits_.data(), rays, kLaterLightSamples, surfaces_);
  light_.assign(surfaces_.size(), Vec3(0.0f));
  const RenderContext context = later_context(context_, vertex);
  caster_.set_context(context);
  const bool shares = shares_light(context_, vertex);
  const std::uint32_t size = caster_.block_size();
  for (std::uint32_t begin = 0; begin < surfaces_.size(); begin += size) {
    if (cancel.raised()) return false;
    caster_.cast(surfaces_, begin, std::min(surfaces_.size(), begin + size),
                 [&](std::uint32_t s, const Vec3& to, const Vec3& contribution, bool visible) {
                   if (!visible) return;
                   light_[s] += shares ? contribution * light_share(s, to) : contribution;
                 });
  }
  return find_more_light(context, vertex, cancel);
}

bool BounceTracer::find_more_light(const RenderContext& context, std::uint32_t vertex,
                                   const Cancel& cancel) {
  if (!has_more_light(context)) return true;
  more_light_.assign(surfaces_.size(), Vec3(0.0f));
  const bool lamps = context.lamps.count > 0;
  const std::uint32_t size = lamp_caster_.block_size();
  for (std::uint32_t begin = 0; lamps && begin < surfaces_.size(); begin += size) {
    if (cancel.raised()) return false;
    lamp_caster_.cast(surfaces_, begin, std::min(surfaces_.size(), begin + size), vertex,
                      more_light_.data());
  }
  return !context.fast_gi.adds ||
         added_light_.add(context, vertex, surfaces_, cancel, more_light_.data());
}

float BounceTracer::light_share(std::uint32_t surface, const Vec3& direction) const {
  return light_ray_share(context_, surfaces_.normal(surface), surfaces_.geometric_normal(surface),
                         surfaces_.leaving_origin(surface), direction);
}

/// Of the rays that have met nothing.
void BounceTracer::add_sky(const Visit& visit) const {
  const RaySpan rays = rays_.span();
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if (hits_[i].valid()) continue;
    const PathState& state = states_[i];
    const Ray ray = rays[i];
    visit(state.path,
          scattered_sky(context_, state.throughput, state.normal, ray.origin, ray.direction));
  }
}

bool BounceTracer::trace(const SurfaceBatch& in_view, const Cancel& cancel, Visit visit) {
  leaving_.scatter(context_, 0, in_view, rays_, states_);
  for (std::uint32_t vertex = 1; rays_.size() > 0; ++vertex) {
    if (!find_surfaces(vertex, cancel)) return false;
    if (shares_light(context_, vertex - 1)) add_sky(visit);
    leaving_.clear(surfaces_.size());
    for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
      const PathState& state = states_[surfaces_.path(s)];
      const Shading shading = surfaces_.shading(s);
      Vec3 light = light_[s] / static_cast<float>(kLaterLightSamples);
      if (has_more_light(context_)) light += more_light_[s];
      visit(state.path, indirect_light(context_, vertex, state.throughput, shading, light));
      leaving_.set(s, state.path, state.sample, state.throughput * shading.albedo);
    }
    if (vertex == context_.bounces) break;
    leaving_.scatter(context_, vertex, surfaces_, rays_, states_);
  }
  return true;
}

}  // namespace komorebi
