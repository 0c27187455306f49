#include "bvh/grove.h"

#include <algorithm>

#include "bvh/join_treelets.h"

namespace komorebi {
namespace {

/// What a treelet costs less where it may be a forest of i + 1 nodes, in units of its root's area:
/// about the mean of those of scanned and of built meshes.
constexpr float kGain[kPlanWidth - 1] = {0.0f, 0.3f, 0.4f, 0.5f, 0.6f, 0.65f, 0.7f};

}  // namespace

Grove::Grove(const Items& items, std::uint32_t most_treelets, float scale, ThreadPool& pool,
             const Cancel& cancel)
    : items_(items),
      scale_(scale),
      pool_(pool),
      cancel_(cancel),
      kernel_(build_kernel()),
      nodes_(2 * std::size_t{most_treelets}) {}

void Grove::prepare(std::uint32_t treelets) {
  treelets_ = Scratch<WideTreelet>(treelets);
  for (WideTreelet& treelet : treelets_) treelet.room = 1;
}

void Grove::plan_top(std::uint32_t treelets) {
  prepare(treelets);
  is_planned_ = true;
  plan(0);
  if (!is_treelet(nodes_[0])) give_rooms(0);
}

/// Boxes and plans of what is above the treelets.
PlanCost Grove::plan(std::uint32_t index) {
  BinaryNode& node = nodes_[index];
  const auto area = [&] {
    const Aabb box = node.box();
    return half_area(Aabb{box.lo * scale_, box.hi * scale_});
  };
  if (is_treelet(node)) {
    const WideTreelet& treelet = treelets_[node.first];
    if (!is_planned_) {
      std::copy_n(treelet.root[0].lo, 3, node.lo);
      std::copy_n(treelet.root[0].minus_hi, 3, node.minus_hi);
      return plan_closed(treelet.cost);
    }
    // What it costs as one node is part of all sums, and so decides nothing.
    PlanCost cost = plan_closed(0.0f);
    for (int i = 0; i < kPlanWidth - 1; ++i) cost.at[i] = -kGain[i] * area();
    return cost;
  }
  const PlanCost left = plan(node.first);
  const PlanCost right = plan(node.first + 1);
  const BinaryNode& a = nodes_[node.first];
  const BinaryNode& b = nodes_[node.first + 1];
  for (int axis = 0; axis < 3; ++axis) {
    node.lo[axis] = min_of(a.lo[axis], b.lo[axis]);
    node.minus_hi[axis] = min_of(a.minus_hi[axis], b.minus_hi[axis]);
  }
  PlanCost cost;
  node.info = plan_inner(area(), left, right, &cost);
  return cost;
}

/// For the wide node that stands for `node`, and for all below it.
void Grove::give_rooms(std::uint32_t node) {
  const Vec3 step = step_of(nodes_[node]);
  OpenNodes open(nodes_.data());
  open.push_wide(node);
  std::uint32_t child = 0;
  int room = 0;
  while (open.pop(step, &child, &room)) {
    if (!is_treelet(nodes_[child])) {
      give_rooms(child);
    } else {
      treelets_[nodes_[child].first].room = static_cast<std::uint32_t>(room);
      treelets_[nodes_[child].first].step = step;
    }
  }
}

void Grove::grow(std::uint32_t treelets, FunctionRef<void(std::uint32_t, Treelet&)> load,
                 void (*make)(const Items&, float, Treelet&, WideTreelet&), TreeRoom room) {
  if (!is_planned_) prepare(treelets);
  row_.emplace(items_, std::span(treelets_.data(), treelets), std::move(room));
  std::atomic<std::uint32_t> next{0};
  pool_.run(std::min(pool_.size(), treelets), [&](unsigned) {
    Scratch<Treelet> desk(1);
    Treelet& t = desk[0];
    for (std::uint32_t i = next++; i < treelets && !cancel_.raised(); i = next++) {
      load(i, t);
      TreeletRow::Shelf shelf = row_->take_shelf(i, t.triangle_count);
      make(items_, scale_, t, treelets_[i]);
      row_->put(i, std::move(shelf));
    }
  });
  check(cancel_);
}

void Grove::transplant(const BinaryTree& tree) {
  prepare(1);
  row_.emplace(items_, std::span(treelets_.data(), 1), TreeRoom(items_));
  TreeletRow::Shelf shelf = row_->take_shelf(0, tree.item_count);
  kernel_.emit_tree(items_, tree, treelets_[0]);
  row_->put(0, std::move(shelf));
  mark_treelet(0, 0);
}

WideTree Grove::finish() {
  if (!is_planned_) plan(0);
  return join_treelets(items_, nodes_.data(), treelets_.data(), *row_);
}

}  // namespace komorebi
