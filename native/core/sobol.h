#pragma once

#include "core/vector.h"

namespace komorebi {

/// The 32 bits in the opposite order.
inline std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/// Dimensions 0 and 1 of Sobol's sequence, the (0,2)-sequence in base 2, with their bits reversed:
/// bit k is the (k+1)-th binary digit after the point. Owen scrambling works in this order.
inline std::uint32_t sobol_0_reversed(std::uint32_t index) {
  return index;
}

/// Dimension 1's generator matrix is Pascal's triangle modulo 2: digit i is the sum of all index
/// bits j for which C(j, i) is odd, that is, for which i's bits are a subset of j's (Lucas). A sum
/// over supersets takes five shifts (Ahmed, "An Implementation Algorithm of 2D Sobol Sequence Fast,
/// Elegant, and Compact", EGSR 2024).
inline std::uint32_t sobol_1_reversed(std::uint32_t index) {
  std::uint32_t v = index;
  v ^= v >> 16;
  v ^= (v >> 8) & 0x00ff00ffu;
  v ^= (v >> 4) & 0x0f0f0f0fu;
  v ^= (v >> 2) & 0x33333333u;
  v ^= (v >> 1) & 0x55555555u;
  return v;
}

/// A random nested uniform (Owen) scramble in reversed bit order: every bit is flipped or not
/// depending on `seed` and on the lower, that is, more significant bits alone. The hash of Laine
/// and Karras (2011) as Burley uses it ("Practical Hash-based Owen Scrambling", JCGT 9(4), 2020),
/// with the constants that Vegdahl found by search ("Building a Better LK Hash", 2021).
inline std::uint32_t owen_scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

}  // namespace komorebi
