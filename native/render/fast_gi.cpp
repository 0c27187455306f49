#include "render/fast_gi.h"

#include <algorithm>

#include "render/ambient.h"

namespace komorebi {

FastGi make_fast_gi(const Settings& s) {
  FastGi made;
  if (!s.use_fast_gi || s.method != Method::kWorldLight || !(s.fast_gi_factor > 0.0f)) return made;
  made.distance = s.fast_gi_distance;
  made.factor = s.fast_gi_factor;
  made.adds = s.fast_gi_method == FastGiMethod::kAdd;
  if (!made.adds && s.fast_gi_bounces > 0) made.last_vertex = s.fast_gi_bounces - 1;
  return made;
}

void end_in_ambient(RenderContext& context) {
  const FastGi& gi = context.fast_gi;
  if (context.sky.width == 0) {  // Cycles samples an even sky by the surface alone
    context.light_distance = std::min(context.light_distance, gi.distance);
    context.sky = constant_environment(context.sky.constant * gi.factor);
    return;
  }
  context.surface_mask = context.scatter_mask;
  context.surface_distance = gi.distance;
  context.surface_factor = gi.factor;
}

RenderContext added_light_context(const RenderContext& context, std::uint32_t vertex) {
  return ambient_context(context, context.fast_gi.distance, vertex);
}

}  // namespace komorebi
