#pragma once

#include "core/aabb.h"
#include "core/math.h"

namespace komorebi {

/// What light comes from besides the world. The kinds are those of Cycles' releases, of which each
/// converts a lamp's power in its own way (addon/komorebi/export/lamps.py does so).
enum class LampKind : std::uint32_t {
  kSun,         ///< even radiance over a cone of directions
  kTangentSun,  ///< Cycles 3.x: even over a disk on the plane that touches the sphere of directions
  kDirection,   ///< parallel rays; `radiance` is the irradiance across them
  kSphere,
  kDisk,       ///< turned to whatever it lights
  kPoint,      ///< without size; `radiance` is radiant intensity
  kRectangle,  ///< shines on one side
  kEllipse,    ///< the same
};

enum LampFlag : std::uint32_t {
  kLampNoShadow = 1u << 0,      ///< nothing is in its way
  kLampSkipsCatcher = 1u << 1,  ///< not there where shadow catchers are lit alone
};

/// A cone that light is kept in: Blender's spot. Directions are of the lamp's own space, where z is
/// along the axis: a stretched lamp has an elliptical cone.
struct Spot {
  Mat3 local_from_world{1.0f};
  float stretch = 1.0f;           ///< at least the most that local_from_world makes of a length
  float cosine = -2.0f;           ///< of half the angle; −2: no spot
  float blend = 0.0f;             ///< cosines over which its rim fades
  bool scales_by_cosine = false;  ///< Cycles 3.x
};

/// How light falls off with the distance d but for what distance does by itself: by
/// d^power · d² / (d² + smooth), of Cycles' node Light Falloff.
struct Falloff {
  std::uint32_t power = 0;  ///< 0 to 2: quadratic, linear, constant
  float smooth = 0.0f;      ///< square metres

  bool exists() const { return power > 0 || smooth > 0.0f; }
  float at(float d) const {
    const float d2 = d * d;
    const float factor = power == 0 ? 1.0f : power == 1 ? d : d2;
    return smooth > 0.0f ? factor * (d2 / (d2 + smooth)) : factor;
  }
};

inline constexpr std::uint32_t kMostBounces = 1024;

/// A lamp as it is sampled, in the scene's space.
struct Lamp {
  LampKind kind = LampKind::kPoint;
  std::uint32_t flags = 0;
  std::uint32_t max_bounces = kMostBounces;  ///< it lights no vertex of a path beyond that
  Falloff falloff;                           ///< none of what is distant
  Vec3 radiance{0.0f};                       ///< or what its kind says; may be negative
  Vec3 position{0.0f};                       ///< of the middle
  Vec3 direction{0.0f, 0.0f, 1.0f};  ///< a sun: to the light; an area: where it shines; unit
  float radius = 0.0f;               ///< of sphere and disk; of a tangent sun: the tangent
  float one_minus_cos = 0.0f;        ///< of a sun's angular radius
  Vec3 axis_u{1.0f, 0.0f, 0.0f}, axis_v{0.0f, 1.0f, 0.0f};  ///< of an area, unit
  float half_u = 0.0f, half_v = 0.0f;
  /// Of an area that does not shine to all sides: a lamp shows less and less of itself to
  /// directions away from its axis, none at the angle with this tangent (Cycles' soft-box grid);
  /// 0: to all sides, negative: along its axis alone.
  float spread_tangent = 0.0f;
  float spread_factor = 1.0f;
  Spot spot;
};

/// What arrives from a direction.
struct LampSample {
  Vec3 direction{0.0f};
  float distance = 0.0f;  ///< to the lamp; the largest float: beyond everything
  Vec3 radiance{0.0f};
  /// By solid angle; 0: no light comes. Of lamps without a solid angle it is 1, and `radiance` what
  /// the integral over them comes to.
  float pdf = 0.0f;
};

inline bool is_distant(LampKind kind) {
  return kind <= LampKind::kDirection;
}
inline bool is_area(LampKind kind) {
  return kind >= LampKind::kRectangle;
}
/// Whether no ray but one that is aimed at it can meet it.
inline bool is_delta(const Lamp& lamp) {
  return lamp.kind == LampKind::kDirection || lamp.kind == LampKind::kPoint ||
         (is_area(lamp.kind) && lamp.spread_tangent < 0.0f);
}
inline float area_of(const Lamp& lamp) {
  const float rectangle = 4.0f * lamp.half_u * lamp.half_v;
  return lamp.kind == LampKind::kEllipse ? rectangle * (0.25f * kPiFloat) : rectangle;
}

/// The share of a spot's light that goes at this cosine to its axis, in its own space.
inline float spot_share_at(const Spot& spot, float cosine) {
  const float above = cosine - spot.cosine;
  if (!(above > 0.0f)) return 0.0f;
  const float x = above < spot.blend ? above / spot.blend : 1.0f;
  const float smooth = x * x * (3.0f - 2.0f * x);
  return spot.scales_by_cosine ? smooth * cosine : smooth;
}

/// The share of a spot's light that goes in a direction (unit, from the lamp, world space).
inline float spot_share(const Spot& spot, const Vec3& from_lamp) {
  if (spot.cosine < -1.0f) return 1.0f;
  const Vec3 local = spot.local_from_world * from_lamp;
  const float length = std::sqrt(glm::dot(local, local));
  return length > 0.0f ? spot_share_at(spot, local.z / length) : 0.0f;
}

/// The share of an area's radiance that is seen at a cosine > 0 to its axis.
inline float spread_share(const Lamp& lamp, float cosine) {
  if (lamp.spread_tangent == 0.0f) return 1.0f;
  const float c = cosine < 1.0f ? cosine : 1.0f;
  const float tangent = std::sqrt((1.0f - c) * (1.0f + c)) / c;
  return max_of((lamp.spread_tangent - tangent) * lamp.spread_factor, 0.0f);
}

}  // namespace komorebi
