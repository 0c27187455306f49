#pragma once

#include <cmath>

#include "core/surface_point.h"
#include "support/ray_list.h"
#include "support/test_scene.h"

namespace komorebi::bench {

/// A camera of 1024 × 1024 pixels, of which a few tiles of 64 × 64 are rendered: as coherent as a
/// whole picture, at a fraction of the time.
struct View {
  Vec3 eye{0.0f}, forward{0.0f}, up{0.0f, 1.0f, 0.0f};
  float width = 1.0f;  ///< of the picture one unit ahead

  static constexpr int kPixels = 1024, kTile = 64;
};

/// From outside, far enough to see all of `box`.
inline View outside_view(const Aabb& box, const Vec3& up) {
  const Vec3 diagonal = box.hi - box.lo;
  View view;
  view.up = up;
  const Vec3 flat = up.y > 0.5f ? Vec3(-0.3f, -0.4f, -1.0f) : Vec3(-0.3f, 1.0f, -0.4f);
  view.forward = glm::normalize(flat);
  view.eye = centre(box) - view.forward * std::sqrt(glm::dot(diagonal, diagonal));
  return view;
}

/// The rays of `across`² tiles spread evenly over the picture, tile by tile, row by row.
inline testing::RayList camera_rays(const View& view, int across) {
  const Vec3 right = glm::normalize(glm::cross(view.forward, view.up));
  const Vec3 up = glm::cross(right, view.forward);
  testing::RayList rays;
  for (int tile = 0; tile < across * across; ++tile) {
    const int step = View::kPixels / across, inset = (step - View::kTile) / 2;
    const int x0 = tile % across * step + inset, y0 = tile / across * step + inset;
    for (int i = 0; i < View::kTile * View::kTile; ++i) {
      const float x = (float(x0 + i % View::kTile) + 0.5f) / View::kPixels - 0.5f;
      const float y = (float(y0 + i / View::kTile) + 0.5f) / View::kPixels - 0.5f;
      Ray ray;
      ray.origin = view.eye;
      ray.direction = glm::normalize(view.forward + view.width * (x * right + y * up));
      rays.push_back(ray);
    }
  }
  return rays;
}

/// A place that camera rays hit, moved off the surface as the renderer does (core/surface_point.h).
struct Place {
  Vec3 origin, normal;
  std::uint32_t instance, primitive;
};

inline std::vector<Place> places(const SceneView& scene, const testing::RayList& camera) {
  std::vector<Hit> hits(camera.size());
  intersect(scene, camera.span(), hits.data());
  std::vector<Place> found;
  for (std::uint32_t i = 0; i < camera.size(); ++i) {
    if (!hits[i].valid()) continue;
    const SurfacePoint point = surface_point(scene, hits[i], camera[i]);
    found.push_back(
        {leaving_origin(point), point.geometric_normal, hits[i].instance, hits[i].primitive});
  }
  return found;
}

}  // namespace komorebi::bench
