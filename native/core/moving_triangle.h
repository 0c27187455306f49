#pragma once

#include "core/motion.h"
#include "core/scene_view.h"

namespace komorebi {

/// Between which sets of a deforming mesh's positions a ray's time lies, and where.
struct SetPlace {
  std::uint32_t set;
  float fraction;
};
inline SetPlace set_place(std::uint32_t sets, float time) {
  const MotionPlace place = motion_place(sets, static_cast<double>(time));
  return {place.step, static_cast<float>(place.fraction)};
}

struct Corners {
  Vec3 corner[3];
};

/// Rows of three of [sets][count][3] at a time: linear between sets. Neighbours that share a vertex
/// have the same one, so that a surface stays watertight.
inline Corners corners_at(const float* rows, std::size_t count, const std::uint32_t* three,
                          const SetPlace& place) {
  const float f = place.fraction, s = 1.0f - f;
  Corners at;
  for (int k = 0; k < 3; ++k) {
    const float* from = rows + 3 * (place.set * count + three[k]);
    const float* to = from + 3 * count;
    at.corner[k] = Vec3(s * from[0] + f * to[0], s * from[1] + f * to[1], s * from[2] + f * to[2]);
  }
  return at;
}

/// A triangle of a mesh that deforms.
inline Corners moving_triangle(const MeshView& mesh, std::size_t triangle, const SetPlace& place) {
  return corners_at(mesh.vtx2xyz, mesh.vertex_count, mesh.tri2vtx + 3 * triangle, place);
}

/// The normals of a triangle's corners; the mesh has normals. Of sets, or the same all the time.
inline Corners corner_normals(const MeshView& mesh, std::size_t triangle, float time) {
  const std::uint32_t* three = mesh.tri2normal + 3 * triangle;
  if (mesh.normal_sets > 1) {
    return corners_at(mesh.normals, mesh.normal_count, three, set_place(mesh.normal_sets, time));
  }
  Corners at;
  for (int k = 0; k < 3; ++k) {
    const float* n = mesh.normals + 3 * std::size_t{three[k]};
    at.corner[k] = Vec3(n[0], n[1], n[2]);
  }
  return at;
}

}  // namespace komorebi
