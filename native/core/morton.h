#pragma once

#include "core/vector.h"

namespace komorebi {

/// Spreads the low 10 bits of x so that two zero bits follow each.
inline std::uint32_t spread_bits_10(std::uint32_t x) {
  x &= 0x3ffu;
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  x = (x | (x << 2)) & 0x09249249u;
  return x;
}

/// Spreads the low 21 bits of x so that two zero bits follow each.
inline std::uint64_t spread_bits_21(std::uint64_t x) {
  x &= 0x1fffffull;
  x = (x | (x << 32)) & 0x001f00000000ffffull;
  x = (x | (x << 16)) & 0x001f0000ff0000ffull;
  x = (x | (x << 8)) & 0x100f00f00f00f00full;
  x = (x | (x << 4)) & 0x10c30c30c30c30c3ull;
  x = (x | (x << 2)) & 0x1249249249249249ull;
  return x;
}

/// Interleaves three 10-bit cell numbers to 30 bits, x highest: neighbours on the curve are near
/// in space (Morton 1966).
inline std::uint32_t morton_30(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return (spread_bits_10(x) << 2) | (spread_bits_10(y) << 1) | spread_bits_10(z);
}

/// The same for three 21-bit cell numbers, 63 bits.
inline std::uint64_t morton_63(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return (spread_bits_21(x) << 2) | (spread_bits_21(y) << 1) | spread_bits_21(z);
}

}  // namespace komorebi
