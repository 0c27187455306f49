#pragma once

#include "bvh/wide_node.h"

namespace komorebi {

/// Lays the node's grid around `boxes` (1…8, none empty) and stores for each a box on the grid that
/// contains it, as the traversal will decode it: the smallest one, or where rounding is in the way
/// one step more.
void quantise(const Aabb* boxes, int count, WideNode& node);

/// A little less than 1/255: so the step that is looked at first is never too large.
inline constexpr float kGridShare = 0.0039215f;
/// The highest one looked at first, as a box may be larger than any float.
inline constexpr std::uint32_t kFirstGridExponent = 247;

/// The smallest step (a power of two, as WideNode::exponent) whose 255 multiples reach from lo to
/// hi.
inline std::uint8_t choose_grid_exponent(float lo, float hi) {
  const auto least = std::bit_cast<std::uint32_t>((hi - lo) * kGridShare) >> 23;
  std::uint32_t exponent = least < 1 ? 1 : least > kFirstGridExponent ? kFirstGridExponent : least;
  const auto reaches = [&] { return lo + 255.0f * std::bit_cast<float>(exponent << 23) >= hi; };
  while (exponent < 254 && !reaches()) ++exponent;
  return static_cast<std::uint8_t>(exponent);
}

}  // namespace komorebi
