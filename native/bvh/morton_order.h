#pragma once

#include <span>
#include <vector>

#include "bvh/items.h"
#include "bvh/morton_grid.h"
#include "parallel/cancel.h"
#include "parallel/radix_sort.h"
#include "parallel/scratch.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// Neighbours in the order.
struct Run {
  std::uint32_t first, count;
};

/// Items along the Morton curve, triangles as strips (bvh/strip.h), without those that no ray can
/// meet.
struct MortonOrder {
  /// Sorted by (code, index). Only one of the two has anything in it.
  Scratch<KeyIndex<std::uint32_t>> narrow;
  Scratch<KeyIndex<std::uint64_t>> wide;
  std::uint32_t count = 0;     ///< of strips
  std::uint32_t left_out = 0;  ///< items in none
  float sample_area = 0.0f;    ///< median half area of the boxes looked at
  float largest_side = 0.0f;   ///< of everything

  /// Areas are measured in units of 1 / scale².
  float scale() const { return 1.0f / max_of(largest_side, 1e-30f); }

  std::uint64_t code(std::size_t i) const { return wide.size() > 0 ? wide[i].key : narrow[i].key; }
  std::uint32_t strip(std::size_t i) const {
    return wide.size() > 0 ? wide[i].index : narrow[i].index;
  }

  /// The run, with codes of 31 bits: the highest in which they differ and those below. What is not
  /// there in this form is put into `room`.
  const KeyIndex<std::uint32_t>* narrow_run(Run run, KeyIndex<std::uint32_t>* room) const;
};

/// @param spare  memory that may be used meanwhile
/// @throws Cancelled
MortonOrder order_by_morton(const Items& items, std::span<std::byte> spare, ThreadPool& pool,
                            const Cancel& cancel);

/// Runs of sorted items that share a prefix of their codes, none longer than asked for, and the
/// radix tree over them (Karras 2012): a node's codes part in the highest bit in which they differ,
/// equal codes in the middle, which bounds the depth.
struct RunTree {
  struct Node {
    std::uint32_t first;  ///< left child, the right one follows; or the run
    bool is_run;
  };
  std::vector<Run> runs;
  std::vector<Node> nodes;  ///< the first is the root

  void cut(const MortonOrder& order, std::uint32_t most);

 private:
  void cut(const MortonOrder& order, std::uint32_t most, std::size_t node, std::uint32_t first,
           std::uint32_t last);
};

}  // namespace komorebi
