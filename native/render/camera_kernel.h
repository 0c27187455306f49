#pragma once

#include "render/context.h"

namespace komorebi {

/// Camera samples, and room for their rays, as arrays; padded to multiples of 16.
struct CameraBlock {
  std::uint32_t count = 0;
  const std::uint32_t *x, *y, *sample;  ///< full-frame pixels
  const std::uint32_t* pixel_seed;      ///< Sampler::pixel_seed
  float *origin[3], *direction[3], *t_max, *time;
};

/// start_ray (one_ray.h) for many samples at once, compiled for one instruction set; equal to it in
/// every bit. A camera ray starts at t_min = 0. Panoramas, spherical stereo and cameras that move
/// are not for it, and times are those that are drawn, before the shutter's curve.
struct CameraKernel {
  void (*start_rays)(const RenderContext& context, const CameraBlock& block);
  /// Only what start_ray draws: time, the film point (in origin[0], [1]) and the point of the
  /// square that the lens is drawn from (in direction[0], [1]).
  void (*draw_points)(const RenderContext& context, const CameraBlock& block);
};

/// In the order of KOMOREBI_KERNELS (bvh/simd_targets.h).
extern const CameraKernel* const kSimdCameraKernels[];

/// The same in the active instruction set (bvh/traverse.h).
void start_rays(const RenderContext& context, const CameraBlock& block);

}  // namespace komorebi
