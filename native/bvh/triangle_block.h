#pragma once

#include <cstdint>

#include "core/vector.h"

namespace komorebi {

inline constexpr int kBlockSize = 4;  ///< triangles tested at once

/// The triangles of one leaf with their corners copied in, as arrays. Unused places hold corners
/// that are not numbers, for which every comparison of the triangle test is false.
struct alignas(32) TriangleBlock {
  float corner[3][3][kBlockSize];       ///< [corner][axis][triangle]
  std::uint32_t primitive[kBlockSize];  ///< index in the mesh; kNone: unused

  Vec3 position(int which, int triangle) const {
    return Vec3(corner[which][0][triangle], corner[which][1][triangle], corner[which][2][triangle]);
  }
};
static_assert(sizeof(TriangleBlock) == 160);

}  // namespace komorebi
