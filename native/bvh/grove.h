#pragma once

#include <atomic>
#include <optional>

#include "bvh/treelet.h"
#include "bvh/treelet_row.h"
#include "bvh/wide_tree.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// A wide tree in the making: workers build treelets in any order, each to the end while it is in
/// their caches, and a binary tree stands over them. The finished tree does not depend on that
/// order, but on the treelets' indices.
class Grove {
 public:
  /// @param most_treelets  that can be marked
  /// @param scale  areas are measured in units of 1 / scale²
  Grove(const Items& items, std::uint32_t most_treelets, float scale, ThreadPool& pool,
        const Cancel& cancel);

  /// Room for nodes of the top tree that stand together; thread-safe. Node 0 is taken.
  std::uint32_t claim(std::uint32_t nodes) { return next_.fetch_add(nodes); }
  BinaryNode& node(std::uint32_t index) { return nodes_[index]; }

  /// Makes a node of the top tree the root of a treelet.
  void mark_treelet(std::uint32_t node, std::uint32_t index) {
    nodes_[node].first = index;
    nodes_[node].info = kTreeletInfo;
  }

  /// Plans the top before the treelets have grown; to be called when all its nodes, treelets too,
  /// have their boxes. Then treelets give as many roots to the wide nodes above them as pays.
  void plan_top(std::uint32_t treelets);

  /// All treelets: `load(index, desk)` puts its items on the desk, `make` is the kernel's function
  /// that makes nodes of them, which come to stand in `room`. @throws Cancelled
  void grow(std::uint32_t treelets, FunctionRef<void(std::uint32_t, Treelet&)> load,
            void (*make)(const Items&, float, Treelet&, WideTreelet&), TreeRoom room);

  /// One treelet from a whole planned tree, of any size.
  void transplant(const BinaryTree& tree);

  /// When all have grown: the wide tree. @throws Cancelled, std::invalid_argument: too many items
  WideTree finish();

 private:
  void prepare(std::uint32_t treelets);
  PlanCost plan(std::uint32_t node);
  void give_rooms(std::uint32_t node);

  const Items& items_;
  float scale_;
  ThreadPool& pool_;
  const Cancel& cancel_;
  const BuildKernel& kernel_;
  Scratch<BinaryNode> nodes_;
  std::atomic<std::uint32_t> next_{1};
  bool is_planned_ = false;
  Scratch<WideTreelet> treelets_;
  std::optional<TreeletRow> row_;
};

}  // namespace komorebi
