#include "render/bounce_tracer.h"

#include <algorithm>

#include "render/shade.h"

namespace komorebi {

BounceTracer::BounceTracer(const RenderContext& context)
    : context_(context),
      caster_(later_context(context, 1)),
      lamp_caster_(later_context(context, 1)),
      added_light_(later_context(context, 1), 1) {}

void BounceTracer::clear() {
  next_rays_.clear();
  next_states_.clear();
}

void BounceTracer::begin(const SurfaceBatch& surfaces, std::uint32_t surface, std::uint32_t path,
                         std::uint32_t pixel_seed, std::uint32_t sample) {
  leave(0, surfaces, surface, {path, pixel_seed, sample, surfaces.albedo(surface), Vec3(0.0f)});
}

void BounceTracer::leave(std::uint32_t vertex, const SurfaceBatch& surfaces, std::uint32_t surface,
                         State state) {
  ScatterPoint point;
  point.normal = surfaces.normal(surface);
  point.geometric_normal = surfaces.geometric_normal(surface);
  point.origin = surfaces.leaving_origin(surface);
  if (context_.has_terminators) point.frequency = surfaces.frequency(surface);
  point.time = surfaces.time(surface);
  point.instance = surfaces.instance(surface);
  point.primitive = surfaces.primitive(surface);
  const Sampler sampler(state.pixel_seed);
  Ray ray;
  if (!scatter(context_, vertex, point, sampler, state.sample, state.throughput, ray)) return;
  state.normal = point.normal;
  next_rays_.push(ray);
  next_states_.push_back(state);
}

/// The rays that left the last surfaces are those to be traced now.
void BounceTracer::take_next() {
  const RaySpan next = next_rays_.span();
  rays_.clear();
  states_.clear();
  for (const std::uint32_t i : order_.sort(next)) {
    rays_.push(next[i]);
    states_.push_back(next_states_[i]);
  }
  clear();
}

bool BounceTracer::find_surfaces(std::uint32_t vertex, const Cancel& cancel) {
  const RaySpan rays = rays_.span();
  hits_.resize(rays.count);
  intersect(context_.scene, rays, hits_.data());
  ray_count_ += rays.count;
  surfaces_.clear(rays.count);
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if (!hits_[i].valid()) continue;
    const State& state = states_[i];
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
    const State& state = states_[i];
    const Ray ray = rays[i];
    visit(state.path,
          scattered_sky(context_, state.throughput, state.normal, ray.origin, ray.direction));
  }
}

bool BounceTracer::trace(const Cancel& cancel, Visit visit) {
  for (std::uint32_t vertex = 1; !next_states_.empty(); ++vertex) {
    take_next();
    if (!find_surfaces(vertex, cancel)) return false;
    if (shares_light(context_, vertex - 1)) add_sky(visit);
    for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
      State state = states_[surfaces_.path(s)];
      const Shading shading = surfaces_.shading(s);
      Vec3 light = light_[s] / static_cast<float>(kLaterLightSamples);
      if (has_more_light(context_)) light += more_light_[s];
      visit(state.path, indirect_light(context_, vertex, state.throughput, shading, light));
      if (vertex == context_.bounces) continue;
      state.throughput *= shading.albedo;
      leave(vertex, surfaces_, s, state);
    }
  }
  return true;
}

}  // namespace komorebi
