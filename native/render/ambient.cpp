#include "render/ambient.h"

namespace komorebi {
namespace {

bool is_limited(const RenderContext& context) {
  return context.ao_distance < Ray{}.t_max;
}

}  // namespace

RenderContext ambient_context(const RenderContext& given, float distance, std::uint32_t vertex) {
  RenderContext context = given;
  context.method = Method::kAmbientOcclusion;
  context.sky = constant_environment(Vec3(1.0f));
  context.product = {};
  context.lamps = {};
  context.albedo = Vec3(1.0f);
  context.has_materials = false;
  context.bounces = 0;
  context.light_distance = distance;
  context.light_mask = kMaskShadow;
  context.surface_mask = 0;
  context.light_dimension = vertex_dimension(vertex, kVertexAmbient);
  context.lifts_rays = context.has_terminators;
  context.cuts_cosines = context.bends_round = false;
  return context;
}

AmbientPasses passes_of_light_rays(const RenderContext& context) {
  AmbientPasses passes;
  if (context.method != Method::kAmbientOcclusion) return passes;
  const bool whole_sky = !is_limited(context);
  passes.occlusion = context.passes.keeps(Quantity::kAmbientOcclusion);
  passes.sky_visibility = whole_sky && context.passes.keeps(Quantity::kSkyVisibility);
  passes.bent_normal = whole_sky && context.passes.keeps(Quantity::kBentNormal);
  return passes;
}

std::vector<AmbientCast> ambient_casts(const RenderContext& context) {
  const AmbientPasses done = passes_of_light_rays(context);
  AmbientPasses near, whole;
  near.occlusion = context.passes.keeps(Quantity::kAmbientOcclusion) && !done.occlusion;
  whole.sky_visibility = context.passes.keeps(Quantity::kSkyVisibility) && !done.sky_visibility;
  whole.bent_normal = context.passes.keeps(Quantity::kBentNormal) && !done.bent_normal;
  if (!is_limited(context)) {
    whole.occlusion = near.occlusion;
    near.occlusion = false;
  }
  std::vector<AmbientCast> casts;
  if (near.any()) casts.push_back({ambient_context(context, context.ao_distance), near});
  if (whole.any()) casts.push_back({ambient_context(context, Ray{}.t_max), whole});
  return casts;
}

void add_ambient(const PassLayout& layout, const AmbientPasses& passes, const Vec3& direction,
                 float contribution, float* row) {
  const auto at = [&](Quantity q) { return row + layout.place[static_cast<std::size_t>(q)]; };
  if (passes.occlusion) *at(Quantity::kAmbientOcclusion) += contribution;
  if (passes.sky_visibility) *at(Quantity::kSkyVisibility) += contribution;
  if (!passes.bent_normal) return;
  float* bent = at(Quantity::kBentNormal);
  bent[0] += contribution * direction.x;
  bent[1] += contribution * direction.y;
  bent[2] += contribution * direction.z;
}

void finish_ambient(const RenderContext& context, float* row) {
  const PassLayout& layout = context.passes;
  const auto rays = static_cast<float>(context.light_samples);
  for (const Quantity q :
       {Quantity::kAmbientOcclusion, Quantity::kSkyVisibility, Quantity::kBentNormal}) {
    if (!layout.keeps(q)) continue;
    float* to = row + layout.place[static_cast<std::size_t>(q)];
    for (std::uint32_t c = 0; c < layout.channels_of(q); ++c) to[c] /= rays;
  }
}

}  // namespace komorebi
