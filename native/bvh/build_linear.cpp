#include <algorithm>
#include <atomic>
#include <memory>

#include "bvh/morton_grid.h"
#include "bvh/topology.h"
#include "parallel/radix_sort.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = 8192;

/// Gives every item its Morton code and sorts.
template <class Key, class Code>
std::vector<KeyIndex<Key>> sorted_codes(std::span<const Aabb> boxes, const Code& code,
                                        ThreadPool& pool, const Cancel& cancel) {
  std::vector<KeyIndex<Key>> items(boxes.size()), scratch(boxes.size());
  pool.for_each_chunk(boxes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) return;
    for (std::size_t i = begin; i < end; ++i) {
      items[i] = {code(boxes[i]), static_cast<std::uint32_t>(i)};
    }
  });
  check(cancel);
  radix_sort(items, scratch, pool, cancel);
  return items;
}

/// The hierarchy over sorted codes, after Karras 2012 in the bottom-up form of Apetrei 2014: inner
/// node i stands between positions i and i + 1. A node over [first, last] hangs below the
/// neighbouring inner node whose two codes agree in more bits, so every node finds its parent from
/// the codes alone; equal codes are told apart by their position (Karras §4), which keeps even a
/// million equal codes 20 levels deep. A thread climbs from each leaf and stops at the first node
/// whose other child is not there yet.
template <class Key>
class Hierarchy {
 public:
  Hierarchy(std::span<const KeyIndex<Key>> items, std::span<const Aabb> boxes, Topology& topology)
      : items_(items), boxes_(boxes), topology_(topology), last_(items.size() - 1) {
    const std::size_t inner = items.size() - 1;
    topology_.left.resize(inner);
    topology_.right.resize(inner);
    topology_.first.resize(inner);
    topology_.last.resize(inner);
    topology_.bounds.resize(inner);
    height_.resize(inner);
    arrived_ = std::make_unique<std::atomic<bool>[]>(inner);  // all false
  }

  void climb(std::size_t leaf) {
    std::uint32_t node = kLeafBit | static_cast<std::uint32_t>(leaf);
    std::size_t first = leaf, last = leaf;
    while (first != 0 || last != last_) {
      const bool is_left = first == 0 || (last != last_ && closer(last, first - 1));
      const std::size_t parent = is_left ? last : first - 1;
      if (is_left) {
        topology_.left[parent] = node;
        topology_.first[parent] = static_cast<std::uint32_t>(first);
      } else {
        topology_.right[parent] = node;
        topology_.last[parent] = static_cast<std::uint32_t>(last);
      }
      // Release what this thread wrote below; acquire what the other child's thread did.
      if (!arrived_[parent].exchange(true, std::memory_order_acq_rel)) return;
      const std::uint32_t left = topology_.left[parent], right = topology_.right[parent];
      topology_.bounds[parent] = united(box(left), box(right));
      height_[parent] = static_cast<std::uint8_t>(1 + std::max(height(left), height(right)));
      first = topology_.first[parent];
      last = topology_.last[parent];
      node = static_cast<std::uint32_t>(parent);
    }
    topology_.root = node;
    topology_.depth = height(node);
  }

 private:
  /// Whether the codes around gap a agree in more bits than those around gap b.
  bool closer(std::size_t a, std::size_t b) const {
    const Key key_a = items_[a].key ^ items_[a + 1].key;
    const Key key_b = items_[b].key ^ items_[b + 1].key;
    if (key_a != key_b) return key_a < key_b;
    return (a ^ (a + 1)) < (b ^ (b + 1));
  }
  const Aabb& box(std::uint32_t node) const {
    return node & kLeafBit ? boxes_[items_[node & ~kLeafBit].index] : topology_.bounds[node];
  }
  unsigned height(std::uint32_t node) const { return node & kLeafBit ? 0u : height_[node]; }

  std::span<const KeyIndex<Key>> items_;
  std::span<const Aabb> boxes_;
  Topology& topology_;
  std::size_t last_;  ///< position of the last item
  std::vector<std::uint8_t> height_;
  std::unique_ptr<std::atomic<bool>[]> arrived_;
};

template <class Key, class Code>
Topology build(std::span<const Aabb> boxes, const Code& code, ThreadPool& pool,
               const Cancel& cancel) {
  Topology topology;
  const auto items = sorted_codes<Key>(boxes, code, pool, cancel);
  topology.order.resize(items.size());
  pool.for_each_chunk(items.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) topology.order[i] = items[i].index;
  });
  if (items.empty()) return topology;
  Hierarchy<Key> hierarchy(items, boxes, topology);
  pool.for_each_chunk(items.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) return;
    for (std::size_t i = begin; i < end; ++i) hierarchy.climb(i);
  });
  check(cancel);
  return topology;
}

}  // namespace

Topology build_linear(std::span<const Aabb> boxes, ThreadPool& pool, const Cancel& cancel) {
  const MortonGrid grid = choose_morton_grid(boxes, pool, cancel);
  check(cancel);
  if (grid.wide) {
    return build<std::uint64_t>(
        boxes, [&](const Aabb& box) { return grid.code_63(box); }, pool, cancel);
  }
  return build<std::uint32_t>(
      boxes, [&](const Aabb& box) { return grid.code_30(box); }, pool, cancel);
}

}  // namespace komorebi
