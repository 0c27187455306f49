#include "bvh/topology_tree.h"

#include <algorithm>

#include "bvh/wide_plan.h"

namespace komorebi {
namespace {

class TopologyGrower {
 public:
  explicit TopologyGrower(const Items& items) : items_(items) {}

  BinaryTree grow(Builder builder, const Cancel& cancel, std::uint32_t* left_out) {
    for (std::uint32_t i = 0; i < items_.count(); ++i) {
      if (items_.is_left_out(i)) continue;
      boxes_.push_back(items_.box(i));
      source_.push_back(i);
    }
    *left_out = static_cast<std::uint32_t>(items_.count() - boxes_.size());
    topology_ = build_topology(boxes_, builder, cancel);
    BinaryTree tree;
    if (boxes_.empty()) return tree;
    tree.item_count = static_cast<std::uint32_t>(boxes_.size());
    tree.order = Scratch<std::uint32_t>(boxes_.size());
    for (std::size_t i = 0; i < boxes_.size(); ++i) tree.order[i] = source_[topology_.order[i]];
    tree.nodes = Scratch<BinaryNode>(2 * boxes_.size());
    add(tree, 0, topology_.root);
    return tree;
  }

 private:
  PlanCost add(BinaryTree& tree, std::uint32_t index, std::uint32_t node) {
    BinaryNode& to = tree.nodes[index];
    const bool single = (node & kLeafBit) != 0;
    const std::uint32_t first = single ? node & ~kLeafBit : topology_.first[node];
    const std::uint32_t last = single ? first : topology_.last[node];
    to.set_box(single ? boxes_[topology_.order[first]] : topology_.bounds[node]);
    const float area = half_area(to.box());
    if (const std::uint32_t info = leaf_info(tree, first, last - first + 1); info != 0) {
      to.first = first;
      to.info = info;
      return plan_leaf(area);
    }
    const std::uint32_t child = next_;
    next_ += 2;
    to.first = child;
    const PlanCost left = add(tree, child, topology_.left[node]);
    const PlanCost right = add(tree, child + 1, topology_.right[node]);
    PlanCost cost;
    to.info = plan_inner(area, left, right, &cost);
    return cost;
  }

  /// BinaryNode::info of a leaf over the positions, or 0 if it would hold too much.
  std::uint32_t leaf_info(const BinaryTree& tree, std::uint32_t first, std::uint32_t count) const {
    if (count > items_.leaf.items) return 0;
    if (items_.leaf.vertices == kNone) return count;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t i = first; i < first + count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        vertices.push_back(items_.tri2vtx[3 * std::size_t{tree.order[i]} + k]);
      }
    }
    std::sort(vertices.begin(), vertices.end());
    const auto end = std::unique(vertices.begin(), vertices.end());
    const auto different = static_cast<std::uint32_t>(end - vertices.begin());
    return different <= items_.leaf.vertices ? count | different << 8 : 0;
  }

  const Items& items_;
  std::vector<Aabb> boxes_;            ///< of the items that are not left out
  std::vector<std::uint32_t> source_;  ///< which items these are
  Topology topology_;
  std::uint32_t next_ = 1;
};

}  // namespace

BinaryTree grow_from_topology(const Items& items, Builder builder, const Cancel& cancel,
                              std::uint32_t* left_out) {
  return TopologyGrower(items).grow(builder, cancel, left_out);
}

}  // namespace komorebi
