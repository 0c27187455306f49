#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/aabb.h"
#include "parallel/cancel.h"

namespace komorebi {

/// How a tree is built. All give the same kind of tree, and so the same hits.
enum class Builder {
  kLinear,         ///< Morton order (bvh/grow_linear.cpp): at once
  kSah,            ///< surface-area heuristic (bvh/grow_sah.cpp): for many rays
  kPrincipalAxis,  ///< top-down, split across the longest spread (bvh/build_principal_axis.cpp)
  kList,           ///< the given order, boxes that cull nothing (bvh/build_list.cpp): for tests
};

/// "LINEAR", "SAH", "PRINCIPAL_AXIS", "LIST"; anything else is a std::invalid_argument that names
/// it.
Builder builder_from_name(const std::string& name);
const char* builder_name(Builder builder);

/// Deepest topology that any builder may return: 64 bits of code and 32 of index. Wide trees are
/// never deeper, so this bounds every traversal stack.
inline constexpr std::uint32_t kMaxDepth = 96;

/// A child is an inner node, or with this bit one item: its position in `order`.
inline constexpr std::uint32_t kLeafBit = 0x80000000u;
inline constexpr std::size_t kMaxItems = 0x7fffffffu;

/// A binary tree over boxes, as arrays. Every inner node covers a range of `order`; single items
/// are no nodes of their own. n items have n − 1 inner nodes (0 for n < 2), in any order.
struct Topology {
  std::vector<std::uint32_t> order;        ///< position → index of the item's box
  std::vector<std::uint32_t> left, right;  ///< per inner node: inner node, or kLeafBit | position
  std::vector<std::uint32_t> first, last;  ///< per inner node: positions covered, both included
  std::vector<Aabb> bounds;                ///< per inner node: contains the boxes of the range
  std::uint32_t root = kNone;  ///< inner node, or kLeafBit | 0 for one item; kNone for none
  std::uint32_t depth = 0;     ///< inner nodes on the longest way down, at most kMaxDepth
};

/// Builds over `boxes` (none empty; not-a-number is harmless but useless) by kPrincipalAxis or
/// kList, which see boxes alone; the engine's own builders make their trees without this form.
/// @throws Cancelled, std::invalid_argument for more than kMaxItems boxes or another builder.
Topology build_topology(std::span<const Aabb> boxes, Builder builder, const Cancel& cancel);

Topology build_principal_axis(std::span<const Aabb> boxes, const Cancel& cancel);
Topology build_list(std::span<const Aabb> boxes);

/// Throws Cancelled if the flag is raised.
inline void check(const Cancel& cancel) {
  if (cancel.raised()) throw Cancelled();
}

}  // namespace komorebi
