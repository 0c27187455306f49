#pragma once

#include <cstdint>

#include "core/aabb.h"

namespace komorebi {

inline constexpr int kWidth = 8;  ///< children of a wide node

/// Eight boxes as arrays, so that one SIMD instruction meets one plane of all of them; 256 bytes,
/// four cache lines. Unused places have the empty box, which no ray meets.
struct alignas(64) WideNode {
  float lo[3][kWidth];
  float hi[3][kWidth];
  /// Inner child: index of its node. Leaf of a mesh: index of its one TriangleBlock. Leaf of a
  /// scene: first entry in leaf2instance.
  std::uint32_t child[kWidth];
  std::uint32_t count[kWidth];  ///< 0: inner child (or unused); else primitives in the leaf

  Aabb box(int i) const {
    Aabb b;
    b.lo = Vec3(lo[0][i], lo[1][i], lo[2][i]);
    b.hi = Vec3(hi[0][i], hi[1][i], hi[2][i]);
    return b;
  }
  void set_box(int i, const Aabb& b) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis][i] = b.lo[axis];
      hi[axis][i] = b.hi[axis];
    }
  }
};
static_assert(sizeof(WideNode) == 256);

}  // namespace komorebi
