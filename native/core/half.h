#pragma once

#include <bit>
#include <cstdint>

/// IEEE half floats as 16 bits, by whole numbers: the same everywhere, whatever a processor does
/// with denormal ones.
namespace komorebi {

/// Exact.
inline float float_from_half(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000u) << 16, rest = half & 0x7fffu;
  if (rest >= 0x7c00u) return std::bit_cast<float>(sign | 0x7f800000u | (rest & 0x3ffu) << 13);
  if (rest >= 0x0400u) return std::bit_cast<float>(sign | ((rest << 13) + (112u << 23)));
  const float denormal = static_cast<float>(rest) * 5.9604644775390625e-8f;  // 2^-24
  return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(denormal));
}

/// The nearest, of two the even one; what is too large becomes the largest half, 65504, so that
/// light stays finite; a NaN stays one.
inline std::uint16_t half_from_float(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000u);
  const std::uint32_t rest = bits & 0x7fffffffu;
  std::uint32_t half = 0;
  if (rest > 0x7f800000u) {
    half = 0x7e00u;
  } else if (rest >= 0x477fe000u) {  // 65504 and above
    half = 0x7bffu;
  } else if (rest >= 0x38800000u) {  // normal: from 2^-14
    half = (rest - (112u << 23) + 0x0fffu + (rest >> 13 & 1u)) >> 13;
  } else {
    // denormal: adding 1/2 rounds at 2^-24, ties to even
    const float aligned = std::bit_cast<float>(rest) + 0.5f;
    half = std::bit_cast<std::uint32_t>(aligned) - 0x3f000000u;
  }
  return static_cast<std::uint16_t>(sign | half);
}

}  // namespace komorebi
