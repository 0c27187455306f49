#include "render/surface_kernel.h"

#include "bvh/kernel.h"
#include "render/light.h"

namespace komorebi {

void surface_point_at(const RenderContext& context, const SurfaceBlock& block, std::uint32_t i) {
  const std::uint32_t path = block.path[i];
  const SurfacePoint point = surface_point(context.scene, block.hits[path], block.rays[path]);
  const Vec3 origin = leaving_origin(point);
  for (int c = 0; c < 3; ++c) {
    block.normal[c][i] = point.normal[c];
    block.geometric_normal[c][i] = point.geometric_normal[c];
    block.leaving_origin[c][i] = origin[c];
  }
  block.depth[i] = camera_depth(context.camera, point.position);
  if (context.has_materials) {
    for (int c = 0; c < 3; ++c) block.position[c][i] = point.position[c];
    block.offset[i] = point.offset;
  }
  if (!context.has_terminators) return;
  const Terminator end =
      terminator(context, block.hits[path], block.rays.time[path], point.geometric_normal);
  for (int c = 0; c < 3; ++c) block.lift[c][i] = end.lift[c];
  block.cutoff[i] = end.cutoff;
  block.frequency[i] = end.frequency;
}

void surface_points(const RenderContext& context, const SurfaceBlock& block) {
  const int kernel = active_kernel_index();
  if (kernel >= 0) return kSimdSurfaceKernels[kernel]->surface_points(context, block);
  for (std::uint32_t i = 0; i < block.count; ++i) surface_point_at(context, block, i);
}

}  // namespace komorebi
