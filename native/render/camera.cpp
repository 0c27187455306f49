#include "render/camera.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace komorebi {
namespace {

struct ClipRow {
  Vec3d gradient;
  double offset;
};

// Row r of the matrix as a function of a point relative to the scene's origin.
ClipRow clip_row(const Mat4d& m, int r, const Vec3d& scene_origin) {
  const Vec3d gradient(m[0][r], m[1][r], m[2][r]);
  return {gradient, m[3][r] + glm::dot(gradient, scene_origin)};
}

// The inverse of the matrix with these rows, by cross products.
Mat3d inverse_of_rows(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d bc = glm::cross(b, c);
  const double determinant = glm::dot(a, bc);
  const double scale = glm::length(a) * glm::length(b) * glm::length(c);
  if (!(std::abs(determinant) > 1e-12 * scale)) {
    throw std::invalid_argument("camera: the projection matrix cannot be inverted");
  }
  return Mat3d(bc / determinant, glm::cross(c, a) / determinant, glm::cross(a, b) / determinant);
}

void require(bool good, const char* sentence) {
  if (!good) throw std::invalid_argument(std::string("camera: ") + sentence);
}

void check(const CameraDesc& desc) {
  const bool panorama = desc.kind == CameraKind::kPanorama;
  const Mat4d& matrix = panorama ? desc.world_from_camera : desc.clip_from_world;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      require(std::isfinite(matrix[c][r]),
              panorama ? "the matrix is not finite" : "the projection matrix is not finite");
    }
  }
  require(desc.width != 0 && desc.height != 0, "the picture has no pixels");
  const bool least = desc.kind == CameraKind::kOrthographic ||
                     (panorama ? desc.clip_start >= 0.0 : desc.clip_start > 0.0);
  require(std::isfinite(desc.clip_start) && std::isfinite(desc.clip_end) &&
              desc.clip_start < desc.clip_end && least,
          "clip start must be less than clip end");
}

bool is_positive(double x) {
  return x > 0.0 && x <= 1e30;
}

/// `right` and `up` are unit vectors across the axis, in the space that rays are worked out in.
void set_lens(CameraView& view, const LensDesc& lens, const Vec3d& right, const Vec3d& up) {
  require(lens.radius >= 0.0 && lens.radius <= 1e30, "the lens must have a finite opening");
  if (lens.radius == 0.0) return;
  require(is_positive(lens.focus_distance), "the focus distance must be more than 0");
  require(is_positive(lens.ratio), "the aperture's ratio must be more than 0");
  require(std::isfinite(lens.rotation), "the aperture's rotation is not finite");
  require(lens.blades <= 1000, "the aperture cannot have more than 1000 blades");
  view.has_lens = true;
  view.lens_x = right * (lens.radius / lens.ratio);
  view.lens_y = up * lens.radius;
  view.inverse_focus = 1.0 / lens.focus_distance;
  if (lens.blades < 3) return;
  const double turns = lens.rotation / (2.0 * kPi);
  const auto half = sin_cos_turns(0.5 / lens.blades);
  view.aperture.blades = lens.blades;
  view.aperture.rotation = static_cast<float>(turns - std::floor(turns));
  view.aperture.cos_half = static_cast<float>(half.cos);
  view.aperture.sin_half = static_cast<float>(half.sin);
}

void set_stereo(CameraView& view, const StereoDesc& stereo) {
  require(std::isfinite(stereo.eye), "the interocular distance is not finite");
  if (stereo.eye == 0.0) return;
  require(view.kind != CameraKind::kOrthographic,
          "spherical stereo needs a panorama or a perspective camera");
  require(stereo.convergence_distance >= 0.0 && std::isfinite(stereo.convergence_distance),
          "the convergence distance must be finite and not negative");
  require(std::isfinite(stereo.pole_merge_angle_from) && std::isfinite(stereo.pole_merge_angle_to),
          "the angles of the pole merge are not finite");
  // A mirror ball shows left and right exchanged, and Cycles exchanges the eyes with them.
  const bool mirrored =
      view.kind == CameraKind::kPanorama && view.panorama.kind == PanoramaKind::kMirrorBall;
  view.stereo.eye = mirrored ? -stereo.eye : stereo.eye;
  if (stereo.convergence_distance > 0.0) {
    view.stereo.inverse_convergence = 1.0 / stereo.convergence_distance;
  }
  view.stereo.merge_from = stereo.pole_merge_angle_from;
  view.stereo.merge_to = stereo.pole_merge_angle_to;
}

void set_panorama(CameraView& view, const CameraDesc& desc, const Vec3d& scene_origin) {
  const Mat4d& m = desc.world_from_camera;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d column(m[axis]);
    const double length = glm::length(column);
    require(length > 0.0 && std::isfinite(length), "the matrix has an axis without length");
    view.world_from_camera[axis] = column / length;
  }
  // Axes in one plane would leave directions without a ray.
  require(std::abs(glm::determinant(view.world_from_camera)) > 1e-9, "the matrix is flat");
  view.origin = Vec3d(m[3]) - scene_origin;
  view.panorama = make_panorama(desc.panorama, desc.width, desc.height);
}

}  // namespace

CameraView make_camera(const CameraDesc& desc, const Vec3d& scene_origin) {
  check(desc);
  CameraView view;
  view.kind = desc.kind;
  view.film_center_x = 0.5 * desc.width;
  view.film_center_y = 0.5 * desc.height;
  view.clip_start = desc.clip_start;
  view.clip_end = desc.clip_end;
  if (desc.kind == CameraKind::kPanorama) {
    set_panorama(view, desc, scene_origin);
    set_lens(view, desc.lens, Vec3d(1.0, 0.0, 0.0), Vec3d(0.0, 1.0, 0.0));
    set_stereo(view, desc.stereo);
    return view;
  }

  const ClipRow x = clip_row(desc.clip_from_world, 0, scene_origin);
  const ClipRow y = clip_row(desc.clip_from_world, 1, scene_origin);
  const ClipRow z = clip_row(desc.clip_from_world, 2, scene_origin);
  const ClipRow w = clip_row(desc.clip_from_world, 3, scene_origin);
  const bool has_vanishing_point = glm::length(w.gradient) > 0.0;
  const double ndc_per_x = 2.0 / desc.width;
  const double ndc_per_y = 2.0 / desc.height;

  if (desc.kind == CameraKind::kPerspective) {
    require(has_vanishing_point, "a perspective camera has an orthographic matrix");
    const Mat3d inverse = inverse_of_rows(x.gradient, y.gradient, w.gradient);
    view.origin = inverse * Vec3d(-x.offset, -y.offset, -w.offset);
    view.direction = inverse[2];
    view.per_x = inverse[0] * ndc_per_x;
    view.per_y = inverse[1] * ndc_per_y;
    view.depth_gradient = w.gradient;
  } else {
    require(!has_vanishing_point && w.offset > 0.0,
            "an orthographic camera has a perspective matrix");
    const Mat3d inverse = inverse_of_rows(x.gradient, y.gradient, z.gradient);
    const Vec3d near_center = inverse * Vec3d(-x.offset, -y.offset, -w.offset - z.offset);
    view.direction = glm::normalize(inverse[2]);
    view.origin = near_center - desc.clip_start * view.direction;
    view.per_x = inverse[0] * (w.offset * ndc_per_x);
    view.per_y = inverse[1] * (w.offset * ndc_per_y);
    view.depth_gradient = glm::normalize(z.gradient);
  }
  set_lens(view, desc.lens, glm::normalize(view.per_x), glm::normalize(view.per_y));
  set_stereo(view, desc.stereo);
  return view;
}

}  // namespace komorebi
