#pragma once

#include <cstdint>

#include "core/ray.h"

namespace komorebi {

struct RenderContext;
struct Settings;

/// Cycles' Fast GI Approximation, for previews: ambient occlusion in place of the rest of the
/// light's way (Replace), or on top of all light (Add).
struct FastGi {
  std::uint32_t last_vertex = kNone;  ///< of paths whose rest is replaced; kNone: of none
  bool adds = false;                  ///< whether surfaces get white ambient light besides
  float distance = 0.0f;              ///< how far things hide the sky, or the white
  float factor = 1.0f;                ///< of the light that is not hidden
};

/// What of it applies: none to ambient occlusion, none by a factor or by bounces of 0.
FastGi make_fast_gi(const Settings& settings);

/// Makes a context that of a path's last vertex, where what things hide of the sky is ambient
/// occlusion. As in Cycles that goes for rays that it samples by the surface; those to where a map
/// is bright go all the way.
void end_in_ambient(RenderContext& context);

/// By which the rays of added light are drawn at a vertex, given the context of its light rays.
RenderContext added_light_context(const RenderContext& context, std::uint32_t vertex);

}  // namespace komorebi
