#pragma once

#include "bvh/wide_node.h"

namespace komorebi {

/// Lays the node's grid around `boxes` (1…8, none empty) and stores for each the smallest box on
/// the grid that contains it, as the traversal will decode it.
void quantise(const Aabb* boxes, int count, WideNode& node);

/// The smallest step (a power of two, as WideNode::exponent) whose 255 multiples reach from lo to
/// hi.
inline std::uint8_t choose_grid_exponent(float lo, float hi) {
  const double least = (double(hi) - double(lo)) / 255.0;
  int exponent = 1;
  if (least >= 0x1p-126) {
    exponent = static_cast<int>(std::bit_cast<std::uint64_t>(least) >> 52) - 1023 + 127;
    if (exponent > 254) exponent = 254;
  }
  const auto reaches = [&] {
    const float step = std::bit_cast<float>(static_cast<std::uint32_t>(exponent) << 23);
    return lo + 255.0f * step >= hi;
  };
  while (exponent < 254 && !reaches()) ++exponent;
  return static_cast<std::uint8_t>(exponent);
}

}  // namespace komorebi
