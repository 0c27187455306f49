#pragma once

#include "core/camera.h"
#include "core/panorama_point.h"

namespace komorebi {

/// The ways from the world (relative to the scene's origin) back to the film, through the middle of
/// the lens: what film_ray (core/camera.h) goes forth. Each leads to (x w, y w, w), where x and y
/// are pixels from the middle of the picture and w is the depth; of an orthographic camera to x, y
/// and the depth, of a panorama into the camera's own space. Made by make_film_steps
/// (render/camera.h).
struct FilmSteps {
  CameraKind kind = CameraKind::kPerspective;
  PanoramaView panorama;
  double center_x = 0.0, center_y = 0.0;  ///< of the picture, in pixels
  AffineMap before, rest, after;          ///< a step of time before, at rest, a step after
};

/// The full-frame pixel where a point is seen. As in Cycles, a point behind the camera has the one
/// across the vanishing point, and what is at depth 0, or nowhere, has the picture's corner (0, 0).
inline glm::dvec2 film_point(const FilmSteps& film, const AffineMap& into_film,
                             const Vec3d& world) {
  const Vec3d at = into_film.linear * world + into_film.translation;
  glm::dvec2 from_middle;
  if (film.kind == CameraKind::kPanorama) {
    from_middle = panorama_point(film.panorama, at);
  } else {
    const double w = film.kind == CameraKind::kPerspective ? at.z : 1.0;
    from_middle = {at.x / w, at.y / w};
  }
  constexpr double kFar = 1e15;
  const bool is_somewhere = std::abs(from_middle.x) < kFar && std::abs(from_middle.y) < kFar;
  return is_somewhere ? from_middle + glm::dvec2(film.center_x, film.center_y) : glm::dvec2(0.0);
}

}  // namespace komorebi
