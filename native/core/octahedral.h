#pragma once

#include "core/math.h"

/// The octahedral map between unit vectors and the square [−1, 1]² (Cigolle et al. 2014, "A Survey
/// of Efficient Representations for Independent Unit Vectors", JCGT 3(2)): |x| + |y| + |z| = 1,
/// seen from above, the lower half folded out over the diagonals.
namespace komorebi {

inline Vec2 octahedral_from_direction(const Vec3& d) {
  const float ax = d.x < 0.0f ? -d.x : d.x;
  const float ay = d.y < 0.0f ? -d.y : d.y;
  const float az = d.z < 0.0f ? -d.z : d.z;
  const float sum = (ax + ay) + az;
  const float x = d.x / sum, y = d.y / sum;
  if (!(d.z < 0.0f)) return Vec2(x, y);
  const float folded_x = 1.0f - ay / sum, folded_y = 1.0f - ax / sum;
  return Vec2(d.x < 0.0f ? -folded_x : folded_x, d.y < 0.0f ? -folded_y : folded_y);
}

/// Not of unit length.
inline Vec3 direction_from_octahedral(const Vec2& p) {
  const float ax = p.x < 0.0f ? -p.x : p.x;
  const float ay = p.y < 0.0f ? -p.y : p.y;
  const float z = (1.0f - ax) - ay;
  if (!(z < 0.0f)) return Vec3(p.x, p.y, z);
  return Vec3(p.x < 0.0f ? ay - 1.0f : 1.0f - ay, p.y < 0.0f ? ax - 1.0f : 1.0f - ax, z);
}

/// Which cell of an n × n grid over the square the direction falls into; row by row.
inline std::uint32_t octahedral_cell(const Vec3& d, std::uint32_t n) {
  const Vec2 p = octahedral_from_direction(d);
  const float half = 0.5f * static_cast<float>(n);
  const float last = static_cast<float>(n - 1);
  const float x = half + half * p.x, y = half + half * p.y;
  const auto column = static_cast<std::uint32_t>(x > 0.0f ? (x < last ? x : last) : 0.0f);
  const auto row = static_cast<std::uint32_t>(y > 0.0f ? (y < last ? y : last) : 0.0f);
  return row * n + column;
}

}  // namespace komorebi
