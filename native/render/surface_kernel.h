#pragma once

#include "core/surface_point.h"
#include "render/context.h"

namespace komorebi {

/// Camera rays' hits, and room for what is known of the points, as arrays; padded to multiples of
/// 16 entries.
struct SurfaceBlock {
  std::uint32_t count = 0;
  const std::uint32_t* path;  ///< which ray and hit each point is of
  const Hit* hits;
  RaySpan rays;
  float *normal[3], *geometric_normal[3];
  float* leaving_origin[3];
  float* depth;  ///< camera_depth
  /// SurfacePoint's; written where surfaces have materials alone.
  float *position[3], *offset;
  /// The point's Terminator; nothing is written unless the context has terminators.
  float *lift[3], *cutoff, *frequency;
};

/// surface_point, leaving_origin (core/surface_point.h), camera_depth and terminator (light.h) for
/// many hits at once, compiled for one instruction set; equal to them in every bit.
struct SurfaceKernel {
  const char* name;
  void (*surface_points)(const RenderContext& context, const SurfaceBlock& block);
};

/// Null-terminated, best first.
extern const SurfaceKernel* const kSimdSurfaceKernels[];

/// The same for the i-th of them alone: for those that no kernel does in lanes.
void surface_point_at(const RenderContext& context, const SurfaceBlock& block, std::uint32_t i);

/// The same in the active instruction set (bvh/traverse.h).
void surface_points(const RenderContext& context, const SurfaceBlock& block);

}  // namespace komorebi
