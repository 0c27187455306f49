#pragma once

#include <cstdint>

#include "bvh/binary_tree.h"
#include "bvh/items.h"
#include "bvh/morton_grid.h"
#include "bvh/triangle_cluster.h"
#include "bvh/wide_node.h"
#include "bvh/wide_plan.h"
#include "parallel/radix_sort.h"

namespace komorebi {

/// Runs of the Morton order that a worker takes at once: their boxes and nodes stay in its nearest
/// cache.
inline constexpr std::uint32_t kRunSize = 1024;
/// Most items on a desk: they stay in the next cache.
inline constexpr std::uint32_t kTreeletSize = 4096;

/// Eight floats: the low corner and the negated high corner, each with a lane to spare.
struct alignas(32) WideBox {
  float v[8];
};

/// One worker's desk: a run of items, and the tree over them.
struct Treelet {
  std::uint32_t count = 0;
  WideBox box[kTreeletSize];
  std::uint32_t corner[kTreeletSize][4];  ///< vertices of a triangle, and one to spare
  std::uint32_t item[kTreeletSize];       ///< local index → item
  std::uint32_t ids[kTreeletSize];        ///< position → local index
  std::uint64_t code[kTreeletSize];
  std::uint32_t moved[kTreeletSize];
  std::uint8_t bin[kTreeletSize][4];
  BinaryNode nodes[2 * kTreeletSize];  ///< local: children and leaf positions from 0
  PlanCost cost[2 * kTreeletSize];
  std::uint32_t node_count = 0;
};

/// Runs of items as they stand in Morton order, which a top tree parts as a whole.
struct Clusters {
  BinaryNode* cluster;     ///< box; first, info: run of sorted items
  std::uint32_t* ids;      ///< position → cluster
  std::uint32_t* moved;    ///< scratch of the same length
  std::uint8_t (*bin)[4];  ///< scratch of the same length
};

/// A range of Clusters::ids, with what is known of it.
struct ClusterRange {
  std::uint32_t begin, end;
  std::uint32_t items;  ///< in all its clusters
  WideBox box;
  WideBox centres;  ///< of the centres
};

/// Where a wide tree is written to.
struct EmitTarget {
  const Items* items;
  const BinaryNode* nodes;
  const std::uint32_t* order;
  WideNode* wide;
  std::byte* clusters;     ///< leaves of a mesh, or null
  std::uint32_t* entries;  ///< leaves of a scene: items
};

/// Where the next things go; leaves count in kClusterUnit, or in entries.
struct EmitPlace {
  std::uint32_t node, next_node, next_leaf;
};

/// Of a leaf's record, in kClusterUnit.
inline std::uint32_t leaf_units(const BinaryNode& leaf) {
  return ClusterView::units(leaf.leaf_count(), leaf.leaf_vertices());
}

/// The inner loops of the builders, compiled for one instruction set. They give the same tree in
/// each: only minima, sums and products in a fixed order.
struct BuildKernel {
  /// Codes of items [begin, end); what is left out gets the code `left_out`. Returns how many were.
  std::uint32_t (*code)(const Items& items, const MortonGrid& grid, std::uint32_t begin,
                        std::uint32_t end, std::uint32_t left_out, KeyIndex<std::uint32_t>* out);
  /// Puts items on the desk behind those that are there.
  void (*load)(const Items& items, const std::uint32_t* indices, std::uint32_t count,
               Treelet& treelet);
  /// Builds by the codes of the treelet's items (sorted).
  void (*linear)(const std::uint64_t* codes, LeafLimit limit, float largest_leaf, Treelet& treelet);
  /// Builds by the surface-area heuristic. `scale`: 1 / a length typical of the tree.
  void (*sah)(LeafLimit limit, float scale, Treelet& treelet);
  /// Box and centres of a range.
  void (*measure)(const Clusters& clusters, ClusterRange& range);
  /// Parts a range by the surface-area heuristic, or in halves; both parts are not empty.
  void (*split)(const Clusters& clusters, float scale, bool in_halves, const ClusterRange& range,
                ClusterRange* left, ClusterRange* right);
  /// Writes the wide node that stands for `binary`, and, if asked for, all that is below it.
  void (*emit)(const EmitTarget& to, std::uint32_t binary, bool below, EmitPlace& place);
};

/// The kernel that suits this machine (as for rays, see bvh/kernel.h).
const BuildKernel& build_kernel();

}  // namespace komorebi
