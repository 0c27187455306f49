#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

/// The sRGB curve (IEC 61966-2-1) as Cycles has it in its image textures, without libm.
namespace komorebi {

/// x^(1/5) for normal x > 0. Relative error ≤ 3e-7.
inline float fifth_root(float x) {
  // a fifth of the exponent, within 4 %; three steps of Newton's iteration square that each time
  float y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) / 5u + 0x32c9af22u);
  for (int i = 0; i < 3; ++i) {
    const float y2 = y * y;
    y = 0.8f * y + 0.2f * (x / (y2 * y2));
  }
  return y;
}

/// x^(1/3) for normal x > 0. Relative error ≤ 3e-7.
inline float cube_root(float x) {
  float y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) / 3u + 0x2a5119f2u);
  for (int i = 0; i < 3; ++i) y = (2.0f / 3.0f) * y + (1.0f / 3.0f) * (x / (y * y));
  return y;
}

/// Linear light of an encoded value; 0 below 0, and continued above 1. Relative error ≤ 1e-6 for
/// values ≤ 1e10 (beyond, its powers leave the range of floats).
inline float srgb_to_linear(float encoded) {
  if (encoded < 0.04045f) return encoded > 0.0f ? encoded * (1.0f / 12.92f) : 0.0f;
  const float a = (encoded + 0.055f) * (1.0f / 1.055f);
  const float root = fifth_root(a);
  return a * a * (root * root);
}

/// The encoded value of linear light, likewise. Relative error ≤ 1e-6.
inline float linear_to_srgb(float linear) {
  if (linear < 0.0031308f) return linear > 0.0f ? linear * 12.92f : 0.0f;
  const float c = cube_root(linear);  // x^(5/12) = c · c^(1/4)
  return 1.055f * (c * std::sqrt(std::sqrt(c))) - 0.055f;
}

}  // namespace komorebi
