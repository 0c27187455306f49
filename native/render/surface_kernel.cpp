#include "render/surface_kernel.h"

#include <cstring>

#include "bvh/traverse.h"

namespace komorebi {
namespace {

void surface_points_scalar(const RenderContext& context, const SurfaceBlock& block) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    const std::uint32_t path = block.path[i];
    const SurfacePoint point = surface_point(context.scene, block.hits[path], block.rays[path]);
    const Vec3 origin = leaving_origin(point);
    for (int c = 0; c < 3; ++c) {
      block.normal[c][i] = point.normal[c];
      block.geometric_normal[c][i] = point.geometric_normal[c];
      block.leaving_origin[c][i] = origin[c];
    }
    block.depth[i] = camera_depth(context.camera, point.position);
  }
}

}  // namespace

void surface_points(const RenderContext& context, const SurfaceBlock& block) {
  const char* const name = active_instruction_set();
  for (const SurfaceKernel* const* kernel = kSimdSurfaceKernels; *kernel != nullptr; ++kernel) {
    if (std::strcmp((*kernel)->name, name) == 0) return (*kernel)->surface_points(context, block);
  }
  surface_points_scalar(context, block);
}

}  // namespace komorebi
