#pragma once

#include "render/context.h"

namespace komorebi {

/// Vertices that paths are to go on from, and room for how they do, as arrays padded to multiples
/// of 16 entries.
struct ScatterBlock {
  std::uint32_t count = 0;
  const float *normal[3], *geometric_normal[3];  ///< on the side that the paths go on from
  const float* frequency;           ///< Terminator::frequency; read where cosines are cut
  const std::uint32_t* pixel_seed;  ///< Sampler::pixel_seed
  const std::uint32_t* sample;
  float* throughput[3];     ///< with the vertex's albedo; from there on, where the path goes on
  std::uint32_t* goes_on;   ///< whether it does: 1 or 0
  float* direction[3];      ///< if so
  std::uint32_t* path_key;  ///< the same
};

/// scatter (scatter.h) for many vertices at once, compiled for one instruction set; equal to it in
/// every bit. Cosines are not cut.
struct ScatterKernel {
  void (*scatter)(std::uint32_t vertex, const ScatterBlock& block);
};

/// In the order of KOMOREBI_KERNELS (bvh/simd_targets.h).
extern const ScatterKernel* const kSimdScatterKernels[];

/// scatter for all of the block, in the active instruction set (bvh/traverse.h).
void scatter_all(const RenderContext& context, std::uint32_t vertex, const ScatterBlock& block);

}  // namespace komorebi
