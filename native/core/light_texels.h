#pragma once

#include <bit>
#include <cstdint>

#include "core/half.h"
#include "core/vector.h"

/// How the texels of an environment map stand in memory: as what takes the least room of those that
/// hold each of its numbers exactly.
namespace komorebi {

enum class LightStorage : std::uint32_t {
  kFloat,  ///< [3] floats a texel
  kHalf,   ///< [3] halves, two of the row of all to a word, the first in its low part
  kRgbe,   ///< a word: red, green, blue from its low end up, times 2^(exponent − 136)
};

/// Of no more than 255 · 2^-126 nothing is told apart from black.
inline constexpr std::uint32_t kLeastRgbeExponent = 10;

inline Vec3 rgbe_texel(std::uint32_t word) {
  const auto scale = std::bit_cast<float>(((word >> 24) - 9u) << 23);
  return Vec3(static_cast<float>(word & 255u) * scale, static_cast<float>(word >> 8 & 255u) * scale,
              static_cast<float>(word >> 16 & 255u) * scale);
}

/// The word of which rgbe_texel is the colour, if there is one; channels are finite and ≥ 0.
inline bool exact_rgbe(const float* rgb, std::uint32_t* word) {
  const float xy = rgb[0] < rgb[1] ? rgb[1] : rgb[0];
  const float largest = xy < rgb[2] ? rgb[2] : xy;
  std::uint32_t exponent = (std::bit_cast<std::uint32_t>(largest) >> 23) + 2u;
  if (exponent < kLeastRgbeExponent) exponent = kLeastRgbeExponent;
  if (exponent > 255u) return false;
  // 2^(136 − exponent), in two steps since it may be beyond the floats
  const auto half_way = std::bit_cast<float>((127u + (136u - exponent) / 2u) << 23);
  const std::uint32_t rest = 136u - exponent - (136u - exponent) / 2u;
  if (exponent > 136u) {
    const auto scale = std::bit_cast<float>((127u + 136u - exponent) << 23);
    const auto r = static_cast<std::uint32_t>(rgb[0] * scale);
    const auto g = static_cast<std::uint32_t>(rgb[1] * scale);
    const auto b = static_cast<std::uint32_t>(rgb[2] * scale);
    *word = r | g << 8 | b << 16 | exponent << 24;
  } else {
    const auto second = std::bit_cast<float>((127u + rest) << 23);
    const auto r = static_cast<std::uint32_t>(rgb[0] * half_way * second);
    const auto g = static_cast<std::uint32_t>(rgb[1] * half_way * second);
    const auto b = static_cast<std::uint32_t>(rgb[2] * half_way * second);
    *word = r | g << 8 | b << 16 | exponent << 24;
  }
  return rgbe_texel(*word) == Vec3(rgb[0], rgb[1], rgb[2]);
}

/// Half number i of a row of words.
inline float packed_half(const std::uint32_t* words, std::uint64_t i) {
  return float_from_half(static_cast<std::uint16_t>(words[i >> 1] >> (16u * (i & 1u))));
}

}  // namespace komorebi
