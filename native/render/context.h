#pragma once

#include "core/camera.h"
#include "core/environment_product.h"
#include "core/filter.h"
#include "core/scene_view.h"
#include "render/scene.h"
#include "render/settings.h"

namespace komorebi {

/// What every stage of a render reads: the committed scene and the settings, as plain values.
struct RenderContext {
  SceneView scene;
  CameraView camera;
  EnvironmentView environment;  ///< what is seen behind the scene
  EnvironmentView sky;          ///< what lights it: the same, or white for ambient occlusion
  ProductView product;          ///< bins = 0: light rays are drawn by cosine_share
  FilterView filter;
  Method method = Method::kAmbientOcclusion;
  AoSampling ao_sampling = AoSampling::kCosine;
  Vec3 albedo{1.0f};            ///< of every surface; 1 for ambient occlusion
  float light_distance = 0.0f;  ///< largest t of a light ray
  float cosine_share = 1.0f;  ///< share of light rays drawn from the cosine; the rest from the map
  bool transparent = false;
  std::uint32_t seed = 0;
  std::uint32_t light_samples = 1;
};

/// The settings are checked and the scene is committed and outlives the context.
RenderContext make_context(const Scene& scene, const Settings& settings, const FilterView& filter);

}  // namespace komorebi
