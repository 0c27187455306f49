#pragma once

#include <cstdint>

#include "core/functions.h"
#include "shader/lane.h"

/// Patterns that need neither noise nor cells with points, one function a texture.
namespace komorebi {

enum class WaveProfile : std::uint32_t { kSine, kSaw, kTriangle };

/// @param angle  in radians; one wave is 2π
inline float wave(WaveProfile profile, float angle) {
  if (profile == WaveProfile::kSine) return 0.5f - 0.5f * fn::cos(angle);
  const float n = angle / kTwoPi;
  if (profile == WaveProfile::kSaw) return n - fn::floor(n);
  return absolute(n - fn::floor(n + 0.5f)) * 2.0f;
}

/// Blender's Magic: sines and cosines of sums of one another, `depth` times (0 to 10).
inline void magic(const float (&p)[3], float scale, float distortion, std::uint32_t depth,
                  float (&color)[3]) {
  const float px = fn::fmod(p[0], kTwoPi), py = fn::fmod(p[1], kTwoPi), pz = fn::fmod(p[2], kTwoPi);
  float x = fn::sin((px + py + pz) * 5.0f * scale);
  float y = fn::cos((-px + py - pz) * 5.0f * scale);
  float z = -fn::cos((-px - py + pz) * 5.0f * scale);
  if (depth > 0) {
    x *= distortion;
    y *= distortion;
    z *= distortion;
  }
  // Each step replaces one of the three.
  for (std::uint32_t step = 1; step <= depth; ++step) {
    switch (step) {
      case 1:
        y = -fn::cos(x - y + z) * distortion;
        break;
      case 2:
        x = fn::cos(x - y - z) * distortion;
        break;
      case 3:
        z = fn::sin(-x - y - z) * distortion;
        break;
      case 4:
        x = -fn::cos(-x + y - z) * distortion;
        break;
      case 5:
        y = -fn::sin(-x + y + z) * distortion;
        break;
      case 6:
        y = -fn::cos(-x + y + z) * distortion;
        break;
      case 7:
        x = fn::cos(x + y + z) * distortion;
        break;
      case 8:
        z = fn::sin(x + y - z) * distortion;
        break;
      case 9:
        x = -fn::cos(-x - y + z) * distortion;
        break;
      default:
        y = -fn::sin(x - y + z) * distortion;
        break;
    }
  }
  const float divisor = distortion != 0.0f ? distortion * 2.0f : 1.0f;
  color[0] = 0.5f - x / divisor;
  color[1] = 0.5f - y / divisor;
  color[2] = 0.5f - z / divisor;
}

enum class GradientType : std::uint32_t {
  kLinear,
  kQuadratic,
  kEasing,
  kDiagonal,
  kRadial,
  kQuadraticSphere,
  kSpherical,
};

/// In [0, 1].
inline float gradient_texture(GradientType type, float x, float y, float z) {
  switch (type) {
    case GradientType::kLinear:
      return clamp01(x);
    case GradientType::kQuadratic:
      return clamp01(larger(x, 0.0f) * larger(x, 0.0f));
    case GradientType::kEasing:
      return smoothstep01(x);
    case GradientType::kDiagonal:
      return clamp01((x + y) * 0.5f);
    case GradientType::kRadial:
      return clamp01(fn::atan2(y, x) / kTwoPi + 0.5f);
    default:
      break;
  }
  const float inside = larger(0.999999f - std::sqrt(x * x + y * y + z * z), 0.0f);
  return clamp01(type == GradientType::kSpherical ? inside : inside * inside);
}

/// Moves coordinates off whole numbers, on which they often lie, as Cycles does.
KOMOREBI_LANE float off_whole(float x) {
  return (x + 0.000001f) * 0.999999f;
}

/// 1 in every other cube.
inline float checker(float x, float y, float z) {
  const std::int32_t sum =
      floor_lane(off_whole(x)) ^ floor_lane(off_whole(y)) ^ floor_lane(off_whole(z));
  return (sum & 1) != 0 ? 1.0f : 0.0f;
}

struct BrickKind {
  float offset = 0.5f, squash = 1.0f;
  std::int32_t offset_frequency = 2, squash_frequency = 2;  ///< 0: neither offset nor squash
};

struct BrickSize {
  float mortar, mortar_smooth, bias, width, row_height;
};

struct Brick {
  float tint, mortar;  ///< 0 to 1
};

inline Brick brick(const BrickKind& kind, const BrickSize& size, float x, float y) {
  const std::int32_t row = floor_lane(y / size.row_height);
  float width = size.width, offset = 0.0f;
  if (kind.offset_frequency != 0 && kind.squash_frequency != 0) {
    if (row % kind.squash_frequency == 0) width *= kind.squash;
    if (row % kind.offset_frequency == 0) offset = width * kind.offset;
  }
  const std::int32_t column = floor_lane((x + offset) / width);
  const float in_x = x + offset - width * static_cast<float>(column);
  const float in_y = y - size.row_height * static_cast<float>(row);

  // A small hash of the brick's number (Elias's integer noise).
  std::uint32_t n =
      (static_cast<std::uint32_t>(row) << 16) + (static_cast<std::uint32_t>(column) & 0xffffu);
  n = (n + 1013u) & 0x7fffffffu;
  n ^= n >> 13;
  n = (n * (n * n * 60493u + 19990303u) + 1376312589u) & 0x7fffffffu;
  const float random = 0.5f * (static_cast<float>(n) / 1073741824.0f);

  const float edge = smaller(smaller(in_x, in_y), smaller(width - in_x, size.row_height - in_y));
  Brick found{clamp01(random + size.bias), 0.0f};
  if (!(edge >= size.mortar)) {
    const float into = 1.0f - edge / size.mortar;
    found.mortar = size.mortar_smooth == 0.0f ? 1.0f : smoothstep01(into / size.mortar_smooth);
  }
  return found;
}

}  // namespace komorebi
