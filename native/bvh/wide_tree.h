#pragma once

#include <cstddef>

#include "bvh/items.h"
#include "bvh/topology.h"
#include "bvh/wide_node.h"
#include "parallel/late_array.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// Wide nodes (0 is the root, siblings are neighbours) and leaves as bvh/mesh_tree.h or
/// bvh/instance_tree.h have them.
struct WideTree {
  LateArray<WideNode> nodes;
  LateArray<std::byte> clusters;    ///< over triangles
  LateArray<std::uint32_t> leaves;  ///< over boxes: one item each
  std::uint32_t depth = 0;          ///< wide nodes on the longest way down, at most kMaxDepth
  std::uint32_t left_out = 0;       ///< items in no leaf
  Aabb bounds;
};

/// Builds over triangles or boxes; the same bytes for any number of threads.
/// @throws Cancelled, std::invalid_argument for too many items
WideTree build_wide_tree(const Items& items, Builder builder, ThreadPool& pool,
                         const Cancel& cancel);

/// The engine's own builders; the tree is empty if every item is left out.
WideTree grow_linear(const Items& items, ThreadPool& pool, const Cancel& cancel);
WideTree grow_sah(const Items& items, ThreadPool& pool, const Cancel& cancel);

}  // namespace komorebi
