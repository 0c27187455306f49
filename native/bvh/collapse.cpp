#include "bvh/collapse.h"

#include <algorithm>

#include "bvh/quantise.h"

namespace komorebi {
namespace {

/// What one wide node will hold, before its children's places are known.
struct Children {
  std::uint32_t node[kWidth];  ///< topology node, or kLeafBit | position
  std::uint32_t count = 0;
  std::uint32_t inner = 0;  ///< how many become wide nodes of their own; they come first
};

class Collapser {
 public:
  Collapser(const Topology& topology, std::span<const Aabb> boxes,
            std::span<const std::uint8_t> is_leaf)
      : topology_(topology), boxes_(boxes), is_leaf_(is_leaf) {}

  bool is_leaf(std::uint32_t node) const {
    return (node & kLeafBit) != 0 || (!is_leaf_.empty() && is_leaf_[node] != 0);
  }

  LeafRange range(std::uint32_t node) const {
    if (node & kLeafBit) return {node & ~kLeafBit, 1};
    return {topology_.first[node], topology_.last[node] - topology_.first[node] + 1};
  }

  const Aabb& box(std::uint32_t node) const {
    return node & kLeafBit ? boxes_[topology_.order[node & ~kLeafBit]] : topology_.bounds[node];
  }

  /// Leaves that the subtree of `node` will have, counted up to `most`.
  std::uint32_t leaves(std::uint32_t node, std::uint32_t most) const {
    if (is_leaf(node) || most <= 1) return 1;
    const std::uint32_t left = leaves(topology_.left[node], most - 1);
    return left >= most ? left : left + leaves(topology_.right[node], most - left);
  }

  /// Whether a grid of that step would blow up a box noticeably.
  static bool is_coarse(const Vec3& step, const Aabb& box) {
    return half_area(Aabb{box.lo, box.hi + 2.0f * step}) > 1.5f * half_area(box);
  }

  /// The children of the wide node that stands for `node`.
  ///
  /// Subtrees that fit into one wide node are kept whole: opening them early would leave nodes with
  /// two or three children further down, which are most of the memory and of the visits.
  ///
  /// A child that is small against the node's grid stays closed, so that its own children get a
  /// grid of their own: one triangle far away must not coarsen the boxes of all others.
  Children children(std::uint32_t node) const {
    Children result;
    const Vec3 step = (box(node).hi - box(node).lo) / 255.0f;
    // Leaves below, or kWidth + 1 for more than fit into one node; 0: not to be opened.
    std::uint32_t size[kWidth];
    float area[kWidth];
    const auto set = [&](std::uint32_t i, std::uint32_t child) {
      result.node[i] = child;
      size[i] = leaves(child, kWidth + 1);
      area[i] = half_area(box(child));
      if (child != node && is_coarse(step, box(child))) size[i] = 0;
    };
    const auto open = [&](std::uint32_t i) {
      const std::uint32_t opened = result.node[i];
      set(i, topology_.left[opened]);
      set(result.count++, topology_.right[opened]);
    };
    set(result.count++, node);
    while (result.count < kWidth) {
      // Of those that need nodes below anyway, the largest.
      std::uint32_t best = kWidth;
      for (std::uint32_t i = 0; i < result.count; ++i) {
        if (size[i] > kWidth && (best == kWidth || area[i] > area[best])) best = i;
      }
      // Else the smallest that fits here as a whole, which saves its node.
      if (best == kWidth) {
        for (std::uint32_t i = 0; i < result.count; ++i) {
          if (size[i] < 2 || result.count + size[i] - 1 > kWidth) continue;
          if (best == kWidth || size[i] < size[best]) best = i;
        }
      }
      if (best == kWidth) break;
      open(best);
    }
    // Larger ones last, for traversal begins at the end: rays that are blocked end sooner.
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      if (is_leaf(a) != is_leaf(b)) return is_leaf(b);
      return half_area(box(a)) < half_area(box(b));
    };
    std::stable_sort(result.node, result.node + result.count, before);
    for (std::uint32_t i = 0; i < result.count; ++i) {
      result.inner += is_leaf(result.node[i]) ? 0u : 1u;
    }
    return result;
  }

 private:
  const Topology& topology_;
  std::span<const Aabb> boxes_;
  std::span<const std::uint8_t> is_leaf_;
};

}  // namespace

WideTree collapse(const Topology& topology, std::span<const Aabb> boxes,
                  std::span<const std::uint8_t> is_leaf, ThreadPool& pool, const Cancel& cancel) {
  WideTree tree;
  if (topology.root == kNone) return tree;
  const Collapser collapser(topology, boxes, is_leaf);
  constexpr std::size_t kGrain = 256;

  // Level by level: decide all nodes' children, count them, and then every place is known.
  std::vector<std::uint32_t> level{topology.root}, next;
  std::vector<Children> decided;
  std::vector<std::uint32_t> first_inner, first_leaf;
  while (!level.empty()) {
    ++tree.depth;
    const std::size_t count = level.size();
    decided.resize(count);
    pool.for_each_chunk(count, kGrain, [&](std::size_t begin, std::size_t end) {
      if (cancel.raised()) return;
      for (std::size_t i = begin; i < end; ++i) decided[i] = collapser.children(level[i]);
    });
    check(cancel);

    first_inner.resize(count);
    first_leaf.resize(count);
    std::uint32_t inner = 0;
    auto leaf = static_cast<std::uint32_t>(tree.leaves.size());
    for (std::size_t i = 0; i < count; ++i) {
      first_inner[i] = inner;
      first_leaf[i] = leaf;
      inner += decided[i].inner;
      leaf += decided[i].count - decided[i].inner;
    }
    const std::size_t base = tree.nodes.size();
    tree.nodes.resize(base + count);
    tree.leaves.resize(leaf);
    next.resize(inner);

    pool.for_each_chunk(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Children& children = decided[i];
        WideNode& wide = tree.nodes[base + i];
        wide.counts = static_cast<std::uint8_t>(children.inner | children.count << 4);
        wide.first_child = static_cast<std::uint32_t>(base + count) + first_inner[i];
        wide.first_leaf = first_leaf[i];
        Aabb box[kWidth];
        for (std::uint32_t k = 0; k < kWidth; ++k) wide.leaf[k] = 0;
        for (std::uint32_t k = 0; k < children.count; ++k) {
          box[k] = collapser.box(children.node[k]);
          if (k < children.inner) {
            next[first_inner[i] + k] = children.node[k];
            continue;
          }
          wide.leaf[k] = static_cast<std::uint8_t>(k - children.inner);
          tree.leaves[wide.child_leaf(static_cast<int>(k))] = collapser.range(children.node[k]);
        }
        quantise(box, static_cast<int>(children.count), wide);
      }
    });
    level.swap(next);
  }
  return tree;
}

}  // namespace komorebi
