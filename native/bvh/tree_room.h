#pragma once

#include "bvh/items.h"
#include "bvh/wide_node.h"
#include "parallel/function_ref.h"
#include "parallel/late_array.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// Memory for a wide tree in the making, as much as it may get. What any tree takes is backed by
/// all workers at once, the rest when it is needed.
struct TreeRoom {
  LateArray<WideNode> nodes;
  LateArray<std::byte> clusters;        ///< of triangles…
  LateArray<std::uint32_t> box_leaves;  ///< …or of instances
  std::size_t nodes_backed = 0, leaves_backed = 0;  ///< huge pages

  /// @param meanwhile  what one of the workers is to do besides
  TreeRoom(const Items& items, ThreadPool& pool, FunctionRef<void()> meanwhile);
};

}  // namespace komorebi
