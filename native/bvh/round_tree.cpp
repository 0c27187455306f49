#include "bvh/round_tree.h"

#include <algorithm>

#include "bvh/time_parts.h"
#include "bvh/wide_tree.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = 1 << 13;

Aabb item_bounds(const MeshView& set, std::size_t i, const MotionPlace& time) {
  const auto item = static_cast<std::uint32_t>(i);
  return set.kind == PrimitiveKind::kCurve ? curve_bounds(set, curve_item(set, item), time)
                                           : sphere_bounds(set, item, time);
}

/// Contains an item's padded box at every time of a part: see curve_bounds. What rounding takes
/// from that is less than the padding again.
Aabb box_over(const MeshView& set, std::size_t item, const TimePart& part) {
  Aabb box;
  for (const MotionPlace& time : part.times) box = united(box, item_bounds(set, item, time));
  return box.is_empty() ? box : padded(box, max_abs(box) * kPadding);
}

std::size_t item_count(const MeshView& set) {
  const bool are_curves = set.kind == PrimitiveKind::kCurve;
  return std::size_t{set.primitive_count} * (are_curves ? set.segment_parts : 1);
}

std::vector<TimePart> time_parts(const MeshView& set) {
  if (set.position_sets == 1) return {TimePart{{kAtRest}, 0, 0}};
  const std::uint32_t count = count_time_parts(
      item_count(set), set.position_sets,
      [&](std::size_t i, const TimePart& part) { return box_over(set, i, part); },
      [&](std::size_t i, const MotionPlace& time) { return item_bounds(set, i, time); });
  std::vector<TimePart> parts;
  for (std::uint32_t k = 0; k < count; ++k) parts.push_back(time_part(set.position_sets, k, count));
  return parts;
}

}  // namespace

std::size_t RoundTree::node_count() const {
  std::size_t sum = 0;
  for (const Part& part : parts) sum += part.nodes.size();
  return sum;
}

std::uint32_t RoundTree::depth() const {
  std::uint32_t most = 0;
  for (const Part& part : parts) most = std::max(most, part.depth);
  return most;
}

std::size_t RoundTree::byte_count() const {
  std::size_t sum = 0;
  for (const Part& part : parts) {
    sum += sizeof(Part) + part.nodes.byte_count() + part.leaves.capacity() * sizeof(RoundLeaf);
  }
  return sum + views.size() * sizeof(TimeTree);
}

RoundTree build_round_tree(const MeshView& set, Builder builder, ThreadPool& pool,
                           const Cancel& cancel) {
  const std::vector<TimePart> parts = time_parts(set);
  const bool moves = set.position_sets > 1;
  RoundTree tree;
  std::vector<LateArray<std::uint32_t>> items;
  Array<Aabb> boxes(item_count(set));
  for (const TimePart& part : parts) {
    pool.for_each_chunk(boxes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      check(cancel);
      for (std::size_t i = begin; i < end; ++i) {
        boxes[i] = moves ? box_over(set, i, part) : item_bounds(set, i, kAtRest);
      }
    });
    WideTree wide = build_wide_tree({{}, {}, boxes, {1, kNone}}, builder, pool, cancel);
    tree.bounds = united(tree.bounds, wide.bounds);
    tree.parts.push_back({std::move(wide.nodes), {}, wide.depth});
    items.push_back(std::move(wide.leaves));
  }
  tree.grid = make_leaf_grid(tree.bounds);
  MeshView with_grid = set;
  with_grid.leaf_grid = tree.grid;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::vector<MotionPlace>& times = parts[k].times;
    RoundTree::Part& part = tree.parts[k];
    part.leaves.resize(items[k].size());
    pool.for_each_chunk(part.leaves.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      check(cancel);
      for (std::size_t i = begin; i < end; ++i) {
        part.leaves[i] = make_round_leaf(with_grid, items[k].data()[i], times.data(), times.size());
      }
    });
  }
  for (const RoundTree::Part& part : tree.parts) {
    const auto count = static_cast<std::uint32_t>(part.nodes.size());
    tree.views.push_back({{part.nodes.data(), count, part.depth}, nullptr, part.leaves.data()});
  }
  return tree;
}

}  // namespace komorebi
