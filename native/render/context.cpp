#include "render/context.h"

#include <algorithm>
#include <stdexcept>

#include "render/shade.h"

namespace komorebi {
namespace {

/// A uniform sky has no direction worth choosing, so multiple importance sampling keeps to the
/// cosine there; asked for alone, the environment's own (uniform) density is used as asked.
float cosine_share(EnvironmentSampling sampling, bool uniform_world) {
  switch (sampling) {
    case EnvironmentSampling::kCosine:
      return 1.0f;
    case EnvironmentSampling::kEnvironment:
      return 0.0f;
    case EnvironmentSampling::kMis:
    case EnvironmentSampling::kProduct:
      return uniform_world ? 1.0f : 0.5f;
  }
  return 1.0f;
}

/// Ambient occlusion asks who casts shadows. So does light from a map, if not alone (surface_mask),
/// but an even sky is sampled by Cycles through the surface alone, and there it is the visibility
/// to diffuse rays that counts.
std::uint32_t light_mask(const Scene& scene, Method method) {
  return method == Method::kWorldLight && scene.world_is_uniform() ? kMaskDiffuse : kMaskShadow;
}

float clamp_limit(float setting) {
  return setting > 0.0f ? 3.0f * setting : Ray{}.t_max;
}

/// Surfaces that are all of one matt colour need no materials: that colour takes the place of clay.
/// Nor does ambient occlusion, to which all matt surfaces are alike.
void take_materials(const SceneTables& tables, bool ao, RenderContext& context) {
  if (tables.surfaces.empty()) return;
  bool all_plain = true, alike = true;
  Vec3 first(0.0f), albedo(0.0f);
  bool any = false;
  for (const std::uint32_t index : tables.slots) {
    if (!is_plain(tables.surface(index), &albedo)) {
      all_plain = false;
      break;
    }
    alike = alike && (!any || albedo == first);
    if (!any) first = albedo;
    any = true;
  }
  if (all_plain && alike && any) {
    context.clay_albedo = first;
  } else {
    context.has_materials = !all_plain || !ao || context.bounces > 0;
  }
}

}  // namespace

float max_radiance(const Scene& scene, const Settings& settings) {
  const bool lamps = settings.method == Method::kWorldLight;
  return scene.max_radiance() + (lamps ? scene.max_lamp_radiance() : 0.0f);
}

RenderContext make_context(const Scene& scene, const Settings& settings, const FilterView& filter,
                           const Cancel& cancel) {
  const bool ao = settings.method == Method::kAmbientOcclusion;
  RenderContext context;
  context.scene = scene.view();
  context.camera = scene.camera();
  context.environment = scene.environment();
  context.world_program = scene.world_program();
  context.sky = ao ? constant_environment(Vec3(1.0f)) : context.environment;
  context.filter = filter;
  if (!ao) context.lamps = scene.lamps().view();
  context.method = settings.method;
  context.ao_sampling = settings.ao_sampling;
  context.clay_albedo = settings.clay_color;
  context.world_max_bounces = settings.world_max_bounces;
  context.fast_gi = make_fast_gi(settings);
  context.bounces = std::min(settings.bounces, context.fast_gi.last_vertex);
  take_materials(scene.tables(), ao, context);
  context.albedo = lit_albedo(context, 0);
  context.clamp_direct = clamp_limit(settings.sample_clamp_direct);
  context.clamp_indirect = clamp_limit(settings.sample_clamp_indirect);
  context.ao_distance = settings.ao_distance > 0.0f ? settings.ao_distance : Ray{}.t_max;
  context.light_distance = ao ? context.ao_distance : Ray{}.t_max;
  context.light_mask = light_mask(scene, settings.method);
  context.cosine_share = cosine_share(settings.environment_sampling, scene.world_is_uniform());
  const auto& map = scene.world_environment();
  if (!ao && map) {
    context.sky_flux = static_cast<float>(scene.world_strength() * map->mean_flux(cancel));
    if (scene.splits_light_rays()) context.surface_mask = kMaskDiffuse;
  }
  if (!ao && map && !map->black() &&
      settings.environment_sampling == EnvironmentSampling::kProduct) {
    context.product = map->product_table(cancel).view();
  }
  context.shares_light = !scene.splits_light_rays() && !is_dark(context);
  context.transparent = settings.film_transparent;
  context.seed = settings.seed;
  context.light_samples = resolved_light_samples(settings);
  context.passes =
      make_pass_layout(settings.passes, scene.has_catchers(), settings.film_transparent);
  const SceneTables& tables = scene.tables();
  if (!tables.materials.empty() && context.passes.values > tables.value_count) {
    throw std::invalid_argument("a pass asks for a material value that the scene does not have");
  }
  context.has_vector = context.passes.keeps(Quantity::kVector) && scene.is_still();
  if (context.has_vector) {
    context.film_steps = scene.film_steps();
    context.steps = scene.steps();
  }
  context.tables = &tables;
  const bool lifts = tables.lifts_rays();
  // Cycles lifts the rays to lights and those of ambient occlusion, but not what it samples by the
  // surface, which is all there is under an even sky.
  context.lifts_rays = lifts && (ao || !scene.world_is_uniform());
  context.cuts_cosines = !ao && tables.cuts_cosines();
  context.lifts_lamp_rays = lifts && context.lamps.count > 0;
  context.has_terminators = context.lifts_rays || context.lifts_lamp_rays || context.cuts_cosines ||
                            (lifts && (context.passes.keeps_ambient() || context.fast_gi.adds));
  context.bends_round = context.lifts_rays && !ao;
  context.origin = scene.origin();
  context.frame_width = static_cast<float>(scene.camera_desc().width);
  context.frame_height = static_cast<float>(scene.camera_desc().height);
  context.first_sample = settings.sample_offset;
  context.mist_start = settings.mist_start;
  context.mist_depth = settings.mist_depth;
  context.mist_falloff = settings.mist_falloff;
  if (context.fast_gi.last_vertex == 0) end_in_ambient(context);
  return context;
}

}  // namespace komorebi
