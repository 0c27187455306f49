#pragma once

#include <vector>

#include "core/camera.h"
#include "core/film_steps.h"
#include "render/panorama.h"
#include "render/shutter.h"

namespace komorebi {

/// A thin lens.
struct LensDesc {
  double radius = 0.0;          ///< of the opening, metres; 0: a pinhole
  std::uint32_t blades = 0;     ///< of its polygon; fewer than 3: a disk
  double rotation = 0.0;        ///< radians, counter-clockwise as seen from behind
  double ratio = 1.0;           ///< how many times higher than wide the opening is
  double focus_distance = 1.0;  ///< metres along the axis; panorama: along the ray
};

/// One eye of a stereo pair that turns with the direction looked in; see SphericalStereoView.
struct StereoDesc {
  double eye = 0.0;                   ///< metres to the right, negative: to the left; 0: no stereo
  double convergence_distance = 0.0;  ///< metres; 0: parallel
  double pole_merge_angle_from = 0.0, pole_merge_angle_to = 0.0;  ///< radians; to = 0: never
};

/// How a camera moves while its shutter is open.
struct CameraMotionDesc {
  /// World from camera, looking along −Z with Y up, at even times from the opening to the closing;
  /// an odd number of them, the middle one being the camera's own. Their scale is ignored, as in
  /// Cycles. Empty: it stands still.
  std::vector<Mat4d> poses;
  /// How much wider a perspective view is than at rest when the shutter opens and closes: tangent
  /// of half the angle of view over that at rest.
  double zoom_open = 1.0, zoom_close = 1.0;
};

/// What a host knows of a camera. The matrix carries sensor fit, lens shift, pixel aspect and the
/// picture's shape: clip space is Blender's and OpenGL's, −1…1 in x, y and z, y up.
struct CameraDesc {
  CameraKind kind = CameraKind::kPerspective;
  Mat4d clip_from_world{1.0};  ///< projection · view; world in metres, from the world's own origin
  Mat4d world_from_camera{1.0};  ///< of a panorama, in place of the other; looks along −Z, Y up
  double clip_start = 0.1, clip_end = 1000.0;  ///< metres along the axis; panorama: along the ray
  std::uint32_t width = 0, height = 0;         ///< of the whole frame, in pixels
  LensDesc lens;
  PanoramaDesc panorama;
  StereoDesc stereo;
  ShutterDesc shutter;
  CameraMotionDesc motion;
};

/// Inverts the matrix in double. std::invalid_argument with a sentence when the matrix is not
/// finite or cannot be inverted, does not belong to the kind, the clip distances are no interval,
/// or lens, panorama (make_panorama) or stereo have numbers that stand for nothing.
///
/// A perspective ray solves clip x = X·w and clip y = Y·w for the direction of unit w, so the clip
/// z row, which is nearly parallel to w in distant scenes, costs no digits.
///
/// The camera stands still and its shutter is plain: see CameraTables.
CameraView make_camera(const CameraDesc& desc, const Vec3d& scene_origin);

/// The ways back to the film at the first pose, at rest and at the last one; all the same without
/// poses. `camera` is make_camera's of the same arguments, which CameraTables has accepted.
FilmSteps make_film_steps(const CameraDesc& desc, const Vec3d& scene_origin,
                          const CameraView& camera);

/// Owns what a CameraView's shutter and motion read.
class CameraTables {
 public:
  CameraTables() = default;
  /// Throws std::invalid_argument with a sentence when poses or shutter stand for nothing, or the
  /// middle pose is not where the camera is. `camera` is make_camera's of the same arguments.
  CameraTables(const CameraDesc& desc, const Vec3d& scene_origin, const CameraView& camera);

  /// Valid while the tables live and stay where they are.
  void lend(CameraView& camera) const;

 private:
  ShutterTable shutter_;
  std::vector<MotionPose> poses_;
  CameraMotionView motion_;  // but for the pointer
};

}  // namespace komorebi
