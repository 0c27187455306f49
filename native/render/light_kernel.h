#pragma once

#include <vector>

#include "render/context.h"

namespace komorebi {

/// Coordinates of many vectors.
struct Columns {
  const float *x, *y, *z;
};

/// Points for which light rays are to be drawn, and room for what is drawn, as arrays.
struct LightBlock {
  static constexpr std::uint32_t kLanes = 16;  ///< arrays are padded to multiples of this

  std::uint32_t point_count = 0;
  const float* normal[3];            ///< of the shading
  const float* geometric_normal[3];  ///< on the same side
  const float* origin[3];            ///< leaving_origin
  const std::uint32_t* pixel_seed;   ///< Sampler::pixel_seed
  const std::uint32_t* first_index;  ///< of the point's light rays
  std::uint32_t rays_per_point = 0;
  std::uint32_t stride = 0;  ///< point_count, padded; ray j of point p is at j · stride + p
  float* direction[3];
  float* contribution[3];
};

/// sample_light (light.h) for many points at once, compiled for one instruction set; equal to it
/// in every bit.
struct LightKernel {
  void (*ambient)(const RenderContext& context, const LightBlock& block);
  void (*even)(const RenderContext& context, const LightBlock& block);
  void (*product)(const RenderContext& context, const LightBlock& block);
};

/// In the order of KOMOREBI_KERNELS (bvh/simd_targets.h).
extern const LightKernel* const kSimdLightKernels[];

/// The same for every method, in the kernels of the active instruction set (bvh/traverse.h) where
/// there are such, else by sample_light itself.
void sample_lights(const RenderContext& context, const LightBlock& block);

}  // namespace komorebi
