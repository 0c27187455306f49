#pragma once

#include <bit>
#include <cstdint>

#include "core/aabb.h"

namespace komorebi {

inline constexpr int kWidth = 8;  ///< children of a wide node

/// Eight boxes on a grid of the node's own, 80 bytes: 8 bits a plane, after Ylitie, Karras and
/// Laine 2017 ("Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs"). A
/// plane's place is origin + q · 2^k, in plain float operations; the grid is laid so that these
/// boxes contain the exact ones (bvh/quantise.h), and so decide nothing (core/triangle.h).
///
/// Children stand in order: first the inner ones, whose nodes are neighbours, then the leaves.
struct alignas(16) WideNode {
  float origin[3];
  std::uint8_t exponent[3];      ///< of the grid's step per axis, biased as a float's; 1…254
  std::uint8_t counts;           ///< inner children | all children << 4
  std::uint32_t first_child;     ///< node of inner child i: first_child + i
  std::uint32_t first_leaf;      ///< leaf of child i: first_leaf + leaf[i]
  std::uint8_t leaf[kWidth];     ///< 0 for inner and unused children
  std::uint8_t q[3][2][kWidth];  ///< [axis][lower, upper][child]

  int inner_count() const { return counts & 15; }
  int child_count() const { return counts >> 4; }
  std::uint32_t child_node(int i) const { return first_child + static_cast<std::uint32_t>(i); }
  std::uint32_t child_leaf(int i) const { return first_leaf + leaf[i]; }

  /// Distance of the grid's planes, a power of two.
  float step(int axis) const {
    return std::bit_cast<float>(static_cast<std::uint32_t>(exponent[axis]) << 23);
  }
  float plane(int axis, int side, int i) const {
    return origin[axis] + static_cast<float>(q[axis][side][i]) * step(axis);
  }
  Aabb box(int i) const {
    Aabb b;
    b.lo = Vec3(plane(0, 0, i), plane(1, 0, i), plane(2, 0, i));
    b.hi = Vec3(plane(0, 1, i), plane(1, 1, i), plane(2, 1, i));
    return b;
  }
};
static_assert(sizeof(WideNode) == 80);

}  // namespace komorebi
