#pragma once

#include <cmath>

#include "core/ray.h"

namespace komorebi {

enum class CameraKind : std::uint32_t { kPerspective = 0, kOrthographic = 1 };

/// A camera as the inverse of a 4×4 clip-from-world matrix, worked out in double by make_camera
/// (render/camera.h). Positions are relative to the scene's origin. Film coordinates are full-frame
/// pixels with (0, 0) in the lower left corner of the picture; pixel (i, j) has its centre at
/// (i + 1/2, j + 1/2). A point of the film is measured from the middle of the picture, so that no
/// digits are lost there. Rays are computed in double and rounded once.
struct CameraView {
  CameraKind kind = CameraKind::kPerspective;
  double film_center_x = 0.0, film_center_y = 0.0;  ///< pixels
  Vec3d origin{0.0};     ///< perspective: the eye; orthographic: depth 0 behind the film's centre
  Vec3d direction{0.0};  ///< per unit of depth, through the film's centre
  Vec3d per_x{0.0};      ///< change of `direction` (orthographic: of `origin`) per pixel
  Vec3d per_y{0.0};
  Vec3d depth_gradient{0.0};                ///< depth of p = dot(p − origin, depth_gradient)
  double clip_start = 0.0, clip_end = 0.0;  ///< in depth
};

/// The ray at a point of the film: it starts on the near clip plane, has unit direction and ends on
/// the far clip plane. `lens_uv` in [0,1)² is for the lens to come; `time` is stored in the ray.
inline Ray camera_ray(const CameraView& camera, const Vec2& film_xy,
                      [[maybe_unused]] const Vec2& lens_uv, float time) {
  const double x = static_cast<double>(film_xy.x) - camera.film_center_x;
  const double y = static_cast<double>(film_xy.y) - camera.film_center_y;
  const Vec3d shift = x * camera.per_x + y * camera.per_y;
  const bool orthographic = camera.kind == CameraKind::kOrthographic;
  const Vec3d eye = orthographic ? camera.origin + shift : camera.origin;
  const Vec3d along = orthographic ? camera.direction : camera.direction + shift;
  const double length = std::sqrt(glm::dot(along, along));  // distance per unit of depth

  Ray ray;
  ray.origin = Vec3(eye + camera.clip_start * along);
  ray.direction = Vec3(along / length);
  ray.t_min = 0.0f;
  ray.t_max = static_cast<float>((camera.clip_end - camera.clip_start) * length);
  ray.time = time;
  ray.mask = kMaskCamera;
  return ray;
}

/// Planar depth of a point (relative to the scene's origin), as Cycles writes it to the depth pass:
/// along the camera's axis, from the camera, whatever the clip distances.
inline float camera_depth(const CameraView& camera, const Vec3& world_point) {
  return static_cast<float>(glm::dot(Vec3d(world_point) - camera.origin, camera.depth_gradient));
}

}  // namespace komorebi
