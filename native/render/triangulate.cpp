#include "render/triangulate.h"

#include "core/vector.h"

namespace komorebi {
namespace {

/// Blender's own test in single precision, so that both agree on every quad: with the diagonal from
/// corner 0 to corner 2, do the halves have opposite normals?
bool halves_face_each_other(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3) {
  const Vec3 diagonal = p2 - p0;
  return glm::dot(glm::cross(p1 - p0, diagonal), glm::cross(p3 - p0, diagonal)) > 0.0f;
}

}  // namespace

bool only_triangles_and_quads(std::span<const std::int32_t> face_offsets) {
  for (std::size_t f = 0; f + 1 < face_offsets.size(); ++f) {
    if (face_offsets[f + 1] - face_offsets[f] > 4) return false;
  }
  return true;
}

Triangulation triangulate(std::span<const float> vtx2xyz, std::span<const std::int32_t> corner2vtx,
                          std::span<const std::int32_t> face_offsets) {
  const std::size_t faces = face_offsets.empty() ? 0 : face_offsets.size() - 1;
  const std::size_t triangles = corner2vtx.size() - 2 * faces;  // n corners make n − 2
  Triangulation result;
  result.tri2corner.resize(3 * triangles);
  result.tri2face.resize(triangles);
  std::size_t next = 0;
  const auto emit = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::size_t face) {
    result.tri2corner[3 * next] = a;
    result.tri2corner[3 * next + 1] = b;
    result.tri2corner[3 * next + 2] = c;
    result.tri2face[next++] = static_cast<std::int32_t>(face);
  };
  const auto point = [&](std::int32_t corner) {
    const float* p =
        &vtx2xyz[3 * static_cast<std::size_t>(corner2vtx[static_cast<std::size_t>(corner)])];
    return Vec3(p[0], p[1], p[2]);
  };
  for (std::size_t f = 0; f < faces; ++f) {
    const std::int32_t c = face_offsets[f];
    if (face_offsets[f + 1] - c == 3) {
      emit(c, c + 1, c + 2, f);
    } else if (halves_face_each_other(point(c), point(c + 1), point(c + 2), point(c + 3))) {
      emit(c, c + 1, c + 3, f);
      emit(c + 1, c + 2, c + 3, f);
    } else {
      emit(c, c + 1, c + 2, f);
      emit(c, c + 2, c + 3, f);
    }
  }
  return result;
}

}  // namespace komorebi
