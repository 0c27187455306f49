#include "render/camera_kernel.h"

#include "bvh/kernel.h"
#include "render/one_ray.h"

namespace komorebi {
namespace {

void store(const Ray& ray, const CameraBlock& block, std::uint32_t i) {
  for (int c = 0; c < 3; ++c) {
    block.origin[c][i] = ray.origin[c];
    block.direction[c][i] = ray.direction[c];
  }
  block.t_max[i] = ray.t_max;
  block.time[i] = ray.time;
}

void start_rays_scalar(const RenderContext& context, const CameraBlock& block) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    store(start_ray(context, block.x[i], block.y[i], block.sample[i]), block, i);
  }
}

/// The rays of what draw_points has left.
void project(const RenderContext& context, const CameraBlock& block) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    const Vec2 film(block.origin[0][i], block.origin[1][i]);
    const Vec2 lens(block.direction[0][i], block.direction[1][i]);
    store(camera_ray(context.camera, film, lens, block.time[i]), block, i);
  }
}

/// From when the kernels drew to when the shutter lets light in.
void open_shutter(const ShutterView& shutter, const CameraBlock& block) {
  if (shutter.is_plain()) return;
  for (std::uint32_t i = 0; i < block.count; ++i) {
    block.time[i] = shutter_time(shutter, block.time[i], block.y[i]);
  }
}

}  // namespace

void start_rays(const RenderContext& context, const CameraBlock& block) {
  const int index = active_kernel_index();
  if (index < 0) return start_rays_scalar(context, block);
  const CameraKernel& kernel = *kSimdCameraKernels[index];
  const CameraView& camera = context.camera;
  if (camera.kind != CameraKind::kPanorama && camera.stereo.eye == 0.0 && !camera.motion.moves()) {
    kernel.start_rays(context, block);
    return open_shutter(camera.shutter, block);
  }
  // Samplers and filter are most of the work; projections are many and short.
  kernel.draw_points(context, block);
  open_shutter(camera.shutter, block);
  project(context, block);
}

}  // namespace komorebi
