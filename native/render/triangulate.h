#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace komorebi {

/// Triangles of a polygon mesh: three corner indices each, in the order of Blender's loop
/// triangles.
struct Triangulation {
  std::vector<std::int32_t> tri2corner;  ///< [triangles][3]
  std::vector<std::int32_t> tri2face;    ///< [triangles]
};

/// True when every face has three or four corners, which `triangulate` asks for.
bool only_triangles_and_quads(std::span<const std::int32_t> face_offsets);

/// Splits quads as Blender does: along the first and third corner, unless the two halves would then
/// face each other (a concave or twisted quad), which flips the diagonal. Inputs are validated.
Triangulation triangulate(std::span<const float> vtx2xyz, std::span<const std::int32_t> corner2vtx,
                          std::span<const std::int32_t> face_offsets);

}  // namespace komorebi
