#include "bvh/wide_tree.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "bvh/grove.h"
#include "bvh/topology_tree.h"

namespace komorebi {
namespace {

/// What the wide nodes below one of them take.
struct Need {
  std::uint64_t nodes = 0;   ///< without the node itself
  std::uint64_t leaves = 0;  ///< in kClusterUnit, or entries
  std::uint32_t depth = 1;   ///< with the node itself
};

/// A wide node on its way: what stands for it, and its place.
struct Job {
  std::uint32_t binary, node, level;
  Need need;
};

class Emission {
 public:
  Emission(const Items& items, const BinaryTree& tree, ThreadPool& pool, const Cancel& cancel)
      : items_(items),
        nodes_(tree.nodes.data()),
        order_(tree.order.data()),
        share_(std::max<std::uint32_t>(4096, tree.item_count / 256)),
        pool_(pool),
        cancel_(cancel) {}

  /// Two passes: what every job needs, and then, as all places are known, the nodes themselves.
  WideTree run() {
    descend();
    pool_.for_each_chunk(jobs_.size(), 1, [&](std::size_t i, std::size_t) {
      if (!cancel_.raised()) jobs_[i].need = below(jobs_[i].binary);
    });
    check(cancel_);
    std::uint64_t nodes = top_nodes_, leaves = top_leaves_;
    for (const Job& job : jobs_) {
      nodes += job.need.nodes;
      leaves += job.need.leaves;
      depth_ = std::max(depth_, job.level + job.need.depth - 1);
    }
    if (nodes > kMaxItems || leaves > kMaxClusterUnits) {
      throw std::invalid_argument("a tree has too many items");
    }

    WideTree wide;
    wide.depth = depth_;
    wide.nodes.resize(nodes);
    if (items_.are_triangles()) {
      wide.clusters.resize(leaves * kClusterUnit + kClusterSlack);
      std::memset(wide.clusters.data() + leaves * kClusterUnit, 0, kClusterSlack);
    } else {
      wide.leaves.resize(leaves);
    }
    const EmitTarget target{&items_,
                            nodes_,
                            order_,
                            wide.nodes.data(),
                            items_.are_triangles() ? wide.clusters.data() : nullptr,
                            wide.leaves.data()};
    const BuildKernel& kernel = build_kernel();
    EmitPlace place{0, 1, 0};
    for (const Job& top : top_) {
      place.node = top.node;
      kernel.emit(target, top.binary, false, place);
    }
    std::vector<EmitPlace> places;
    for (const Job& job : jobs_) {
      places.push_back({job.node, place.next_node, place.next_leaf});
      place.next_node += static_cast<std::uint32_t>(job.need.nodes);
      place.next_leaf += static_cast<std::uint32_t>(job.need.leaves);
    }
    pool_.for_each_chunk(jobs_.size(), 1, [&](std::size_t i, std::size_t) {
      if (!cancel_.raised()) kernel.emit(target, jobs_[i].binary, true, places[i]);
    });
    check(cancel_);
    wide.bounds = nodes_[0].box();
    return wide;
  }

 private:
  /// Places the wide nodes of the top breadth-first, down to subtrees that are a job for one
  /// worker. How far that is depends on the tree alone.
  void descend() {
    std::vector<Job> now{{0, 0, 1, {}}};
    top_nodes_ = 1;
    while (!now.empty()) {
      std::vector<Job> next;
      for (const Job& job : now) {
        if (item_count(job.binary) <= share_ && job.node != 0) {
          jobs_.push_back(job);
          continue;
        }
        top_.push_back(job);
        depth_ = std::max(depth_, job.level);
        std::uint32_t children[kWidth];
        const PlannedChildren planned = planned_children(nodes_, job.binary, children);
        for (int i = 0; i < planned.inner; ++i) {
          next.push_back(
              {children[i], static_cast<std::uint32_t>(top_nodes_++), job.level + 1, {}});
        }
        for (int i = planned.inner; i < planned.count; ++i) top_leaves_ += size_of(children[i]);
      }
      now.swap(next);
    }
  }

  std::uint32_t item_count(std::uint32_t node) const {
    std::uint32_t first = node, last = node;
    while (!nodes_[first].is_leaf()) first = nodes_[first].first;
    while (!nodes_[last].is_leaf()) last = nodes_[last].first + 1;
    return nodes_[last].first + nodes_[last].leaf_count() - nodes_[first].first;
  }

  std::uint64_t size_of(std::uint32_t leaf) const {
    return items_.are_triangles() ? leaf_units(nodes_[leaf]) : 1;
  }

  Need below(std::uint32_t node) const {
    Need need;
    std::uint32_t children[kWidth];
    const PlannedChildren planned = planned_children(nodes_, node, children);
    need.nodes = static_cast<std::uint64_t>(planned.inner);
    for (int i = planned.inner; i < planned.count; ++i) need.leaves += size_of(children[i]);
    for (int i = 0; i < planned.inner; ++i) {
      const Need child = below(children[i]);
      need.nodes += child.nodes;
      need.leaves += child.leaves;
      need.depth = std::max(need.depth, child.depth + 1);
    }
    return need;
  }

  const Items& items_;
  const BinaryNode* nodes_;
  const std::uint32_t* order_;
  std::uint32_t share_;  ///< items that make a job
  ThreadPool& pool_;
  const Cancel& cancel_;
  std::vector<Job> top_, jobs_;
  std::uint64_t top_nodes_ = 0, top_leaves_ = 0;
  std::uint32_t depth_ = 0;
};

}  // namespace

WideTree emit_wide_tree(const Items& items, const BinaryTree& tree, ThreadPool& pool,
                        const Cancel& cancel) {
  if (tree.item_count == 0) {
    WideTree wide;
    if (items.are_triangles()) wide.clusters.assign(kClusterSlack, std::byte{0});
    return wide;
  }
  return Emission(items, tree, pool, cancel).run();
}

WideTree build_wide_tree(const Items& items, Builder builder, ThreadPool& pool,
                         const Cancel& cancel) {
  if (items.count() > kMaxItems) {
    throw std::invalid_argument("a tree holds at most " + std::to_string(kMaxItems) +
                                " items, not " + std::to_string(items.count()));
  }
  check(cancel);
  std::uint32_t left_out = 0;
  const BinaryTree tree = builder == Builder::kLinear ? grow_linear(items, pool, cancel, &left_out)
                          : builder == Builder::kSah
                              ? grow_sah(items, pool, cancel, &left_out)
                              : grow_from_topology(items, builder, cancel, &left_out);
  WideTree wide = emit_wide_tree(items, tree, pool, cancel);
  wide.left_out = left_out;
  return wide;
}

}  // namespace komorebi
