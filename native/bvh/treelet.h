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

/// Codes on a desk have 31 bits, of those in which they differ.
inline constexpr std::uint32_t kLastCode = 0x7fffffffu;
inline constexpr std::uint32_t kCodesBehind = 16;

/// One worker's desk: a run of items, and the tree over them.
struct Treelet {
  std::uint32_t count = 0;
  std::uint32_t node_count = 0;
  WideBox box[kTreeletSize];
  alignas(16) float centre[kTreeletSize][4];          ///< and minus the longest side; by sah()
  alignas(16) std::uint32_t corner[kTreeletSize][4];  ///< vertices of a triangle, and kNone
  std::uint64_t vertex_bits[kTreeletSize];            ///< of its vertices' hashes
  std::uint32_t item[kTreeletSize];                   ///< local index → item
  std::uint32_t ids[kTreeletSize];                    ///< position → local index
  std::uint32_t code[kTreeletSize + kCodesBehind];
  std::uint32_t moved[kTreeletSize];
  BinaryNode nodes[2 * kTreeletSize];  ///< local: children and leaf positions from 0
  PlanCost cost[2 * kTreeletSize];
};

/// What becomes of a treelet: a forest, whose roots go into a wide node above. Nodes and leaves are
/// counted from the treelet's first ones; those of the roots are not among them.
struct WideTreelet {
  std::uint32_t room = 1;  ///< at most so many roots, in a grid of that step
  Vec3 step{0.0f};
  std::uint32_t root_count;
  BinaryNode root[kPlanWidth - 1];
  float cost;              ///< of all
  WideNode* root_nodes;    ///< of roots that are inner, in their order
  std::byte* root_leaves;  ///< of roots that are leaves
  WideNode* nodes;
  std::byte* leaves;
  std::uint32_t node_count, leaf_units;
  std::uint32_t first_node, first_leaf;  ///< their places in the tree, once they are known
  std::uint32_t depth;                   ///< in wide nodes, inner roots being the first
};

/// BinaryNode::info of a treelet in the tree above, which cannot be opened; `first` is its index.
inline constexpr std::uint32_t kTreeletInfo = 0xffffffffu;

inline bool is_treelet(const BinaryNode& node) {
  return node.info == kTreeletInfo;
}

/// Runs of items as they stand in Morton order, which a top tree parts as a whole.
struct Clusters {
  BinaryNode* cluster;   ///< box; first, info: run of sorted items
  std::uint32_t* ids;    ///< position → cluster
  std::uint32_t* moved;  ///< scratch of the same length
};

/// A range of Clusters::ids, with what is known of it.
struct ClusterRange {
  std::uint32_t begin, end;
  std::uint32_t items;  ///< in all its clusters
  WideBox centres;      ///< bounds of the centres; in v[3] minus the longest side of a box
};

/// The inner loops of the builders, compiled for one instruction set. They give the same tree in
/// each: only minima, sums and products in a fixed order.
struct BuildKernel {
  const char* name;
  /// Codes of items [begin, end); what is left out gets the code `left_out`. Returns how many were.
  std::uint32_t (*code)(const Items& items, const MortonGrid& grid, std::uint32_t begin,
                        std::uint32_t end, std::uint32_t left_out, KeyIndex<std::uint32_t>* out);
  /// Puts items on the desk behind those that are there.
  void (*load)(const Items& items, const std::uint32_t* indices, std::uint32_t count,
               Treelet& treelet);
  /// The same without what is known of triangles' corners.
  void (*load_boxes)(const Items& items, const std::uint32_t* indices, std::uint32_t count,
                     Treelet& treelet);
  /// Builds leaves, and what is above them without its boxes, by the codes of the items (sorted).
  void (*linear)(LeafLimit limit, float largest_leaf, Treelet& treelet);
  /// Builds by the surface-area heuristic. `scale`: 1 / a length typical of the tree.
  void (*sah)(LeafLimit limit, float scale, Treelet& treelet);
  /// Items and centres of a range.
  void (*measure)(const Clusters& clusters, ClusterRange& range);
  /// Parts a range by the surface-area heuristic, or in halves; both parts are not empty.
  void (*split)(const Clusters& clusters, float scale, bool in_halves, const ClusterRange& range,
                ClusterRange* left, ClusterRange* right);
  /// The box of a range.
  void (*bound)(const Clusters& clusters, const ClusterRange& range, WideBox* box);
  /// Boxes of a wide node's children onto its grid (bvh/quantise.h).
  void (*quantise)(const BinaryNode* nodes, const std::uint32_t* children, int count,
                   WideNode& wide);
  /// Makes wide nodes and leaves of what was built; areas are measured in units of 1 / scale².
  void (*emit_treelet)(const Items& items, float scale, Treelet& treelet, WideTreelet& to);
  /// The same for a planned tree of any size.
  void (*emit_tree)(const Items& items, const BinaryTree& tree, WideTreelet& to);
};

/// The kernel that suits this machine (as for rays, see bvh/kernel.h).
const BuildKernel& build_kernel();

}  // namespace komorebi
