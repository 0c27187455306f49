#pragma once

#include <cmath>

#include "core/lens.h"
#include "core/motion.h"
#include "core/panorama.h"
#include "core/ray.h"
#include "core/shutter.h"
#include "core/spherical_stereo.h"

namespace komorebi {

enum class CameraKind : std::uint32_t { kPerspective = 0, kOrthographic = 1, kPanorama = 2 };

/// How a camera moves while its shutter is open: rays of the rest pose, at time 1/2, go through the
/// camera's own space to its pose at their time. Made by CameraTables (render/camera.h).
struct CameraMotionView {
  const MotionPose* poses = nullptr;  ///< at even times, without scale; null: it stands still
  std::uint32_t pose_count = 0;
  Mat3d camera_from_world{1.0};  ///< at rest, around rest_position
  Vec3d rest_position{0.0};
  Vec3d axis{0.0};  ///< per unit of depth, along the camera's axis
  /// How much wider the view is than at rest when the shutter opens and closes; perspective alone.
  double zoom_open = 1.0, zoom_close = 1.0;

  bool zooms() const { return zoom_open != 1.0 || zoom_close != 1.0; }
  bool moves() const { return poses != nullptr || zooms(); }
  /// As Cycles has it: linear on either side of the rest.
  double zoom_at(double time) const {
    return time < 0.5 ? zoom_open + 2.0 * time * (1.0 - zoom_open)
                      : 1.0 + (2.0 * time - 1.0) * (zoom_close - 1.0);
  }
};

/// A camera, worked out in double by make_camera (render/camera.h): the inverse of a 4×4
/// clip-from-world matrix, or a panorama's projection and pose; a lens; an eye of a stereo pair.
/// Positions are relative to the scene's origin. Film coordinates are full-frame pixels with (0, 0)
/// in the lower left corner of the picture; pixel (i, j) has its centre at (i + 1/2, j + 1/2). A
/// point of the film is measured from the middle of the picture, so that no digits are lost there.
/// Rays are computed in double and rounded once.
struct CameraView {
  CameraKind kind = CameraKind::kPerspective;
  double film_center_x = 0.0, film_center_y = 0.0;  ///< pixels
  Vec3d origin{0.0};     ///< the eye; orthographic: depth 0 behind the film's centre
  Vec3d direction{0.0};  ///< per unit of depth, through the film's centre
  Vec3d per_x{0.0};      ///< change of `direction` (orthographic: of `origin`) per pixel
  Vec3d per_y{0.0};
  Vec3d depth_gradient{0.0};                ///< depth of p = dot(p − origin, depth_gradient)
  double clip_start = 0.0, clip_end = 0.0;  ///< in depth; panorama: in distance

  bool has_lens = false;  ///< false: a pinhole, all is sharp
  ApertureView aperture;
  Vec3d lens_x{0.0}, lens_y{0.0};  ///< metres that a unit of the aperture's x and y stands for
  double inverse_focus = 0.0;      ///< 1 / depth (panorama: distance) of what is sharp

  PanoramaView panorama;         ///< of a panorama, as is the next
  Mat3d world_from_camera{1.0};  ///< its axes: right, up, back
  SphericalStereoView stereo;

  ShutterView shutter;
  CameraMotionView motion;  ///< all of the above is at rest
};

/// A camera ray before it is rounded: origin on the near clip, unit direction, length.
struct CameraRay {
  Vec3d origin{0.0}, direction{0.0};
  double t_max = 0.0;
};

namespace detail {

inline Vec3d unit(const Vec3d& v) {
  return v / std::sqrt(glm::dot(v, v));
}

/// What moves the rays of a camera that stands still.
struct Stay {
  void operator()(Vec3d&, Vec3d&) const {}
};

/// Through a point of the opening to where the pinhole's ray is sharp. Distances along the ray are
/// Cycles': of a perspective camera those of the pinhole's ray to the clip planes.
/// @param move  takes origin and unit direction from the rest pose to that of the ray's time
template <class Move>
inline CameraRay lens_ray(const CameraView& camera, const Vec3d& eye, const Vec3d& along,
                          const Vec2& lens_uv, const Move& move) {
  const bool orthographic = camera.kind == CameraKind::kOrthographic;
  const double length = std::sqrt(glm::dot(along, along));
  Vec3d origin = eye, direction = along;
  if (camera.has_lens) {
    const Vec2 p = aperture_point(camera.aperture, lens_uv);
    const Vec3d on_lens =
        static_cast<double>(p.x) * camera.lens_x + static_cast<double>(p.y) * camera.lens_y;
    origin += on_lens;
    direction -= camera.inverse_focus * on_lens;
  }
  const double bent = std::sqrt(glm::dot(direction, direction));
  direction /= bent;
  move(origin, direction);
  if (camera.stereo.eye != 0.0) {
    turn_to_eye(camera.stereo, Vec3d(0.0, 0.0, 1.0), origin, direction);
  }
  const double reach = camera.clip_start * (orthographic ? bent : length);
  return {origin + reach * direction, direction, (camera.clip_end - camera.clip_start) * length};
}

/// The point of a panorama's lens: it stands across the ray that it bends, its x axis towards the
/// axis of the projection (in a mirror ball to the right, where it is seen mirrored), as in Cycles.
inline Vec3d panorama_lens_point(const CameraView& camera, const Vec3d& direction,
                                 const Vec2& lens_uv) {
  const bool mirror = camera.panorama.kind == PanoramaKind::kMirrorBall;
  const Vec3d axis = mirror ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 0.0, -1.0);
  const Vec3d across = axis - glm::dot(axis, direction) * direction;
  const double length = std::sqrt(glm::dot(across, across));
  if (!(length > 0.0)) return Vec3d(0.0);
  const Vec3d x = across / length;
  const Vec3d y = mirror ? glm::cross(x, direction) : glm::cross(direction, x);
  const Vec2 p = aperture_point(camera.aperture, lens_uv);
  return (static_cast<double>(p.x) * camera.lens_x.x) * x +
         (static_cast<double>(p.y) * camera.lens_y.y) * y;
}

inline CameraRay panorama_ray(const CameraView& camera, double x, double y, const Vec2& lens_uv) {
  Vec3d direction = panorama_direction(camera.panorama, x, y);
  const double square = glm::dot(direction, direction);
  if (!(square > 0.0)) return {camera.origin, unit(-camera.world_from_camera[2]), -1.0};
  direction /= std::sqrt(square);
  Vec3d origin(0.0);
  if (camera.has_lens) {
    origin = panorama_lens_point(camera, direction, lens_uv);
    direction = unit(direction - camera.inverse_focus * origin);
  }
  if (camera.stereo.eye != 0.0) {
    turn_to_eye(camera.stereo, Vec3d(0.0, 1.0, 0.0), origin, direction);
  }
  const Vec3d world = unit(camera.world_from_camera * direction);
  return {camera.origin + camera.world_from_camera * origin + camera.clip_start * world, world,
          camera.clip_end - camera.clip_start};
}

}  // namespace detail

