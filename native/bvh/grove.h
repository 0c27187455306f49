#pragma once

#include <atomic>
#include <vector>

#include "bvh/treelet.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// A binary tree in the making: treelets that workers finish in any order, and the tree over them.
/// Indices of nodes depend on that order; what they hold does not.
class Grove {
 public:
  /// @param scale  areas are measured in units of 1 / scale²
  Grove(std::uint32_t item_count, float scale);

  /// Room for nodes that stand together; thread-safe. Node 0 is taken.
  std::uint32_t claim(std::uint32_t nodes) { return next_.fetch_add(nodes); }
  BinaryNode& node(std::uint32_t index) { return tree_.nodes[index]; }

  /// The desk's tree becomes treelet `index`, over positions from `position` on; thread-safe.
  void plant(Treelet& treelet, std::uint32_t position, BinaryNode* root, PlanCost* cost);

  /// Marks a node of the top tree as the root of a treelet.
  void mark_treelet(std::uint32_t node, std::uint32_t index) {
    tree_.nodes[node].first = index;
    tree_.nodes[node].info = kTreelet;
  }

  /// When all is planted: puts the treelets' roots in place, and gives the top tree's nodes (from 0
  /// down) their boxes and plans.
  BinaryTree finish(const std::vector<BinaryNode>& roots, const std::vector<PlanCost>& costs);

 private:
  static constexpr std::uint32_t kTreelet = 0xffffffffu;

  PlanCost finish(std::uint32_t node, const std::vector<BinaryNode>& roots,
                  const std::vector<PlanCost>& costs);
  float area(const BinaryNode& node) const;

  float scale_;
  BinaryTree tree_;
  std::atomic<std::uint32_t> next_{1};
};

/// Binary trees with their plans (bvh/wide_plan.h); empty if every item is left out.
/// `left_out` counts those. @throws Cancelled
BinaryTree grow_linear(const Items& items, ThreadPool& pool, const Cancel& cancel,
                       std::uint32_t* left_out);
BinaryTree grow_sah(const Items& items, ThreadPool& pool, const Cancel& cancel,
                    std::uint32_t* left_out);

}  // namespace komorebi
