#include "render/camera_kernel.h"

#include "bvh/kernel.h"
#include "render/one_ray.h"

namespace komorebi {
namespace {

void start_rays_scalar(const RenderContext& context, const CameraBlock& block) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    const Ray ray = start_ray(context, block.x[i], block.y[i], block.sample[i]);
    for (int c = 0; c < 3; ++c) {
      block.origin[c][i] = ray.origin[c];
      block.direction[c][i] = ray.direction[c];
    }
    block.t_max[i] = ray.t_max;
    block.time[i] = ray.time;
  }
}

}  // namespace

void start_rays(const RenderContext& context, const CameraBlock& block) {
  // Panoramas and spherical stereo take turns: they cost little beside tracing, and many lines.
  const CameraView& camera = context.camera;
  if (camera.kind == CameraKind::kPanorama || camera.stereo.eye != 0.0) {
    return start_rays_scalar(context, block);
  }
  const int kernel = active_kernel_index();
  if (kernel >= 0) return kSimdCameraKernels[kernel]->start_rays(context, block);
  start_rays_scalar(context, block);
}

}  // namespace komorebi
