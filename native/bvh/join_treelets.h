#pragma once

#include "bvh/treelet.h"
#include "bvh/wide_tree.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// The wide tree of treelets and the planned binary tree that stands over them.
/// @throws Cancelled, std::invalid_argument for too many items
WideTree join_treelets(const Items& items, const BinaryNode* top, const WideTreelet* treelets,
                       ThreadPool& pool, const Cancel& cancel);

}  // namespace komorebi
