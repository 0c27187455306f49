#include "render/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "render/triangulate.h"

namespace komorebi {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw std::invalid_argument("mesh \"" + name + "\": " + what);
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::size_t count_non_finite_rows(std::span<const float> rows) {
  std::size_t bad = 0;
  for (std::size_t i = 0; i + 2 < rows.size(); i += 3) {
    bad += !(std::isfinite(rows[i]) && std::isfinite(rows[i + 1]) && std::isfinite(rows[i + 2]));
  }
  return bad;
}

std::size_t count_outside(std::span<const std::int32_t> indices, std::size_t limit) {
  return static_cast<std::size_t>(
      std::count_if(indices.begin(), indices.end(),
                    [&](std::int32_t i) { return i < 0 || static_cast<std::size_t>(i) >= limit; }));
}

void check_faces(const MeshInput& in) {
  if (in.face_offsets.empty()) refuse(in.name, "face_offsets needs at least one entry");
  if (in.face_offsets.front() != 0 ||
      static_cast<std::size_t>(in.face_offsets.back()) != in.corner2vtx.size()) {
    refuse(in.name, "face_offsets must run from 0 to the number of corners, " +
                        std::to_string(in.corner2vtx.size()));
  }
  std::size_t small = 0;
  for (std::size_t f = 0; f + 1 < in.face_offsets.size(); ++f) {
    // In 64 bits: garbage offsets may not overflow the subtraction.
    small += std::int64_t{in.face_offsets[f + 1]} - in.face_offsets[f] < 3;
  }
  if (small)
    refuse(in.name, counted(small, "face has", "faces have") + " fewer than three corners");
}

void check_triangles(const MeshInput& in) {
  const std::size_t faces = in.face_offsets.size() - 1;
  if (in.tri2corner.empty() && in.tri2face.empty()) {
    if (!only_triangles_and_quads(in.face_offsets)) {
      refuse(in.name, "a face has more than four corners, so tri2corner is needed");
    }
    return;
  }
  if (in.tri2corner.size() != 3 * in.tri2face.size()) {
    refuse(in.name, "tri2corner and tri2face must have as many triangles");
  }
  if (const auto bad = count_outside(in.tri2corner, in.corner2vtx.size())) {
    refuse(in.name, counted(bad, "triangle corner is", "triangle corners are") + " out of range");
  }
  if (const auto bad = count_outside(in.tri2face, faces)) {
    refuse(in.name,
           counted(bad, "triangle names a face", "triangles name a face") + " that is not there");
  }
}

}  // namespace

void check_mesh(const MeshInput& in) {
  const std::size_t faces = in.face_offsets.empty() ? 0 : in.face_offsets.size() - 1;
  if (in.vtx2xyz.size() / 3 >= kNone || in.corner2vtx.size() >= 0x7fffffffu / 3) {
    refuse(in.name, "more vertices or corners than 32-bit indices can count");
  }
  if (const auto bad = count_non_finite_rows(in.vtx2xyz)) {
    refuse(in.name, counted(bad, "vertex is", "vertices are") + " not finite");
  }
  check_faces(in);
  if (const auto bad = count_outside(in.corner2vtx, in.vtx2xyz.size() / 3)) {
    refuse(in.name,
           counted(bad, "corner names a vertex", "corners name a vertex") + " that is not there");
  }
  check_triangles(in);
  if (!in.corner2normal.empty() && in.corner2normal.size() != 3 * in.corner2vtx.size()) {
    refuse(in.name, "corner_normals must have one row a corner");
  }
  if (!in.face2smooth.empty() && in.face2smooth.size() != faces) {
    refuse(in.name, "smooth_faces must have one entry a face");
  }
  if (!in.face2material.empty() && in.face2material.size() != faces) {
    refuse(in.name, "face_materials must have one entry a face");
  }
  if (const auto bad = count_outside(in.face2material, 1u << 15)) {
    refuse(in.name, counted(bad, "face has a material slot", "faces have a material slot") +
                        " outside 0 to 32767");
  }
}

}  // namespace komorebi
