#pragma once

#include "core/warp.h"

namespace komorebi {

/// The opening of a lens as seen from behind the camera, x to the right and y up, its rim at
/// radius 1. With blades it is a regular polygon whose corners lie on that circle.
struct ApertureView {
  std::uint32_t blades = 0;  ///< 0: a disk; otherwise at least 3
  float rotation = 0.0f;     ///< counter-clockwise, in turns, in [0, 1)
  float cos_half = 1.0f;     ///< of half the angle that a side takes: π / blades
  float sin_half = 0.0f;
};

/// A point of the opening, all equally likely, from `u` in [0, 1)². The disk is the concentric map
/// of cosine_hemisphere_disk; a polygon is cut into the triangles between its centre and its sides,
/// where the distance from the centre is the square root of a uniform number (Turk, "Generating
/// Random Points in Triangles", Graphics Gems, 1990).
inline Vec2 aperture_point(const ApertureView& aperture, const Vec2& u) {
  if (aperture.blades == 0) {
    const Vec3 lifted = cosine_hemisphere_disk(u);
    return Vec2(lifted.x, lifted.y);
  }
  const float count = static_cast<float>(aperture.blades);
  const float place = u.x * count;
  float side = static_cast<float>(static_cast<std::int32_t>(place));
  if (side > count - 1.0f) side = count - 1.0f;  // the product may be rounded up
  const float r = std::sqrt(place - side);
  const float x = r * aperture.cos_half;
  const float y = r * ((2.0f * u.y - 1.0f) * aperture.sin_half);
  const auto [sin, cos] = sin_cos_turns(aperture.rotation + side / count);
  return Vec2(cos * x - sin * y, sin * x + cos * y);
}

}  // namespace komorebi
