#pragma once

#include "core/camera.h"

namespace komorebi {

/// What a host knows of a camera. The matrix carries sensor fit, lens shift, pixel aspect and the
/// picture's shape: clip space is Blender's and OpenGL's, −1…1 in x, y and z, y up.
struct CameraDesc {
  CameraKind kind = CameraKind::kPerspective;
  Mat4d clip_from_world{1.0};  ///< projection · view; world in metres, from the world's own origin
  double clip_start = 0.1, clip_end = 1000.0;  ///< metres along the axis
  std::uint32_t width = 0, height = 0;         ///< of the whole frame, in pixels
};

/// Inverts the matrix in double. std::invalid_argument with a sentence when the matrix is not
/// finite or cannot be inverted, does not belong to the kind, or the clip distances are no
/// interval.
///
/// A perspective ray solves clip x = X·w and clip y = Y·w for the direction of unit w, so the clip
/// z row, which is nearly parallel to w in distant scenes, costs no digits.
CameraView make_camera(const CameraDesc& desc, const Vec3d& scene_origin);

}  // namespace komorebi
