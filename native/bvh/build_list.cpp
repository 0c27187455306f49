#include <algorithm>
#include <numeric>

#include "bvh/topology.h"

namespace komorebi {
namespace {

/// Adds the node over positions [first, last] (two or more) and all below; returns its index.
std::uint32_t add_halves(Topology& topology, const Aabb& all, std::uint32_t first,
                         std::uint32_t last, std::uint32_t level) {
  const auto node = static_cast<std::uint32_t>(topology.left.size());
  topology.left.push_back(kNone);
  topology.right.push_back(kNone);
  topology.first.push_back(first);
  topology.last.push_back(last);
  topology.bounds.push_back(all);
  topology.depth = std::max(topology.depth, level + 1);
  const auto child = [&](std::uint32_t from, std::uint32_t to) {
    return from == to ? (kLeafBit | from) : add_halves(topology, all, from, to, level + 1);
  };
  const std::uint32_t middle = first + (last - first) / 2;
  const std::uint32_t left = child(first, middle);
  const std::uint32_t right = child(middle + 1, last);
  topology.left[node] = left;
  topology.right[node] = right;
  return node;
}

}  // namespace

/// A list cut in halves, every node with the box of everything: a ray that meets the whole visits
/// every item, in the given order. Depth log2 n.
Topology build_list(std::span<const Aabb> boxes) {
  Topology topology;
  const auto count = static_cast<std::uint32_t>(boxes.size());
  topology.order.resize(count);
  std::iota(topology.order.begin(), topology.order.end(), 0u);
  if (count == 0) return topology;
  topology.root = kLeafBit;
  if (count == 1) return topology;
  Aabb all;
  for (const Aabb& box : boxes) all = united(all, box);
  topology.root = add_halves(topology, all, 0, count - 1, 0);
  return topology;
}

}  // namespace komorebi
