#include "bvh/tree_room.h"

#include "bvh/treelet.h"
#include "parallel/first_touch.h"

namespace komorebi {
namespace {

/// Trees take more than that for each item.
constexpr std::size_t kLeastNodeBytes = 6, kLeastClusterBytes = 16;

}  // namespace

TreeRoom::TreeRoom(const Items& items)
    // Each node but the root has two children at least.
    : nodes(items.count() + 1), item_count_(items.count()) {
  if (items.are_triangles()) {
    clusters = LateArray<std::byte>(item_count_ * kLeafBytes + kClusterSlack);
  } else {
    box_leaves = LateArray<std::uint32_t>(item_count_);
  }
}

std::span<std::byte> TreeRoom::leaves() {
  if (clusters.room() != nullptr) return {clusters.room(), item_count_ * kLeafBytes};
  return std::as_writable_bytes(std::span(box_leaves.room(), item_count_));
}

void TreeRoom::back(ThreadPool& pool, FunctionRef<void()> meanwhile) {
  nodes_backed = kLeastNodeBytes * item_count_ / kHugePage;
  const std::size_t least = clusters.room() != nullptr ? kLeastClusterBytes : sizeof(std::uint32_t);
  leaves_backed = least * item_count_ / kHugePage;
  void* const leaf_room = leaves().data();
  pool.for_each_chunk(1 + nodes_backed + leaves_backed, 1, [&](std::size_t i, std::size_t) {
    if (i == 0) {
      meanwhile();
    } else if (i <= nodes_backed) {
      touch_page(nodes.room(), i - 1);
    } else {
      touch_page(leaf_room, i - 1 - nodes_backed);
    }
  });
}

}  // namespace komorebi
