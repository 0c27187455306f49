#pragma once

#include <cstdint>

#include "core/aabb.h"
#include "parallel/scratch.h"

namespace komorebi {

/// A node of the binary tree that every builder makes and that wide nodes are filled from.
///
/// The upper corner is kept negated, so that one minimum of eight lanes is a union of boxes.
struct alignas(32) BinaryNode {
  float lo[3];
  std::uint32_t first;  ///< inner: left child, the right one follows; leaf: position in `order`
  float minus_hi[3];
  /// Leaf: how many items | how many different vertices << 8. Inner: kInnerBit, and how it is best
  /// spread over wide nodes (bvh/wide_plan.h).
  std::uint32_t info;

  bool is_leaf() const { return info < 0x80000000u; }
  std::uint32_t leaf_count() const { return info & 255u; }
  std::uint32_t leaf_vertices() const { return info >> 8; }
  Aabb box() const {
    Aabb b;
    b.lo = Vec3(lo[0], lo[1], lo[2]);
    b.hi = Vec3(-minus_hi[0], -minus_hi[1], -minus_hi[2]);
    return b;
  }
  void set_box(const Aabb& b) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = b.lo[axis];
      minus_hi[axis] = -b.hi[axis];
    }
  }
};
static_assert(sizeof(BinaryNode) == 32);

inline constexpr std::uint32_t kInnerBit = 0x80000000u;

/// Node 0 is the root. Which index a node has may differ from build to build; what it holds, and
/// the order of its children, may not.
struct BinaryTree {
  Scratch<BinaryNode> nodes;
  Scratch<std::uint32_t> order;  ///< position → item; leaves are runs of it
  std::uint32_t item_count = 0;  ///< positions in use, 0: no tree
};

}  // namespace komorebi