namespace detail {

/// @param zoom  how much wider than at rest the view is, around the camera's axis
/// @param move  as lens_ray has it
template <class Move>
inline CameraRay film_ray(const CameraView& camera, double x, double y, const Vec2& lens_uv,
                          double zoom, const Move& move) {
  if (camera.kind == CameraKind::kPanorama) {
    CameraRay ray = panorama_ray(camera, x, y, lens_uv);
    move(ray.origin, ray.direction);
    return ray;
  }
  const Vec3d shift = x * camera.per_x + y * camera.per_y;
  const bool orthographic = camera.kind == CameraKind::kOrthographic;
  const Vec3d eye = orthographic ? camera.origin + shift : camera.origin;
  Vec3d along = orthographic ? camera.direction : camera.direction + shift;
  if (zoom != 1.0) along = camera.motion.axis + zoom * (along - camera.motion.axis);
  if (camera.has_lens || camera.stereo.eye != 0.0) {
    return lens_ray(camera, eye, along, lens_uv, move);
  }
  const double length = std::sqrt(glm::dot(along, along));  // distance per unit of depth
  CameraRay ray{eye + camera.clip_start * along, along / length,
                (camera.clip_end - camera.clip_start) * length};
  move(ray.origin, ray.direction);
  return ray;
}

}  // namespace detail

/// The ray at a point of the film, given from the middle of the picture, of the camera at rest.
inline CameraRay film_ray(const CameraView& camera, double x, double y, const Vec2& lens_uv) {
  return detail::film_ray(camera, x, y, lens_uv, 1.0, detail::Stay());
}

/// The same at a time in [0, 1].
inline CameraRay film_ray(const CameraView& camera, double x, double y, const Vec2& lens_uv,
                          double time) {
  const CameraMotionView& motion = camera.motion;
  if (!motion.moves()) return film_ray(camera, x, y, lens_uv);
  const double zoom = motion.zoom_at(time);
  if (motion.poses == nullptr) {
    return detail::film_ray(camera, x, y, lens_uv, zoom, detail::Stay());
  }
  const AffineMap pose = pose_at(motion.poses, motion.pose_count, time);
  return detail::film_ray(camera, x, y, lens_uv, zoom, [&](Vec3d& origin, Vec3d& direction) {
    origin = pose.linear * (motion.camera_from_world * (origin - motion.rest_position)) +
             pose.translation;
    direction = detail::unit(pose.linear * (motion.camera_from_world * direction));
  });
}

/// The ray at a point of the film: it starts on the near clip plane, has unit direction and ends on
/// the far clip plane (of a panorama: sphere). `lens_uv` in [0,1)² chooses the point of the lens;
/// `time` in [0, 1] is stored in the ray. Outside a panorama's circle there is no ray: see has_ray.
inline Ray camera_ray(const CameraView& camera, const Vec2& film_xy, const Vec2& lens_uv,
                      float time) {
  const double x = static_cast<double>(film_xy.x) - camera.film_center_x;
  const double y = static_cast<double>(film_xy.y) - camera.film_center_y;
  const CameraRay exact = film_ray(camera, x, y, lens_uv, static_cast<double>(time));
  Ray ray;
  ray.origin = Vec3(exact.origin);
  ray.direction = Vec3(exact.direction);
  ray.t_min = 0.0f;
  ray.t_max = static_cast<float>(exact.t_max);
  ray.time = time;
  ray.mask = kMaskCamera;
  return ray;
}

/// False for a ray that stands for no light at all (outside a fisheye's circle): it ends before it
/// starts, hits nothing, and its sample is black and opaque, as in Cycles.
inline bool has_ray(float t_max) {
  return t_max >= 0.0f;
}

/// Depth of a point (relative to the scene's origin), as Cycles writes it to the depth pass: along
/// the camera's axis at rest, from the camera, whatever the clip distances; of a panorama the
/// distance.
inline float camera_depth(const CameraView& camera, const Vec3& world_point) {
  const Vec3d from_eye = Vec3d(world_point) - camera.origin;
  if (camera.kind == CameraKind::kPanorama) {
    return static_cast<float>(std::sqrt(glm::dot(from_eye, from_eye)));
  }
  return static_cast<float>(glm::dot(from_eye, camera.depth_gradient));
}

}  // namespace komorebi
