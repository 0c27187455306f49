#pragma once

#include <cstdint>

#include "bvh/binary_tree.h"

namespace komorebi {

inline constexpr int kPlanWidth = 8;  ///< children of a wide node at most

/// What a ray pays for a node and for a leaf that it meets: the ratio is what counts. The eight
/// boxes of a node and the up to eight triangles of a leaf are each one step of eight lanes.
inline constexpr float kNodeCost = 1.0f;
inline constexpr float kLeafCost = 1.0f;

/// The cheapest wide tree over a binary one, by dynamic programming (Ylitie, Karras, Laine 2017,
/// §3.1): cost[i] is the surface-area cost of a subtree as a forest of at most i wide nodes or
/// leaves, for i in [1, 7]. A node is decided from its children alone, and its decisions fit into
/// BinaryNode::info: for every i the share k of the left child (3 bits each), whether i − 1 was no
/// worse (1 bit each), and how many children the node has as a wide node.
struct PlanCost {
  float at[kPlanWidth];  ///< [0] unused
};

inline PlanCost plan_leaf(float area) {
  PlanCost cost;
  for (float& c : cost.at) c = area * kLeafCost;
  return cost;
}

/// Returns the `info` of an inner node; `cost` is written.
inline std::uint32_t plan_inner(float area, const PlanCost& left, const PlanCost& right,
                                PlanCost* cost) {
  std::uint32_t info = kInnerBit;
  float split[kPlanWidth + 1];
  for (int i = 2; i <= kPlanWidth; ++i) {
    float best = left.at[1] + right.at[i - 1 < 7 ? i - 1 : 7];
    std::uint32_t share = 1;
    for (int k = 2; k < i; ++k) {
      const float c = left.at[k] + right.at[i - k];
      share = c < best ? static_cast<std::uint32_t>(k) : share;
      best = c < best ? c : best;
    }
    split[i] = best;
    info |= share << (3 * (i - 2));
  }
  int children = kPlanWidth;
  for (int i = kPlanWidth - 1; i >= 2; --i) {
    if (split[i] <= split[children]) children = i;
  }
  info |= static_cast<std::uint32_t>(children - 1) << 27;
  float last = area * kNodeCost + split[children];
  cost->at[0] = 0.0f;
  cost->at[1] = last;
  for (int i = 2; i < kPlanWidth; ++i) {
    if (last <= split[i]) {
      info |= 1u << (21 + i - 2);
    } else {
      last = split[i];
    }
    cost->at[i] = last;
  }
  return info;
}

/// Whether a grid of that step (of the wide node above) would blow up the node's box noticeably.
/// Such a node stays closed, so that what it holds gets a grid of its own: one triangle far away
/// must not coarsen the boxes of all others.
inline bool is_coarse(const Vec3& step, const BinaryNode& node) {
  const Aabb box = node.box();
  return half_area(Aabb{box.lo, box.hi + 2.0f * step}) > 1.25f * half_area(box);
}

/// Writes the nodes of the forest that stands for `node` within `most` places; returns how many.
inline int collect_forest(const BinaryNode* nodes, std::uint32_t node, int most, const Vec3& step,
                          std::uint32_t* forest) {
  const std::uint32_t info = nodes[node].info;
  const bool is_leaf = nodes[node].is_leaf();
  while (most > 1 && !is_leaf && ((info >> (21 + most - 2)) & 1u) != 0) --most;
  if (most == 1 || is_leaf || is_coarse(step, nodes[node])) {
    forest[0] = node;
    return 1;
  }
  const int share = static_cast<int>((info >> (3 * (most - 2))) & 7u);
  const int count = collect_forest(nodes, nodes[node].first, share, step, forest);
  return count + collect_forest(nodes, nodes[node].first + 1, most - share, step, forest + count);
}

/// Children of a wide node: first those that are wide nodes themselves; of either kind the larger
/// ones last, where traversal begins, so that rays that are blocked end sooner.
struct PlannedChildren {
  int count, inner;
};

/// The children of the wide node that stands for `node`: at most kPlanWidth, and one if it is a
/// leaf, which then is the only one.
inline PlannedChildren planned_children(const BinaryNode* nodes, std::uint32_t node,
                                        std::uint32_t* children) {
  children[0] = node;
  if (nodes[node].is_leaf()) return {1, 0};
  const std::uint32_t info = nodes[node].info, left = nodes[node].first;
  const Aabb box = nodes[node].box();
  const Vec3 step = (box.hi - box.lo) / 255.0f;
  const int most = static_cast<int>((info >> 27) & 7u) + 1;
  const int share = static_cast<int>((info >> (3 * (most - 2))) & 7u);
  std::uint32_t all[kPlanWidth];
  int count = collect_forest(nodes, left, share, step, all);
  count += collect_forest(nodes, left + 1, most - share, step, all + count);
  PlannedChildren planned{count, 0};
  float area[kPlanWidth];
  for (int i = 0; i < count; ++i) {
    const bool is_leaf = nodes[all[i]].is_leaf();
    const float its = half_area(nodes[all[i]].box());
    // By insertion behind what is not larger; leaves behind all inner ones.
    const int from = is_leaf ? planned.inner : 0;
    int at = is_leaf ? i : planned.inner;
    for (int k = i; k > at; --k) {
      children[k] = children[k - 1];
      area[k] = area[k - 1];
    }
    for (; at > from && area[at - 1] > its; --at) {
      children[at] = children[at - 1];
      area[at] = area[at - 1];
    }
    children[at] = all[i];
    area[at] = its;
    planned.inner += is_leaf ? 0 : 1;
  }
  return planned;
}

}  // namespace komorebi
