#pragma once

#include "core/warp.h"

namespace komorebi {

/// When the light of a sample passes the shutter: 0 opens it, 1 closes it. The curve's density is
/// linear between `cells` + 1 nodes, evenly spaced over [0, 1]; made by ShutterTable
/// (render/shutter.h). cells = 0: open at once and all the time.
struct ShutterView {
  bool still = false;  ///< it stays shut: all is taken at the rest pose, in the middle of the time
  std::uint32_t cells = 0;
  const float* cdf = nullptr;      ///< [cells + 1], from 0 to 1
  const float* density = nullptr;  ///< [cells + 1], of any scale
  /// Rolling shutter: rows of pixels are exposed one after the other, the top one first, each for
  /// `rolling_duration` of the time; the picture's height in pixels, or 0: all at once.
  float rolling_height = 0.0f;
  float rolling_duration = 0.0f;

  bool is_plain() const { return cells == 0 && rolling_height == 0.0f && !still; }
};

/// The inverse transform of the curve, monotone; u in [0, 1). Then the row's delay as Cycles has it
/// (kernel/camera/camera.h); `y` is the sample's full-frame pixel row, 0 at the bottom.
inline float shutter_time(const ShutterView& shutter, float u, std::uint32_t y) {
  if (shutter.still) return 0.5f;
  float time = u;
  if (shutter.cells > 0) {
    std::uint32_t first = 0, count = shutter.cells;  // the last cell whose cdf is ≤ u
    while (count > 1) {
      const std::uint32_t half = count / 2;
      if (shutter.cdf[first + half] <= u) first += half;
      count -= half;
    }
    const float mass = shutter.cdf[first + 1] - shutter.cdf[first];
    const float rest = u - shutter.cdf[first];
    const float t = sample_linear(mass > rest ? rest / mass : kOneMinusEpsilon,
                                  shutter.density[first], shutter.density[first + 1]);
    time = (static_cast<float>(first) + t) / static_cast<float>(shutter.cells);
  }
  if (shutter.rolling_height == 0.0f) return time;
  const float row = 1.0f - static_cast<float>(y) / shutter.rolling_height;
  const float duration = shutter.rolling_duration;
  return (time - 0.5f) * duration + ((row - 0.5f) * (1.0f - duration) + 0.5f);
}

}  // namespace komorebi
