#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "bvh/items.h"
#include "bvh/triangle_cluster.h"
#include "bvh/wide_plan.h"
#include "bvh/wide_tree.h"
#include "core/aabb.h"

namespace komorebi::testing {

/// The surface-area heuristic as the textbooks have it (Wald 2007; PBRT §7.3): top-down, 32 bins on
/// each axis over the bounds of the centres, cost area × items, one thread, readable before fast. A
/// leaf is whatever fits into one, and the wide tree is the cheapest one over the binary tree. What
/// the quick builder is measured by; not made for bad meshes.
class SahReference {
 public:
  explicit SahReference(const Items& items) : items_(items) {
    for (std::uint32_t i = 0; i < items.count(); ++i) {
      if (!items.is_left_out(i)) order_.push_back(i);
    }
    for (std::uint32_t i = 0; i < items.count(); ++i) boxes_.push_back(items.box(i));
  }

  /// Cost of the wide tree: kNodeCost × area of each wide node + kLeafCost × area of each leaf, in
  /// units of the root's area.
  double cost() {
    Aabb all;
    for (const std::uint32_t i : order_) all = united(all, boxes_[i]);
    return double(build(0, order_.size()).at[0]) / double(half_area(all));
  }

 private:
  static constexpr int kBins = 32;

  PlanCost build(std::size_t begin, std::size_t end) {
    Aabb box, centres;
    for (std::size_t i = begin; i < end; ++i) {
      box = united(box, boxes_[order_[i]]);
      const Vec3 c = centre(boxes_[order_[i]]);
      centres = united(centres, Aabb{c, c});
    }
    if (fits(begin, end)) return plan_leaf(half_area(box));
    const std::size_t middle = split(begin, end, centres);
    const PlanCost left = build(begin, middle), right = build(middle, end);
    PlanCost cost;
    plan_inner(half_area(box), left, right, &cost);
    return cost;
  }

  bool fits(std::size_t begin, std::size_t end) const {
    if (end - begin > items_.leaf.items) return false;
    std::vector<std::uint32_t> vertices;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        vertices.push_back(items_.tri2vtx[3 * std::size_t{order_[i]} + k]);
      }
    }
    std::sort(vertices.begin(), vertices.end());
    const auto last = std::unique(vertices.begin(), vertices.end());
    return static_cast<std::uint32_t>(last - vertices.begin()) <= items_.leaf.vertices;
  }

  std::size_t split(std::size_t begin, std::size_t end, const Aabb& centres) {
    const auto bin = [&](std::uint32_t item, int axis) {
      const float side = centres.hi[axis] - centres.lo[axis];
      const float place = (centre(boxes_[item])[axis] - centres.lo[axis]) / side;
      return std::min(static_cast<int>(place * float(kBins)), kBins - 1);
    };
    float best = kFloatMax;
    int best_axis = -1, best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centres.hi[axis] > centres.lo[axis])) continue;
      Aabb box[kBins];
      std::size_t count[kBins] = {};
      for (std::size_t i = begin; i < end; ++i) {
        const int k = bin(order_[i], axis);
        box[k] = united(box[k], boxes_[order_[i]]);
        ++count[k];
      }
      for (int plane = 1; plane < kBins; ++plane) {
        Aabb left, right;
        std::size_t on_left = 0, on_right = 0;
        for (int k = 0; k < plane; ++k) left = united(left, box[k]), on_left += count[k];
        for (int k = plane; k < kBins; ++k) right = united(right, box[k]), on_right += count[k];
        if (on_left == 0 || on_right == 0) continue;
        const float cost = half_area(left) * float(on_left) + half_area(right) * float(on_right);
        if (cost < best) best = cost, best_axis = axis, best_bin = plane;
      }
    }
    if (best_axis < 0) return begin + (end - begin) / 2;
    const auto middle =
        std::partition(order_.begin() + std::ptrdiff_t(begin), order_.begin() + std::ptrdiff_t(end),
                       [&](std::uint32_t item) { return bin(item, best_axis) < best_bin; });
    return static_cast<std::size_t>(middle - order_.begin());
  }

  const Items& items_;
  std::vector<Aabb> boxes_;
  std::vector<std::uint32_t> order_;
};

/// Calls visit(box, is_leaf) with the exact box of every wide node and leaf, and returns the
/// node's.
template <class Visit>
Aabb visit_boxes(const WideTree& tree, const Visit& visit, std::uint32_t index = 0) {
  const WideNode& node = tree.nodes[index];
  Aabb all;
  for (int i = 0; i < node.child_count(); ++i) {
    Aabb box;
    if (i < node.inner_count()) {
      box = visit_boxes(tree, visit, node.child_node(i));
    } else {
      const ClusterView leaf(tree.clusters.data() + node.child_leaf(i) * kClusterUnit);
      for (std::uint32_t k = 0; k < leaf.triangle_count(); ++k) {
        box = united(
            box, triangle_bounds(leaf.position(k, 0), leaf.position(k, 1), leaf.position(k, 2)));
      }
      visit(box, true);
    }
    all = united(all, box);
  }
  visit(all, false);
  return all;
}

/// The same cost of a tree over triangles that a builder made, but not in units of the root's area:
/// that of all nodes and leaves whose boxes lie within `bounds`.
inline double wide_cost_within(const WideTree& tree, const Aabb& bounds) {
  double cost = 0.0;
  visit_boxes(tree, [&](const Aabb& box, bool is_leaf) {
    if (contains(bounds, box)) cost += double(half_area(box) * (is_leaf ? kLeafCost : kNodeCost));
  });
  return cost;
}

inline double wide_cost(const WideTree& tree) {
  return wide_cost_within(tree, tree.bounds) / double(half_area(tree.bounds));
}

}  // namespace komorebi::testing
