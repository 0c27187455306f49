#pragma once

#include <span>

#include "bvh/items.h"
#include "bvh/wide_node.h"
#include "parallel/function_ref.h"
#include "parallel/late_array.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// Memory for a wide tree in the making, as much as it may get: at first address space alone.
struct TreeRoom {
  LateArray<WideNode> nodes;
  LateArray<std::byte> clusters;                    ///< of triangles…
  LateArray<std::uint32_t> box_leaves;              ///< …or of instances
  std::size_t nodes_backed = 0, leaves_backed = 0;  ///< huge pages

  explicit TreeRoom(const Items& items);
  std::span<std::byte> leaves();
  /// Has what any tree takes backed by all workers at once, the rest when it is needed.
  /// @param meanwhile  what one of the workers is to do besides
  void back(ThreadPool& pool, FunctionRef<void()> meanwhile);

 private:
  std::size_t item_count_;
};

}  // namespace komorebi
