#pragma once

#include <vector>

#include "render/context.h"

namespace komorebi {

/// The passes that some rays over a surface's hemisphere are for.
struct AmbientPasses {
  bool occlusion = false, sky_visibility = false, bent_normal = false;
  bool any() const { return occlusion || sky_visibility || bent_normal; }
};

/// Rays of a camera sample beside its light rays, and which passes they fill.
struct AmbientCast {
  RenderContext context;  ///< by which they are drawn
  AmbientPasses passes;
};

/// By which rays for ambient occlusion are drawn at a vertex, as many as light rays.
RenderContext ambient_context(const RenderContext& context, float distance,
                              std::uint32_t vertex = 0);

/// The passes that the light rays themselves fill: they are drawn for ambient occlusion anyway.
AmbientPasses passes_of_light_rays(const RenderContext& context);

/// What has to be cast for the others.
std::vector<AmbientCast> ambient_casts(const RenderContext& context);

/// Adds what one of the rays brings to the row of its sample: `contribution` is that of white
/// ambient light, null where something is in the way.
void add_ambient(const PassLayout& layout, const AmbientPasses& passes, const Vec3& direction,
                 float contribution, float* row);

/// Sums over a sample's rays → means.
void finish_ambient(const RenderContext& context, float* row);

}  // namespace komorebi
