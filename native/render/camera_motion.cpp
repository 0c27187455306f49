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

Vec3d position(const Mat4d& pose, const Vec3d& scene_origin) {
  return Vec3d(pose[3]) - scene_origin;
}

/// `second` after `first`.
AffineMap chained(const AffineMap& second, const AffineMap& first) {
  return {second.linear * first.linear, second.linear * first.translation + second.translation};
}

/// The film of a camera at rest, or zoomed.
/// @param axis  per unit of depth, around which it zooms
AffineMap into_film(const CameraView& camera, double zoom, const Vec3d& axis) {
  const Mat3d film = camera.kind == CameraKind::kPanorama
                         ? camera.world_from_camera
                         : Mat3d(zoom * camera.per_x, zoom * camera.per_y,
                                 axis + zoom * (camera.direction - axis));
  const Mat3d inverse = glm::inverse(film);
  return {inverse, -(inverse * camera.origin)};
}

}  // namespace

FilmSteps make_film_steps(const CameraDesc& desc, const Vec3d& scene_origin,
                          const CameraView& camera) {
  FilmSteps film;
  film.kind = camera.kind;
  film.panorama = camera.panorama;
  film.center_x = camera.film_center_x;
  film.center_y = camera.film_center_y;
  film.rest = film.before = film.after = into_film(camera, 1.0, Vec3d(0.0));
  const CameraMotionDesc& motion = desc.motion;
  if (motion.poses.empty()) return film;
  const Mat4d& rest_pose = motion.poses[motion.poses.size() / 2];
  const Mat4d rest = unscaled(rest_pose);
  Vec3d axis = -Vec3d(rest[2]);
  if (camera.kind == CameraKind::kPerspective) axis /= glm::dot(axis, camera.depth_gradient);
  const auto at = [&](const Mat4d& pose, double zoom) {
    const AffineMap map = zoom != 1.0 ? into_film(camera, zoom, axis) : film.rest;
    if (pose == rest_pose) return map;
    // From the pose to the rest: there the film is known.
    const Mat4d there = unscaled(pose);
    const Mat3d back = Mat3d(rest) * glm::inverse(Mat3d(there));
    const AffineMap to_rest{back,
                            position(rest, scene_origin) - back * position(there, scene_origin)};
    return chained(map, to_rest);
  };
  film.before = at(motion.poses.front(), motion.zoom_open);
  film.after = at(motion.poses.back(), motion.zoom_close);
  return film;
}

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
  if (desc.shutter.still) motion_ = {};
  if (!moves || desc.shutter.still) return;
  poses_ = decompose_poses(poses, scene_origin);
  motion_.pose_count = static_cast<std::uint32_t>(count);
}

void CameraTables::lend(CameraView& camera) const {
  camera.shutter = shutter_.view();
  camera.motion = motion_;
  camera.motion.poses = poses_.empty() ? nullptr : poses_.data();
}

}  // namespace komorebi
