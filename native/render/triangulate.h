#pragma once

#include <cstdint>
#include <span>

#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// Number of triangles of faces that have three or more corners each: n corners make n − 2.
inline std::size_t triangle_count_of(std::span<const std::int32_t> face_offsets) {
  if (face_offsets.empty()) return 0;
  return static_cast<std::size_t>(face_offsets.back()) - 2 * (face_offsets.size() - 1);
}

/// Fills tri2corner [triangles][3] in the order of Blender's loop triangles, for faces of three or
/// four corners; inputs are validated. Quads are split as Blender does: along the first and third
/// corner, unless the two halves would then face each other (a concave or twisted quad), which
/// flips the diagonal. Triangle t of face f is number face_offsets[f] − 2 f + t.
void triangulate(std::span<const float> vtx2xyz, std::span<const std::int32_t> corner2vtx,
                 std::span<const std::int32_t> face_offsets, std::span<std::uint32_t> tri2corner,
                 ThreadPool& pool, const Cancel& cancel);

}  // namespace komorebi
