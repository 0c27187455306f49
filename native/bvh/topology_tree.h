#pragma once

#include "bvh/binary_tree.h"
#include "bvh/items.h"
#include "bvh/topology.h"

namespace komorebi {

/// A planned binary tree by one of the builders that see boxes alone (bvh/topology.h); one thread.
/// `left_out` counts the items in no leaf. @throws Cancelled
BinaryTree grow_from_topology(const Items& items, Builder builder, const Cancel& cancel,
                              std::uint32_t* left_out);

}  // namespace komorebi
