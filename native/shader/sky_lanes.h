#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/functions.h"

/// What the air's tables need by the million, without branches, so that compilers make vectors of
/// loops over these.
namespace komorebi {

/// e^x for −1e6 < x < 88, relative error ≤ 3e-7 · (1 + |x|); 0 below 1e-38.
inline float exp_lane(float x) {
  const float bits = x * 1.442695041f;
  const auto k = static_cast<std::int32_t>(bits + 128.5f) - 128;
  const float r = bits - static_cast<float>(k);
  const float value =
      1.0f + r * (0.693147181f +
                  r * (0.240226507f +
                       r * (0.0555041087f +
                            r * (0.00961812911f + r * (0.00133335581f + r * 0.000154035304f)))));
  return value * std::bit_cast<float>(std::max(k + 127, 0) << 23);
}

/// log x of a normal number, error ≤ 2e-7 · (1 + |log x|).
inline float log_lane(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const float m = std::bit_cast<float>((bits & 0x7fffff) | 0x3f800000);
  const float s = (m - 1.0f) / (m + 1.0f), z = s * s;  // log m = 2 atanh s
  const float ratio =
      1.0f +
      z * (1.0f / 3 +
           z * (1.0f / 5 + z * (1.0f / 7 + z * (1.0f / 9 + z * (1.0f / 11 + z * (1.0f / 13))))));
  return 2.0f * s * ratio + 0.693147181f * static_cast<float>((bits >> 23) - 127);
}

/// x, or 0 where it is below.
inline float above_zero(float x) {
  return 0.5f * (x + fn::abs(x));
}

/// How far from the surface of a sphere what is r from its centre is; excess: r² − radius², below
/// 0.04 radius². Negative inside of it, exactly only near the surface.
inline float height_over(float radius, float excess) {
  const float x = excess * (1.0f / (radius * radius));
  return radius * x *
         (0.5f - x * (0.125f - x * (0.0625f - x * (5.0f / 128.0f - x * (7.0f / 256.0f)))));
}

}  // namespace komorebi
