#pragma once

#include <span>
#include <vector>

#include "bvh/topology.h"
#include "bvh/wide_node.h"

namespace komorebi {

/// A run of positions in Topology::order.
struct LeafRange {
  std::uint32_t first;
  std::uint32_t count;
};

/// Wide nodes in breadth-first order (node 0 is the root, siblings are neighbours). Leaf children
/// name entries of `leaves` (WideNode::child_leaf).
struct WideTree {
  std::vector<WideNode> nodes;
  std::vector<LeafRange> leaves;
  std::uint32_t depth = 0;  ///< wide nodes on the longest way down, at most kMaxDepth
};

/// Eight children for two: opens, again and again, the inner child with the largest surface, for
/// that is the one a random ray visits most (Wald, Benthin, Boulos 2008). The same for any number
/// of threads.
///
/// @param is_leaf  per inner node of the topology: 1 if its subtree becomes one leaf, as then all
///                 subtrees of it could. Empty: only single items do.
WideTree collapse(const Topology& topology, std::span<const Aabb> boxes,
                  std::span<const std::uint8_t> is_leaf, ThreadPool& pool, const Cancel& cancel);

}  // namespace komorebi
