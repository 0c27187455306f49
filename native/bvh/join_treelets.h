#pragma once

#include "bvh/treelet.h"
#include "bvh/treelet_row.h"
#include "bvh/wide_tree.h"

namespace komorebi {

/// The wide tree of treelets, which stand in a row, and the planned binary tree that stands over
/// them. @throws std::invalid_argument for too many items
WideTree join_treelets(const Items& items, const BinaryNode* top, const WideTreelet* treelets,
                       TreeletRow& row);

}  // namespace komorebi
