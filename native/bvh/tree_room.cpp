#include "bvh/tree_room.h"

#include "bvh/treelet.h"
#include "parallel/pages.h"

namespace komorebi {
namespace {

/// Trees take more than that for each item.
constexpr std::size_t kLeastNodeBytes = 6, kLeastClusterBytes = 16;

}  // namespace

TreeRoom::TreeRoom(const Items& items, ThreadPool& pool, FunctionRef<void()> meanwhile)
    // Each node but the root has two children at least.
    : nodes(items.count() + 1) {
  std::byte* leaves = nullptr;
  if (items.are_triangles()) {
    clusters = LateArray<std::byte>(items.count() * kLeafBytes + kClusterSlack);
    leaves = clusters.room();
    leaves_backed = kLeastClusterBytes * items.count() / kHugePage;
  } else {
    box_leaves = LateArray<std::uint32_t>(items.count());
    leaves = reinterpret_cast<std::byte*>(box_leaves.room());
    leaves_backed = sizeof(std::uint32_t) * items.count() / kHugePage;
  }
  nodes_backed = kLeastNodeBytes * items.count() / kHugePage;
  pool.for_each_chunk(1 + nodes_backed + leaves_backed, 1, [&](std::size_t i, std::size_t) {
    if (i == 0) return meanwhile();
    const std::size_t page = i - 1;
    std::byte* const at = page < nodes_backed
                              ? reinterpret_cast<std::byte*>(nodes.room()) + page * kHugePage
                              : leaves + (page - nodes_backed) * kHugePage;
    *static_cast<volatile std::byte*>(at) = std::byte{0};
  });
}

}  // namespace komorebi
