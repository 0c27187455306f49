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

void triangulate(std::span<const float> vtx2xyz, std::span<const std::int32_t> corner2vtx,
                 std::span<const std::int32_t> face_offsets, std::span<std::uint32_t> tri2corner,
                 ThreadPool& pool, const Cancel& cancel) {
  constexpr std::size_t kGrain = 1 << 14;
  const auto point = [&](std::size_t corner) {
    const float* p = &vtx2xyz[3 * static_cast<std::size_t>(corner2vtx[corner])];
    return Vec3(p[0], p[1], p[2]);
  };
  const std::size_t faces = face_offsets.empty() ? 0 : face_offsets.size() - 1;
  pool.for_each_chunk(faces, kGrain, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) throw Cancelled();
    for (std::size_t f = begin; f < end; ++f) {
      const auto c = static_cast<std::uint32_t>(face_offsets[f]);
      std::uint32_t* out = &tri2corner[3 * (c - 2 * f)];
      const auto emit = [&out](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        *out++ = i;
        *out++ = j;
        *out++ = k;
      };
      if (face_offsets[f + 1] - face_offsets[f] == 3) {
        emit(c, c + 1, c + 2);
      } else if (halves_face_each_other(point(c), point(c + 1), point(c + 2), point(c + 3))) {
        emit(c, c + 1, c + 3);
        emit(c + 1, c + 2, c + 3);
      } else {
        emit(c, c + 1, c + 2);
        emit(c, c + 2, c + 3);
      }
    }
  });
}

}  // namespace komorebi
