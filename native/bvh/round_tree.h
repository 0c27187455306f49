#pragma once

#include <vector>

#include "bvh/topology.h"
#include "bvh/wide_node.h"
#include "core/round_leaf.h"
#include "core/scene_view.h"
#include "parallel/array.h"
#include "parallel/late_array.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// A set of curves or points as traversal reads it: wide nodes whose leaves are each one item
/// (CurveItem, or a point). Keys and points are read where they are. Of a set that deforms there
/// is such a tree for each of some even parts of the shutter's time (count_time_parts), whose boxes
/// and capsules hold an item for all of that part.
struct RoundTree {
  struct Part {
    LateArray<WideNode> nodes;
    Array<RoundLeaf> leaves;
    std::uint32_t depth = 0;
  };
  std::vector<Part> parts;      ///< one, if nothing moves
  std::vector<TimeTree> views;  ///< of them
  LeafGrid grid;
  Aabb bounds;  ///< of all padded boxes, local space; empty if there is nothing to hit

  std::size_t node_count() const;
  std::uint32_t depth() const;
  std::size_t byte_count() const;
};

/// @param set  everything but its tree
/// @throws Cancelled; std::invalid_argument for too many items
RoundTree build_round_tree(const MeshView& set, Builder builder, ThreadPool& pool,
                           const Cancel& cancel);

}  // namespace komorebi
