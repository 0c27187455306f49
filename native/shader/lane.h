#pragma once

#include <cstdint>

/// For functions over one lane that loops over lanes take into themselves: each instruction set has
/// a copy of the loops, and a function of its own would be the copy of one of them for all.
#define KOMOREBI_LANE [[gnu::always_inline]] inline

namespace komorebi {

KOMOREBI_LANE std::uint32_t float_bits(float x) {
  return __builtin_bit_cast(std::uint32_t, x);
}
KOMOREBI_LANE float bits_float(std::uint32_t bits) {
  return __builtin_bit_cast(float, bits);
}

KOMOREBI_LANE float absolute(float x) {
  return bits_float(float_bits(x) & 0x7fffffffu);
}
/// −x where the lowest bit of `bit` is set.
KOMOREBI_LANE float negate_if(float x, std::uint32_t bit) {
  return bits_float(float_bits(x) ^ (bit << 31));
}
/// NaN becomes `low`.
KOMOREBI_LANE float clamp(float x, float low, float high) {
  const float above = x > low ? x : low;
  return above < high ? above : high;
}
KOMOREBI_LANE float clamp01(float x) {
  return clamp(x, 0.0f, 1.0f);
}
KOMOREBI_LANE float smaller(float a, float b) {
  return a < b ? a : b;
}
KOMOREBI_LANE float larger(float a, float b) {
  return a > b ? a : b;
}
KOMOREBI_LANE float mix(float a, float b, float t) {
  return a + t * (b - a);
}
/// 3x² − 2x³ between 0 and 1.
KOMOREBI_LANE float smoothstep01(float x) {
  const float t = clamp01(x);
  return (3.0f - 2.0f * t) * (t * t);
}

/// Whole numbers up to here, and none beyond, are exact as int32 and as float.
inline constexpr float kMostWhole = 1.0e9f;

/// The largest whole number ≤ x. Beyond ±kMostWhole, and for NaN, that end of the range.
KOMOREBI_LANE std::int32_t floor_lane(float x) {
  const float inside = clamp(x, -kMostWhole, kMostWhole);
  const auto i = static_cast<std::int32_t>(inside);
  return i - static_cast<std::int32_t>(static_cast<float>(i) > inside);
}

}  // namespace komorebi
