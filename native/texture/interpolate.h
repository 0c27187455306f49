#pragma once

#include <cstdint>

#include "core/vector.h"
#include "texture/sampling.h"

/// Looking up a place between texels, as Cycles does it: texel centres at halves, the same order of
/// sums, and cubic interpolation by uniform B-splines.
namespace komorebi {

/// A place along one side of a picture: the texel to its left, and how far it is from there. Exact
/// whole numbers below 0 count as the end of the texel before, as in Cycles.
struct TexelPlace {
  std::int32_t texel;
  float fraction;
};
inline TexelPlace texel_place(float x) {
  // Far beyond what Cycles could tell apart, and 0 for a NaN.
  if (!(x > -1e9f && x < 1e9f)) return {0, 0.0f};
  const std::int32_t texel = static_cast<std::int32_t>(x) - (x < 0.0f ? 1 : 0);
  return {texel, x - static_cast<float>(texel)};
}

/// The texel that stands for number x of `count`; what CLIP leaves out stays outside.
inline std::int32_t extended(Extension extension, std::int32_t x, std::int32_t count) {
  switch (extension) {
    case Extension::kRepeat: {
      const std::int32_t rest = x % count;
      return rest < 0 ? rest + count : rest;
    }
    case Extension::kExtend:
      return x < 0 ? 0 : x < count ? x : count - 1;
    case Extension::kMirror: {
      const std::int32_t away = x < 0 ? -(x + 1) : x;
      const std::int32_t rest = away % (2 * count);
      return rest < count ? rest : 2 * count - rest - 1;
    }
    default:
      return x;
  }
}

template <class Reader>
Vec4 look_up_closest(const Reader& texel, Extension extension, float u, float v) {
  const auto x = texel_place(u * static_cast<float>(texel.width));
  const auto y = texel_place(v * static_cast<float>(texel.height));
  return texel.clipped(extended(extension, x.texel, texel.width),
                       extended(extension, y.texel, texel.height));
}

template <class Reader>
Vec4 look_up_linear(const Reader& texel, Extension extension, float u, float v) {
  const auto x = texel_place(u * static_cast<float>(texel.width) - 0.5f);
  const auto y = texel_place(v * static_cast<float>(texel.height) - 0.5f);
  const float s = x.fraction, t = y.fraction;
  const auto weighed = [&](const Vec4& a, const Vec4& b, const Vec4& c, const Vec4& d) {
    return (1.0f - t) * (1.0f - s) * a + (1.0f - t) * s * b + t * (1.0f - s) * c + t * s * d;
  };
  const std::int32_t left = extended(extension, x.texel, texel.width);
  const std::int32_t right = extended(extension, x.texel + 1, texel.width);
  const std::int32_t low = extended(extension, y.texel, texel.height);
  const std::int32_t high = extended(extension, y.texel + 1, texel.height);
  if (extension == Extension::kClip) {
    return weighed(texel.clipped(left, low), texel.clipped(right, low), texel.clipped(left, high),
                   texel.clipped(right, high));
  }
  return weighed(texel(left, low), texel(right, low), texel(left, high), texel(right, high));
}

struct SplineWeights {
  float w[4];
  explicit SplineWeights(float t)
      : w{(((-1.0f / 6.0f) * t + 0.5f) * t - 0.5f) * t + (1.0f / 6.0f),
          ((0.5f * t - 1.0f) * t) * t + (2.0f / 3.0f),
          ((-0.5f * t + 0.5f) * t + 0.5f) * t + (1.0f / 6.0f), (1.0f / 6.0f) * t * t * t} {}
};

template <class Reader>
Vec4 look_up_cubic(const Reader& texel, Extension extension, float u, float v) {
  const auto x = texel_place(u * static_cast<float>(texel.width) - 0.5f);
  const auto y = texel_place(v * static_cast<float>(texel.height) - 0.5f);
  std::int32_t columns[4], rows[4];
  for (std::int32_t i = 0; i < 4; ++i) {
    columns[i] = extended(extension, x.texel + i - 1, texel.width);
    rows[i] = extended(extension, y.texel + i - 1, texel.height);
  }
  const SplineWeights across(x.fraction), up(y.fraction);
  Vec4 sum(0.0f);
  for (int r = 0; r < 4; ++r) {
    Vec4 row = across.w[0] * texel.clipped(columns[0], rows[r]);
    for (int c = 1; c < 4; ++c) row += across.w[c] * texel.clipped(columns[c], rows[r]);
    sum += up.w[r] * row;
  }
  return sum;
}

template <class Reader>
Vec4 look_up(const Reader& texel, const TextureSampling& how, float u, float v) {
  switch (how.interpolation) {
    case Interpolation::kClosest:
      return look_up_closest(texel, how.extension, u, v);
    case Interpolation::kLinear:
      return look_up_linear(texel, how.extension, u, v);
    default:  // Smart is cubic wherever nothing but a colour is asked for
      return look_up_cubic(texel, how.extension, u, v);
  }
}

}  // namespace komorebi
