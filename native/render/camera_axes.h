#pragma once

#include "core/camera.h"

namespace komorebi {

/// The axes of the camera: right, up, and the way it looks; of a panorama those of Cycles, which
/// turns it as it turns environment maps: the way it looks, left, up (a mirror ball: right, back,
/// up).
inline Mat3d camera_axes(const CameraView& camera) {
  if (camera.kind == CameraKind::kPanorama) {
    const Mat3d& axes = camera.world_from_camera;
    return camera.panorama.kind == PanoramaKind::kMirrorBall ? Mat3d(axes[0], axes[2], axes[1])
                                                             : Mat3d(-axes[2], -axes[0], axes[1]);
  }
  return Mat3d(glm::normalize(camera.per_x), glm::normalize(camera.per_y),
               glm::normalize(camera.depth_gradient));
}

}  // namespace komorebi
