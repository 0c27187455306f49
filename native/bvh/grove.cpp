#include "bvh/grove.h"

#include <algorithm>

namespace komorebi {

Grove::Grove(std::uint32_t item_count, float scale) : scale_(scale) {
  tree_.item_count = item_count;
  tree_.order = Scratch<std::uint32_t>(item_count);
  tree_.nodes = Scratch<BinaryNode>(2 * std::size_t{item_count});
}

float Grove::area(const BinaryNode& node) const {
  const float x = (-node.minus_hi[0] - node.lo[0]) * scale_;
  const float y = (-node.minus_hi[1] - node.lo[1]) * scale_;
  const float z = (-node.minus_hi[2] - node.lo[2]) * scale_;
  return x * y + y * z + z * x;
}

void Grove::plant(Treelet& t, std::uint32_t position, BinaryNode* root, PlanCost* cost) {
  // The root goes elsewhere: local node i > 0 stands at base + i − 1.
  const std::uint32_t base = claim(t.node_count - 1);
  for (std::uint32_t i = t.node_count; i-- > 0;) {
    BinaryNode node = t.nodes[i];
    if (node.is_leaf()) {
      t.cost[i] = plan_leaf(area(node));
      node.first += position;
    } else {
      node.info = plan_inner(area(node), t.cost[node.first], t.cost[node.first + 1], &t.cost[i]);
      node.first += base - 1;
    }
    (i > 0 ? tree_.nodes[base + i - 1] : *root) = node;
  }
  *cost = t.cost[0];
  for (std::uint32_t i = 0; i < t.count; ++i) tree_.order[position + i] = t.item[t.ids[i]];
}

PlanCost Grove::finish(std::uint32_t index, const std::vector<BinaryNode>& roots,
                       const std::vector<PlanCost>& costs) {
  BinaryNode& node = tree_.nodes[index];
  if (node.info == kTreelet) {
    const std::uint32_t treelet = node.first;
    node = roots[treelet];
    return costs[treelet];
  }
  const PlanCost left = finish(node.first, roots, costs);
  const PlanCost right = finish(node.first + 1, roots, costs);
  const BinaryNode& a = tree_.nodes[node.first];
  const BinaryNode& b = tree_.nodes[node.first + 1];
  for (int axis = 0; axis < 3; ++axis) {
    node.lo[axis] = min_of(a.lo[axis], b.lo[axis]);
    node.minus_hi[axis] = min_of(a.minus_hi[axis], b.minus_hi[axis]);
  }
  PlanCost cost;
  node.info = plan_inner(area(node), left, right, &cost);
  return cost;
}

BinaryTree Grove::finish(const std::vector<BinaryNode>& roots, const std::vector<PlanCost>& costs) {
  if (tree_.item_count > 0) finish(0, roots, costs);
  return std::move(tree_);
}

}  // namespace komorebi
