#include "bvh/wide_tree.h"

#include <algorithm>
#include <stdexcept>

#include "bvh/grove.h"
#include "bvh/topology_tree.h"

namespace komorebi {
namespace {

WideTree grow_by(const Items& items, Builder builder, ThreadPool& pool, const Cancel& cancel) {
  if (builder == Builder::kLinear) return grow_linear(items, pool, cancel);
  if (builder == Builder::kSah) return grow_sah(items, pool, cancel);
  std::uint32_t left_out = 0;
  const BinaryTree tree = grow_from_topology(items, builder, cancel, &left_out);
  WideTree wide;
  if (tree.item_count > 0) {
    Grove grove(items, 1, 1.0f, pool, cancel);
    grove.transplant(tree);
    wide = grove.finish();
  }
  wide.left_out = left_out;
  return wide;
}

}  // namespace

WideTree build_wide_tree(const Items& items, Builder builder, ThreadPool& pool,
                         const Cancel& cancel) {
  if (items.count() > kMaxItems) {
    throw std::invalid_argument("a tree holds at most " + std::to_string(kMaxItems) +
                                " items, not " + std::to_string(items.count()));
  }
  check(cancel);
  WideTree wide = grow_by(items, builder, pool, cancel);
  if (wide.nodes.empty() && items.are_triangles()) {
    wide.clusters = LateArray<std::byte>(kClusterSlack);
    std::fill_n(wide.clusters.room(), kClusterSlack, std::byte{0});
    wide.clusters.end_at(kClusterSlack);
  }
  return wide;
}

}  // namespace komorebi
