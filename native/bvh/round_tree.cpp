#include "bvh/round_tree.h"

#include "bvh/wide_tree.h"

namespace komorebi {

TreeView RoundTree::view() const {
  return TreeView{nodes.data(), static_cast<std::uint32_t>(nodes.size()), depth};
}

std::size_t RoundTree::byte_count() const {
  return nodes.byte_count() + leaves.capacity() * sizeof(RoundLeaf);
}

RoundTree build_round_tree(const MeshView& set, Builder builder, ThreadPool& pool,
                           const Cancel& cancel) {
  constexpr std::size_t kGrain = 1 << 13;
  const bool are_curves = set.kind == PrimitiveKind::kCurve;
  const std::size_t count = std::size_t{set.primitive_count} * (are_curves ? set.segment_parts : 1);
  Array<Aabb> boxes(count);
  pool.for_each_chunk(count, kGrain, [&](std::size_t begin, std::size_t end) {
    check(cancel);
    for (std::size_t i = begin; i < end; ++i) {
      const auto item = static_cast<std::uint32_t>(i);
      boxes[i] = are_curves ? curve_bounds(set, curve_item(set, item)) : sphere_bounds(set, item);
    }
  });
  const Items items{{}, {}, boxes, {1, kNone}};
  WideTree wide = build_wide_tree(items, builder, pool, cancel);
  RoundTree tree;
  tree.nodes = std::move(wide.nodes);
  tree.depth = wide.depth;
  tree.bounds = wide.bounds;
  tree.grid = make_leaf_grid(wide.bounds);
  MeshView with_grid = set;
  with_grid.leaf_grid = tree.grid;
  tree.leaves.resize(wide.leaves.size());
  pool.for_each_chunk(tree.leaves.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    check(cancel);
    for (std::size_t i = begin; i < end; ++i) {
      tree.leaves[i] = make_round_leaf(with_grid, wide.leaves.data()[i]);
    }
  });
  return tree;
}

}  // namespace komorebi
