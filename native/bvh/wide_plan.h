#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "bvh/binary_tree.h"

namespace komorebi {

inline constexpr int kPlanWidth = 8;  ///< children of a wide node at most

/// What a ray pays for a node and for a leaf that it meets: the ratio is what counts. The eight
/// boxes of a node and the up to eight triangles of a leaf are each one step of eight lanes.
inline constexpr float kNodeCost = 1.0f;
inline constexpr float kLeafCost = 1.0f;

/// The cheapest wide tree over a binary one, by dynamic programming (Ylitie, Karras, Laine 2017,
/// §3.1): at[i] is the surface-area cost of a subtree as a forest of at most i + 1 wide nodes or
/// leaves, i < 7; the last entry fills the lanes. A node is decided from its children alone, and
/// its decisions fit into BinaryNode::info: for every size i in [2, 8] of a forest the share k of
/// the left child (3 bits each), for i < 8 whether i − 1 was no worse (1 bit each), and how many
/// children the node has as a wide node.
struct alignas(32) PlanCost {
  float at[kPlanWidth];
};

inline constexpr float kNoPlan = std::numeric_limits<float>::infinity();

/// What is one node or leaf whatever room there is.
inline PlanCost plan_closed(float cost) {
  PlanCost plan;
  for (float& c : plan.at) c = cost;
  plan.at[kPlanWidth - 1] = kNoPlan;
  return plan;
}
inline PlanCost plan_leaf(float area) {
  return plan_closed(area * kLeafCost);
}

/// Returns the `info` of an inner node; `cost` is written. What plan-inl.h does in lanes.
inline std::uint32_t plan_inner(float area, const PlanCost& left, const PlanCost& right,
                                PlanCost* cost) {
  std::uint32_t info = kInnerBit;
  float split[kPlanWidth + 1];
  for (int i = 2; i <= kPlanWidth; ++i) {
    float best = left.at[0] + right.at[i - 2];
    std::uint32_t share = 1;
    for (int k = 2; k < i; ++k) {
      const float c = left.at[k - 1] + right.at[i - k - 1];
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
  cost->at[0] = last;
  for (int i = 2; i < kPlanWidth; ++i) {
    if (last <= split[i]) {
      info |= 1u << (21 + i - 2);
    } else {
      last = split[i];
    }
    cost->at[i - 1] = last;
  }
  cost->at[kPlanWidth - 1] = kNoPlan;
  return info;
}

/// Whether a grid of that step (of the wide node above) would blow up the node's box noticeably.
/// Such a node stays closed, so that what it holds gets a grid of its own: one triangle far away
/// must not coarsen the boxes of all others.
inline bool is_coarse(const Vec3& step, const BinaryNode& node) {
  const Aabb box = node.box();
  return half_area(Aabb{box.lo, box.hi + 2.0f * step}) > 1.25f * half_area(box);
}

/// Nodes that are still to be opened, each with the most nodes that may stand for it.
class OpenNodes {
 public:
  explicit OpenNodes(const BinaryNode* nodes) : nodes_(nodes) {}

  void push(std::uint32_t node, int room) {
    node_[count_] = node;
    room_[count_++] = room;
  }
  /// Both children, left one on top; together they take `room` ≥ 2 places at most.
  void push_children(std::uint32_t node, int room) {
    const std::uint32_t left = nodes_[node].first;
    const int share = static_cast<int>((nodes_[node].info >> (3 * (room - 2))) & 7u);
    push(left + 1, room - share);
    push(left, share);
  }
  /// Both children, with as many places as the node has children as a wide node.
  void push_wide(std::uint32_t node) {
    push_children(node, static_cast<int>((nodes_[node].info >> 27) & 7u) + 1);
  }
  /// The next node, and as how many it is best: 1, it stays as it is. False: none is left.
  bool next(std::uint32_t* node, int* room, int* size) {
    if (count_ == 0) return false;
    *node = node_[--count_];
    *room = room_[count_];
    const BinaryNode& it = nodes_[*node];
    // The largest size up to `room` that is better than the next smaller one.
    const std::uint32_t better = ~(it.info >> 21) & ((1u << (*room - 1)) - 1u);
    *size = it.is_leaf() || better == 0 ? 1 : 33 - std::countl_zero(better);
    return true;
  }
  /// The next node that stays as it is in a wide node of grid step `step`; false: none is left.
  bool pop(const Vec3& step, std::uint32_t* node, int* room) {
    int size = 0;
    while (next(node, room, &size)) {
      if (size == 1 || is_coarse(step, nodes_[*node])) return true;
      push_children(*node, size);
    }
    return false;
  }

 private:
  const BinaryNode* nodes_;
  int count_ = 0;
  std::uint32_t node_[kPlanWidth];
  int room_[kPlanWidth];
};

/// The step of the grid of a wide node, or a little less.
inline Vec3 step_of(const BinaryNode& node) {
  const Aabb box = node.box();
  return (box.hi - box.lo) / 255.0f;
}

/// Children of a wide node: first those that are wide nodes themselves; of either kind the larger
/// ones last, where traversal begins, so that rays that are blocked end sooner.
class ChildOrder {
 public:
  void add(const BinaryNode& child) {
    const std::uint32_t area = std::bit_cast<std::uint32_t>(half_area(child.box()));
    const std::uint32_t key = area | (child.is_leaf() ? kInnerBit : 0u);
    inner += child.is_leaf() ? 0 : 1;
    // Each goes behind all with a smaller key, and behind those before it with the same.
    place[count] = 0;
    for (int k = 0; k < count; ++k) {
      const int behind = key_[k] <= key ? 1 : 0;
      place[count] += behind;
      place[k] += 1 - behind;
    }
    key_[count++] = key;
  }
  int count = 0, inner = 0;
  int place[kPlanWidth];  ///< of child i

 private:
  std::uint32_t key_[kPlanWidth];
};

}  // namespace komorebi
