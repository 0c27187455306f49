#pragma once

#include "core/surface_point.h"
#include "render/context.h"
#include "render/film.h"

namespace komorebi {

/// Camera ray of a sample: pixel filter, lens and time drawn from the sample's own dimensions.
Ray start_ray(const RenderContext& context, std::uint32_t x, std::uint32_t y, std::uint32_t sample);

/// What a camera ray that misses everything shows: the world as the camera sees it.
PixelSample background(const RenderContext& context, const Vec3& direction);

/// The same with its row of passes; opaque black where the camera sends no ray (has_ray,
/// core/camera.h).
PixelSample missed(const RenderContext& context, const Vec3& direction, float t_max, float* row);

/// Whether what was hit is to be a hole in the picture.
inline bool is_holdout(const RenderContext& context, const Hit& hit) {
  return (context.scene.instances[hit.instance].flags & kInstanceHoldout) != 0;
}
inline bool is_catcher(const RenderContext& context, std::uint32_t instance) {
  return (context.scene.instances[instance].flags & kInstanceShadowCatcher) != 0;
}

/// One camera sample of one pixel, from the camera to its radiance, one ray after another. This is
/// the specification of a render, its row of passes (pass_row.h) included; the batches (batch.h) do
/// the same work in another order and must agree to the bit.
PixelSample render_sample(const RenderContext& context, std::uint32_t x, std::uint32_t y,
                          std::uint32_t sample, float* row);

}  // namespace komorebi
