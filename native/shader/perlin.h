#pragma once

#include <cstddef>
#include <cstdint>

#include "shader/hash.h"

namespace komorebi {

namespace detail {

/// The cell of a grid that a point of N dimensions lies in.
template <std::size_t N>
struct PerlinCell {
  std::uint32_t corner[N];  // the lowest
  float in[N];              // place in the cell, 0 to 1
  float blend[N];           // of the two sides: 6t⁵ − 15t⁴ + 10t³
};

// A gradient that a hash chooses, times the vector from its corner.
KOMOREBI_LANE float gradient(std::uint32_t h, float x) {
  const auto slope = static_cast<float>(static_cast<std::int32_t>(1u + (h & 7u)));
  return negate_if(slope, h >> 3) * x;
}
KOMOREBI_LANE float gradient(std::uint32_t h, float x, float y) {
  const bool swap = (h & 4u) != 0;
  const float u = swap ? y : x, v = 2.0f * (swap ? x : y);
  return negate_if(u, h) + negate_if(v, h >> 1);
}
KOMOREBI_LANE float gradient(std::uint32_t h, float x, float y, float z) {
  const float u = (h & 8u) != 0 ? y : x;
  const float other = (h & 13u) == 12u ? x : z;
  const float v = (h & 12u) == 0 ? y : other;
  return negate_if(u, h) + negate_if(v, h >> 1);
}
KOMOREBI_LANE float gradient(std::uint32_t h, float x, float y, float z, float w) {
  const float u = (h & 24u) == 24u ? y : x;
  const float v = (h & 16u) != 0 ? z : y;
  const float s = (h & 24u) != 0 ? w : z;
  return negate_if(u, h) + negate_if(v, h >> 1) + negate_if(s, h >> 2);
}

// The sum over the corners that share the bits of `Corner` from bit D on.
template <std::size_t N, std::size_t D, unsigned Corner>
KOMOREBI_LANE float perlin_blend(const PerlinCell<N>& cell) {
  if constexpr (D > 0) {
    return mix(perlin_blend<N, D - 1, Corner>(cell),
               perlin_blend<N, D - 1, Corner | 1u << (D - 1)>(cell), cell.blend[D - 1]);
  } else {
    constexpr std::uint32_t x = Corner & 1u, y = Corner >> 1 & 1u, z = Corner >> 2 & 1u,
                            w = Corner >> 3 & 1u;
    const auto& k = cell.corner;
    const float* const f = cell.in;
    const float fx = f[0] - static_cast<float>(x);
    if constexpr (N == 1) {
      return gradient(hash_words(k[0] + x), fx);
    } else if constexpr (N == 2) {
      return gradient(hash_words(k[0] + x, k[1] + y), fx, f[1] - static_cast<float>(y));
    } else if constexpr (N == 3) {
      return gradient(hash_words(k[0] + x, k[1] + y, k[2] + z), fx, f[1] - static_cast<float>(y),
                      f[2] - static_cast<float>(z));
    } else {
      return gradient(hash_words(k[0] + x, k[1] + y, k[2] + z, k[3] + w), fx,
                      f[1] - static_cast<float>(y), f[2] - static_cast<float>(z),
                      f[3] - static_cast<float>(w));
    }
  }
}

}  // namespace detail

/// Perlin's noise (2002) of 1 to 4 dimensions, scaled to about [−1, 1] by the factors of Open
/// Shading Language. 0 where a coordinate is beyond what floats tell apart, or NaN.
template <std::size_t N>
KOMOREBI_LANE float perlin(const float (&p)[N]) {
  detail::PerlinCell<N> cell;
  for (std::size_t d = 0; d < N; ++d) {
    const float inside = clamp(p[d], -kMostWhole, kMostWhole);
    const std::int32_t whole = floor_lane(inside);
    const float t = inside - static_cast<float>(whole);
    cell.corner[d] = static_cast<std::uint32_t>(whole);
    cell.in[d] = t;
    cell.blend[d] = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
  }
  constexpr float kScale[] = {0.25f, 0.6616f, 0.9820f, 0.8344f};
  return kScale[N - 1] * detail::perlin_blend<N, N, 0>(cell);
}

/// The same for `count` points, given as N columns of coordinates.
template <std::size_t N>
KOMOREBI_LANE void perlin_loop(const float* const* p, std::uint32_t count, float* __restrict out) {
  for (std::uint32_t i = 0; i < count; ++i) {
    float at[N];
    for (std::size_t d = 0; d < N; ++d) at[d] = p[d][i];
    out[i] = perlin<N>(at);
  }
}

}  // namespace komorebi
