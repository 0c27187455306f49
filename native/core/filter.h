#pragma once

#include "core/warp.h"

namespace komorebi {

/// How a pixel weighs the light around its centre, as Cycles has them (scene/film.cpp): w is the
/// filter width in pixels.
enum class PixelFilter : std::uint32_t {
  kBlackmanHarris = 0,  ///< the four-term window on ±w
  kGaussian = 1,        ///< exp(−8x²/w²), cut at ±1.5w
  kBox = 2,             ///< one pixel, whatever w
};

/// A symmetric, separable filter's density on one half axis: linear between `cells` + 1 nodes,
/// evenly spaced over [0, radius]. Made by FilterTable (render/filter.h). cells = 0 is a box.
struct FilterView {
  float radius = 0.5f;  ///< support in pixels from the centre
  std::uint32_t cells = 0;
  const float* cdf = nullptr;      ///< [cells + 1], from 0 to 1, the half axis being all
  const float* density = nullptr;  ///< [cells + 1], per pixel; half of it lies on either side
};

/// The density of one coordinate of the offset, in 1 / pixels.
inline float filter_pdf(const FilterView& filter, float x) {
  const float distance = x < 0.0f ? -x : x;
  if (distance >= filter.radius) return 0.0f;
  if (filter.cells == 0) return 1.0f;
  const float position = distance / filter.radius * static_cast<float>(filter.cells);
  auto cell = static_cast<std::uint32_t>(position);
  if (cell >= filter.cells) cell = filter.cells - 1;
  const float t = position - static_cast<float>(cell);
  return 0.5f * (filter.density[cell] * (1.0f - t) + filter.density[cell + 1] * t);
}

/// The inverse transform for one coordinate: u in [0, 1) → offset in (−radius, radius), monotone in
/// u. The grid of u is moved by half a step, 2^-25, so that the offsets are symmetric to the bit.
inline float sample_filter(const FilterView& filter, float u) {
  const float s = (2.0f * u - 1.0f) + 5.9604644775390625e-8f;
  if (filter.cells == 0) return filter.radius * s;
  const float target = s < 0.0f ? -s : s;
  std::uint32_t first = 0, count = filter.cells;  // the last cell whose cdf is ≤ target
  while (count > 1) {
    const std::uint32_t half = count / 2;
    if (filter.cdf[first + half] <= target) first += half;
    count -= half;
  }
  const float mass = filter.cdf[first + 1] - filter.cdf[first];
  const float rest = target - filter.cdf[first];
  const float t = sample_linear(mass > rest ? rest / mass : kOneMinusEpsilon, filter.density[first],
                                filter.density[first + 1]);
  const float x =
      filter.radius * ((static_cast<float>(first) + t) / static_cast<float>(filter.cells));
  return s < 0.0f ? -x : x;
}

/// A sample's offset from the pixel's centre, in pixels, with the filter as its density: all
/// samples of a pixel weigh the same, and no pixel needs its neighbours.
inline Vec2 sample_filter(const FilterView& filter, const Vec2& u) {
  return Vec2(sample_filter(filter, u.x), sample_filter(filter, u.y));
}

}  // namespace komorebi
