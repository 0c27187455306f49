#pragma once

#include <cstddef>
#include <cstdint>

#include "bvh/binary_tree.h"
#include "bvh/items.h"
#include "bvh/morton_grid.h"
#include "bvh/strip.h"
#include "bvh/triangle_cluster.h"
#include "bvh/wide_node.h"
#include "bvh/wide_plan.h"
#include "parallel/radix_sort.h"

namespace komorebi {

/// Runs of the Morton order that a worker takes at once: their boxes and nodes stay in its nearest
/// cache.
inline constexpr std::uint32_t kRunSize = 1024;
/// Most triangles on a desk: they stay in the next cache.
inline constexpr std::uint32_t kTreeletSize = 4096;
static_assert(kRunSize * kMostInStrip <= kTreeletSize);

/// Eight floats: the low corner and the negated high corner, each with a lane to spare.
struct alignas(32) WideBox {
  float v[8];
};

/// A leaf takes no more for each of its items, and no more in all.
inline constexpr std::size_t kLeafBytes = std::size_t{ClusterView::units(1, 3)} * kClusterUnit;
inline constexpr std::size_t kLeafMostBytes = std::size_t{ClusterView::units(8, 8)} * kClusterUnit;
/// So many bytes are copied of any leaf, whatever stands behind it.
inline constexpr std::size_t kLeafCopied = (kLeafMostBytes + 63) / 64 * 64;

/// What is read or written behind the last value, as lanes are.
inline constexpr std::uint32_t kBehindDesk = 16;
/// So many triangles are asked for before they are read.
inline constexpr std::uint32_t kFetchedAhead = 32;

/// One worker's desk: triangles, which come as strips, and the tree over them.
struct Treelet {
  std::uint32_t count = 0;  ///< of items: strips, or instances
  std::uint32_t triangle_count = 0;
  std::uint32_t node_count = 0;
  // Per triangle; of instances only `primitive` and `triangle_box`.
  alignas(16) std::uint32_t corner[kTreeletSize + kBehindDesk][4];  ///< vertices, and kNone
  WideBox triangle_box[kTreeletSize];
  std::uint32_t primitive[kTreeletSize + kFetchedAhead];
  std::uint32_t code[kTreeletSize + kBehindDesk];  ///< of its strip; where there are codes
  // Per item.
  std::uint32_t start[kTreeletSize];      ///< its first triangle
  std::uint32_t triangles[kTreeletSize];  ///< how many it has
  WideBox box[kTreeletSize];
  /// And minus the longest side, whose two last bits are triangles − 1. By sah_treelet().
  alignas(16) float centre[kTreeletSize][4];
  std::uint64_t vertex_bits[kTreeletSize];  ///< of its vertices' hashes
  /// Position → item. Not a multiple of 4 KiB from `moved`: stores to one of them would hold up
  /// loads from the other.
  std::uint32_t ids[kTreeletSize + kBehindDesk];
  std::uint32_t moved[kTreeletSize];
  BinaryNode nodes[2 * kTreeletSize];  ///< local: children and leaf positions from 0
  PlanCost cost[2 * kTreeletSize];
  // By pack_treelet().
  WideNode staged[kTreeletSize];
  std::byte staged_leaves[kTreeletSize * kLeafBytes + kLeafCopied];
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

/// BinaryNode::info of a cluster: up to four strips (bvh/strip.h), of which some are one item with
/// the strip before them.
struct ClusterInfo {
  std::uint32_t strips, joined, triangles;  ///< joined: bit k for strip k

  explicit ClusterInfo(std::uint32_t info)
      : strips(info & 15u), joined(info >> 4 & 15u), triangles(info >> 8) {}
  ClusterInfo(std::uint32_t s, std::uint32_t j, std::uint32_t t)
      : strips(s), joined(j), triangles(t) {}
  std::uint32_t packed() const { return strips | joined << 4 | triangles << 8; }
};

/// Runs of items as they stand in Morton order, which a top tree parts as a whole.
struct Clusters {
  BinaryNode* cluster;  ///< box; first: of its run of strips; info: ClusterInfo
  BinaryNode* moved;    ///< scratch of the same length
};

/// A range of clusters, with what is known of it.
struct ClusterRange {
  std::uint32_t begin, end;
  std::uint32_t triangles;  ///< in all its clusters
  WideBox centres;          ///< bounds of the centres; in v[3] minus the longest side of a box
};

struct ClusterLimits {
  float largest_area;  ///< of one that has more than one strip
  float scale;         ///< as for BuildKernel::sah_treelet
};

struct StripCount {
  std::uint32_t strips;
  std::uint32_t left_out;  ///< items that no ray can meet: they are in none
};

/// The inner loops of the builders, compiled for one instruction set. They give the same tree in
/// each: only minima, sums and products in a fixed order.
struct BuildKernel {
  const char* name;
  /// Strips of items [begin, end) with their codes; `begin` decides which they are, and `out` has
  /// room for one of each item.
  StripCount (*code_30)(const Items& items, const MortonGrid& grid, std::uint32_t begin,
                        std::uint32_t end, KeyIndex<std::uint32_t>* out);
  StripCount (*code_63)(const Items& items, const MortonGrid& grid, std::uint32_t begin,
                        std::uint32_t end, KeyIndex<std::uint64_t>* out);
  /// Puts strips on the desk, and their triangles. A key other than null makes a strip one item
  /// with that before it.
  void (*load)(const Items& items, const KeyIndex<std::uint32_t>* strips, std::uint32_t count,
               Treelet& treelet);
  /// The same for pack_treelet(), without boxes: keys are codes of 31 bits, each strip is an item.
  void (*load_corners)(const Items& items, const KeyIndex<std::uint32_t>* strips,
                       std::uint32_t count, Treelet& treelet);
  /// Cuts strips, whose keys are codes, into clusters of up to four neighbours, `first` being the
  /// place of the first strip. Returns how many.
  std::uint32_t (*cluster)(const Items& items, const KeyIndex<std::uint32_t>* strips,
                           std::uint32_t count, const ClusterLimits& limits, std::uint32_t first,
                           Treelet& treelet, BinaryNode* clusters);
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
  /// Makes wide nodes and leaves of what is on the desk, by its codes (sorted). Areas are measured
  /// in units of 1 / scale², the length being typical of the tree.
  void (*pack_treelet)(const Items& items, float scale, Treelet& treelet, WideTreelet& to);
  /// The same by the surface-area heuristic.
  void (*sah_treelet)(const Items& items, float scale, Treelet& treelet, WideTreelet& to);
  /// The same of a planned tree of any size.
  void (*emit_tree)(const Items& items, const BinaryTree& tree, WideTreelet& to);
};

/// The kernel that suits this machine (as for rays, see bvh/kernel.h).
const BuildKernel& build_kernel();

}  // namespace komorebi
