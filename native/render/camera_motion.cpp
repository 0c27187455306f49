#include <cmath>
#include <stdexcept>

#include "render/camera.h"
#include "render/motion.h"

namespace komorebi {
namespace {

void require(bool good, const char* sentence) {
  if (!good) throw std::invalid_argument(std::string("camera: ") + sentence);
}

/// The pose without its scale.
Mat4d unscaled(Mat4d pose) {
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(Vec3d(pose[axis]));
    require(length > 0.0 && std::isfinite(length), "a pose has an axis without length");
    pose[axis] /= length;
  }
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) require(std::isfinite(pose[c][r]), "a pose is not finite");
  }
  require(std::abs(glm::determinant(Mat3d(pose))) > 1e-9, "a pose is flat");
  return pose;
}

bool is_zoom(double x) {
  return x > 0.0 && x <= 1e6;
}

}  // namespace

CameraTables::CameraTables(const CameraDesc& desc, const Vec3d& scene_origin,
                           const CameraView& camera)
    : shutter_(desc.shutter, desc.height) {
  const CameraMotionDesc& motion = desc.motion;
  const bool zooms = motion.zoom_open != 1.0 || motion.zoom_close != 1.0;
  require(is_zoom(motion.zoom_open) && is_zoom(motion.zoom_close), "the zoom must be more than 0");
  require(!zooms || desc.kind == CameraKind::kPerspective, "only a perspective camera can zoom");
  if (motion.poses.empty()) {
    // Around the way through the film's centre but for a shift of the lens, which needs the pose.
    require(!zooms, "a camera that zooms needs its poses");
    return;
  }
  const std::size_t count = motion.poses.size();
  require(count >= 3 && count % 2 == 1 && count <= 4097,
          "the poses must be 3 to 4097, an odd number");
  std::vector<Mat4d> poses;
  for (const Mat4d& pose : motion.poses) poses.push_back(unscaled(pose));
  const Mat4d& rest = poses[count / 2];
  const Vec3d eye = Vec3d(rest[3]) - scene_origin;
  if (desc.kind != CameraKind::kOrthographic) {
    const double reach = 1.0 + glm::length(Vec3d(rest[3]));
    require(glm::length(eye - camera.origin) < 1e-3 * reach,
            "the middle pose is not where the camera is");
  }
  bool moves = false;
  for (const Mat4d& pose : poses) moves = moves || pose != rest;
  motion_.camera_from_world = glm::inverse(Mat3d(rest));
  motion_.rest_position = eye;
  motion_.axis = -Vec3d(rest[2]);
  if (desc.kind == CameraKind::kPerspective) {
    const double depth = glm::dot(motion_.axis, camera.depth_gradient);
    require(depth > 0.0, "the middle pose does not look where the camera does");
    motion_.axis /= depth;
  }
  motion_.zoom_open = motion.zoom_open;
  motion_.zoom_close = motion.zoom_close;
  if (!moves) return;
  poses_ = decompose_poses(poses, scene_origin);
  motion_.pose_count = static_cast<std::uint32_t>(count);
}

void CameraTables::lend(CameraView& camera) const {
  camera.shutter = shutter_.view();
  camera.motion = motion_;
  camera.motion.poses = poses_.empty() ? nullptr : poses_.data();
}

}  // namespace komorebi
