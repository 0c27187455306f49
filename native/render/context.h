#pragma once

#include "core/camera.h"
#include "core/environment_product.h"
#include "core/filter.h"
#include "core/lamp_choice.h"
#include "core/sampler.h"
#include "core/scene_view.h"
#include "render/fast_gi.h"
#include "render/passes.h"
#include "render/scene.h"
#include "render/settings.h"

namespace komorebi {

/// What every stage of a render reads: the committed scene and the settings, as plain values.
struct RenderContext {
  SceneView scene;
  CameraView camera;
  EnvironmentView environment;  ///< what is seen behind the scene, unless a program says it
  const Program* world_program = nullptr;
  EnvironmentView sky;  ///< what lights it: the same, or white for ambient occlusion
  ProductView product;  ///< bins = 0: light rays are drawn by cosine_share
  LampsView lamps;      ///< none for ambient occlusion
  FilterView filter;
  Method method = Method::kAmbientOcclusion;
  AoSampling ao_sampling = AoSampling::kCosine;
  Vec3 albedo{1.0f};               ///< what light rays are drawn for: see lit_albedo (shade.h)
  Vec3 clay_albedo{0.8f};          ///< of surfaces without a material
  bool has_materials = false;      ///< whether surfaces have albedos of their own (shade.h)
  std::uint32_t bounces = 0;       ///< how often a path goes on from a surface
  bool indirect_emission = false;  ///< whether what paths find shines on the surfaces before it
  /// Most that a vertex brings, as the sum of the channels: in view, and after a bounce.
  float clamp_direct = Ray{}.t_max, clamp_indirect = Ray{}.t_max;
  FastGi fast_gi;
  float light_distance = 0.0f;  ///< largest t of a light ray
  float cosine_share = 1.0f;  ///< share of light rays drawn from the cosine; the rest from the map
  std::uint32_t light_mask = kMaskShadow;     ///< of light rays
  std::uint32_t lamp_mask = kMaskShadow;      ///< of rays to lamps
  std::uint32_t scatter_mask = kMaskDiffuse;  ///< of rays to the next surface
  /// Where it matters that Cycles finds a map's light by rays of two kinds (surface_share in
  /// light.h): the mask of those that it samples by the surface, light_mask being that of the
  /// others, and the map's mean_flux with its strength. Else 0.
  std::uint32_t surface_mask = 0;
  float sky_flux = 0.0f;
  /// What counts of the light that they find, and of that which the others find; their largest t.
  float surface_factor = 1.0f, map_factor = 1.0f;
  float surface_distance = Ray{}.t_max;
  std::uint32_t world_max_bounces = 0;  ///< Settings
  /// Whether scattered rays see what light rays see, so that both can bring the sky's light
  /// (scatter.h).
  bool shares_light = false;
  /// Whether rays may leave above coarse smooth surfaces, and then go below their own triangle, or
  /// cosines be cut (core/terminator.h). Points have a terminator where any of their rays heeds it.
  bool has_terminators = false, lifts_rays = false, bends_round = false, cuts_cosines = false;
  std::uint32_t light_dimension =
      vertex_dimension(0, kVertexLightDirection);  ///< that light rays are drawn by
  bool lifts_lamp_rays = false;                    ///< the same as lifts_rays for rays to lamps
  bool transparent = false;
  std::uint32_t seed = 0;
  std::uint32_t light_samples = 1;
  std::uint32_t lamp_samples = 0;  ///< rays to lamps from a surface; 0: by light_samples

  FilmSteps film_steps;  ///< for the Vector pass
  StepsView steps;
  bool has_vector = false;  ///< whether that pass is kept and not black, as where motion is blurred

  PassLayout passes;                              ///< what is kept besides radiance and alpha
  const SceneTables* tables = nullptr;            ///< for passes that tell what is seen
  Vec3d origin{0.0};                              ///< of the scene's space in Blender's
  float frame_width = 1.0f, frame_height = 1.0f;  ///< of the whole frame, in pixels
  std::uint32_t first_sample = 0;
  float ao_distance = 0.0f;  ///< largest t of a ray for ambient occlusion, whatever the method
  float mist_start = 0.0f, mist_depth = 0.0f;
  MistFalloff mist_falloff = MistFalloff::kQuadratic;
};

/// Whether no light comes from the sky, so that no rays need to go there.
inline bool is_dark(const RenderContext& context) {
  return context.sky.width == 0 && context.sky.constant == Vec3(0.0f);
}

/// Whether surfaces get light beside the world's.
inline bool has_more_light(const RenderContext& context) {
  return context.lamps.count > 0 || context.fast_gi.adds;
}

/// An upper bound of the radiance that the world sends along any ray, and about the most that lamps
/// bring to a camera sample.
float max_radiance(const Scene& scene, const Settings& settings);

/// The settings are checked and the scene is committed and outlives the context.
RenderContext make_context(const Scene& scene, const Settings& settings, const FilterView& filter,
                           const Cancel& cancel = Cancel::never());

}  // namespace komorebi
