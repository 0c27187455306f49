#include "render/camera.h"

#include <cmath>
#include <stdexcept>

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

void check(const CameraDesc& desc) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(desc.clip_from_world[c][r])) {
        throw std::invalid_argument("camera: the projection matrix is not finite");
      }
    }
  }
  if (desc.width == 0 || desc.height == 0) {
    throw std::invalid_argument("camera: the picture has no pixels");
  }
  const bool perspective = desc.kind == CameraKind::kPerspective;
  const bool interval = std::isfinite(desc.clip_start) && std::isfinite(desc.clip_end) &&
                        desc.clip_start < desc.clip_end && (!perspective || desc.clip_start > 0.0);
  if (!interval) throw std::invalid_argument("camera: clip start must be less than clip end");
}

}  // namespace

CameraView make_camera(const CameraDesc& desc, const Vec3d& scene_origin) {
  check(desc);
  const ClipRow x = clip_row(desc.clip_from_world, 0, scene_origin);
  const ClipRow y = clip_row(desc.clip_from_world, 1, scene_origin);
  const ClipRow z = clip_row(desc.clip_from_world, 2, scene_origin);
  const ClipRow w = clip_row(desc.clip_from_world, 3, scene_origin);
  const bool has_vanishing_point = glm::length(w.gradient) > 0.0;

  CameraView view;
  view.kind = desc.kind;
  view.film_center_x = 0.5 * desc.width;
  view.film_center_y = 0.5 * desc.height;
  view.clip_start = desc.clip_start;
  view.clip_end = desc.clip_end;
  const double ndc_per_x = 2.0 / desc.width;
  const double ndc_per_y = 2.0 / desc.height;

  if (desc.kind == CameraKind::kPerspective) {
    if (!has_vanishing_point) {
      throw std::invalid_argument("camera: a perspective camera has an orthographic matrix");
    }
    const Mat3d inverse = inverse_of_rows(x.gradient, y.gradient, w.gradient);
    view.origin = inverse * Vec3d(-x.offset, -y.offset, -w.offset);
    view.direction = inverse[2];
    view.per_x = inverse[0] * ndc_per_x;
    view.per_y = inverse[1] * ndc_per_y;
    view.depth_gradient = w.gradient;
    return view;
  }

  if (has_vanishing_point || !(w.offset > 0.0)) {
    throw std::invalid_argument("camera: an orthographic camera has a perspective matrix");
  }
  const Mat3d inverse = inverse_of_rows(x.gradient, y.gradient, z.gradient);
  const Vec3d near_center = inverse * Vec3d(-x.offset, -y.offset, -w.offset - z.offset);
  view.direction = glm::normalize(inverse[2]);
  view.origin = near_center - desc.clip_start * view.direction;
  view.per_x = inverse[0] * (w.offset * ndc_per_x);
  view.per_y = inverse[1] * (w.offset * ndc_per_y);
  view.depth_gradient = glm::normalize(z.gradient);
  return view;
}

}  // namespace komorebi
