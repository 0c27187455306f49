#pragma once

#include "core/lamp.h"
#include "core/spherical_rectangle.h"
#include "core/warp.h"

namespace komorebi {

namespace detail {

/// A direction of a cone around `axis`, all equally likely.
inline Vec3 cone_direction(const Vec3& axis, float one_minus_cos, const Vec2& u) {
  const float h = one_minus_cos * u.y;
  const float r = std::sqrt(h * (2.0f - h));
  const auto [sin, cos] = sin_cos_turns(u.x);
  return make_frame(axis).to_world(Vec3(r * cos, r * sin, 1.0f - h));
}
inline float cone_pdf(float one_minus_cos) {
  return 1.0f / (kTwoPi * one_minus_cos);
}

/// A point of the unit disk, all equally likely.
inline Vec2 disk_point(const Vec2& u) {
  const Vec3 p = cosine_hemisphere_disk(u);
  return Vec2(p.x, p.y);
}

/// The part of an area lamp's rectangle that a point can get light from, as it sees it.
struct AreaSeen {
  float height = 0.0f;          ///< above the lamp's plane; not positive: it lies behind
  float u = 0.0f, v = 0.0f;     ///< where it stands over the lamp, from the middle
  float u0, u1, v0, v1;         ///< of the part, from the middle; empty: no light
  bool by_solid_angle = false;  ///< else an ellipse's points are drawn by area
};

inline AreaSeen area_seen(const Lamp& lamp, const Vec3& p) {
  AreaSeen seen{};
  const Vec3 from_middle = p - lamp.position;
  seen.height = glm::dot(from_middle, lamp.direction);
  seen.u = glm::dot(from_middle, lamp.axis_u);
  seen.v = glm::dot(from_middle, lamp.axis_v);
  seen.u0 = -lamp.half_u;
  seen.u1 = lamp.half_u;
  seen.v0 = -lamp.half_v;
  seen.v1 = lamp.half_v;
  if (lamp.spread_tangent > 0.0f) {
    const float reach = seen.height * lamp.spread_tangent;
    seen.u0 = max_of(seen.u0, seen.u - reach);
    seen.u1 = min_of(seen.u1, seen.u + reach);
    seen.v0 = max_of(seen.v0, seen.v - reach);
    seen.v1 = min_of(seen.v1, seen.v + reach);
  }
  if (lamp.kind == LampKind::kRectangle) {
    seen.by_solid_angle = true;
    return seen;
  }
  // An ellipse: by solid angle, with misses, where it is near; by area where that makes no odds.
  const float size = max_of(lamp.half_u, lamp.half_v);
  const bool near = glm::dot(from_middle, from_middle) < 16.0f * size * size;
  const float part = (seen.u1 - seen.u0) * (seen.v1 - seen.v0);
  seen.by_solid_angle = near || part < area_of(lamp);
  return seen;
}

inline bool in_ellipse(const Lamp& lamp, float u, float v) {
  const float a = u / lamp.half_u, b = v / lamp.half_v;
  return a * a + b * b <= 1.0f;
}

/// The sample that a point (u, v) of the lamp makes, seen at a density by solid angle, or by area
/// where `solid_angle` is 0.
inline LampSample area_sample(const Lamp& lamp, const AreaSeen& seen, float u, float v,
                              double solid_angle, float area) {
  LampSample sample;
  const float du = u - seen.u, dv = v - seen.v;
  const float square = du * du + dv * dv + seen.height * seen.height;
  sample.distance = std::sqrt(square);
  sample.direction =
      (du * lamp.axis_u + dv * lamp.axis_v - seen.height * lamp.direction) / sample.distance;
  const float cosine = seen.height / sample.distance;
  sample.radiance = lamp.radiance * spread_share(lamp, cosine);
  if (solid_angle > 0.0) {
    sample.pdf = static_cast<float>(1.0 / solid_angle);
  } else {
    sample.pdf = square / (cosine * area);
  }
  return sample;
}

inline SphericalRectangle seen_rectangle(const AreaSeen& seen) {
  return make_spherical_rectangle(static_cast<double>(seen.u0) - static_cast<double>(seen.u),
                                  static_cast<double>(seen.u1) - static_cast<double>(seen.u),
                                  static_cast<double>(seen.v0) - static_cast<double>(seen.v),
                                  static_cast<double>(seen.v1) - static_cast<double>(seen.v),
                                  static_cast<double>(seen.height));
}

inline LampSample sample_area(const Lamp& lamp, const Vec3& p, const Vec2& random) {
  const AreaSeen seen = area_seen(lamp, p);
  if (!(seen.height > 0.0f && seen.u0 < seen.u1 && seen.v0 < seen.v1)) return {};
  if (lamp.spread_tangent < 0.0f) {
    const bool over =
        seen.u >= seen.u0 && seen.u <= seen.u1 && seen.v >= seen.v0 && seen.v <= seen.v1;
    if (!over || (lamp.kind == LampKind::kEllipse && !in_ellipse(lamp, seen.u, seen.v))) return {};
    return {-lamp.direction, seen.height, lamp.radiance, 1.0f};
  }
  if (!seen.by_solid_angle) {
    const Vec2 at = disk_point(random);
    return area_sample(lamp, seen, lamp.half_u * at.x, lamp.half_v * at.y, 0.0, area_of(lamp));
  }
  const SphericalRectangle rectangle = seen_rectangle(seen);
  float u = 0.0f, v = 0.0f;
  if (rectangle.solid_angle > 0.0) {
    const auto at = rectangle.sample(static_cast<double>(random.x), static_cast<double>(random.y));
    u = static_cast<float>(at.x + static_cast<double>(seen.u));
    v = static_cast<float>(at.y + static_cast<double>(seen.v));
  } else {
    u = seen.u0 + random.x * (seen.u1 - seen.u0);
    v = seen.v0 + random.y * (seen.v1 - seen.v0);
  }
  if (lamp.kind == LampKind::kEllipse && !in_ellipse(lamp, u, v)) return {};
  return area_sample(lamp, seen, u, v, rectangle.solid_angle,
                     (seen.u1 - seen.u0) * (seen.v1 - seen.v0));
}

/// 1 − cos of an angle from its squared sine, without cancellation.
inline float one_minus_cos_of(float squared_sine) {
  return squared_sine / (1.0f + std::sqrt(1.0f - squared_sine));
}

inline LampSample sample_sphere(const Lamp& lamp, const Vec3& p, const Vec3& normal,
                                const Vec2& u) {
  const Vec3 to_middle = lamp.position - p;
  const float d2 = glm::dot(to_middle, to_middle), r2 = lamp.radius * lamp.radius;
  LampSample sample;
  sample.radiance = lamp.radiance;
  const bool outside = d2 > r2;
  if (outside) {
    const float one_minus_cos = one_minus_cos_of(r2 / d2);
    sample.direction = cone_direction(to_middle / std::sqrt(d2), one_minus_cos, u);
    sample.pdf = cone_pdf(one_minus_cos);
    sample.radiance *= spot_share(lamp.spot, -sample.direction);
  } else {
    const Vec3 local = cosine_hemisphere_disk(u);
    sample.direction = make_frame(normal).to_world(local);
    sample.pdf = local.z * kInvPi;
  }
  const float along = glm::dot(to_middle, sample.direction);
  const Vec3 beside = to_middle - along * sample.direction;
  const float half = std::sqrt(max_of(r2 - glm::dot(beside, beside), 0.0f));
  sample.distance = max_of(outside ? along - half : along + half, 0.0f);
  return sample;
}

/// A disk that is turned to the point is a cone of directions.
inline LampSample sample_disk(const Lamp& lamp, const Vec3& p, const Vec2& u) {
  const Vec3 to_middle = lamp.position - p;
  const float d2 = glm::dot(to_middle, to_middle), r2 = lamp.radius * lamp.radius;
  if (!(d2 > 0.0f)) return {};
  const Vec3 axis = to_middle / std::sqrt(d2);
  const float one_minus_cos = one_minus_cos_of(r2 / (d2 + r2));
  LampSample sample;
  sample.direction = cone_direction(axis, one_minus_cos, u);
  sample.distance = d2 / glm::dot(to_middle, sample.direction);
  sample.pdf = cone_pdf(one_minus_cos);
  sample.radiance = lamp.radiance * spot_share(lamp.spot, -sample.direction);
  return sample;
}

inline LampSample sample_point(const Lamp& lamp, const Vec3& p) {
  const Vec3 to_lamp = lamp.position - p;
  const float square = glm::dot(to_lamp, to_lamp);
  if (!(square > 0.0f)) return {};
  LampSample sample;
  sample.distance = std::sqrt(square);
  sample.direction = to_lamp / sample.distance;
  sample.radiance = lamp.radiance * (spot_share(lamp.spot, -sample.direction) / square);
  sample.pdf = 1.0f;
  return sample;
}

inline LampSample sample_sun(const Lamp& lamp, const Vec2& u) {
  LampSample sample;
  sample.distance = kFloatMax;
  sample.radiance = lamp.radiance;
  sample.direction = lamp.direction;
  sample.pdf = 1.0f;
  if (lamp.kind == LampKind::kSun) {
    sample.direction = cone_direction(lamp.direction, lamp.one_minus_cos, u);
    sample.pdf = cone_pdf(lamp.one_minus_cos);
  } else if (lamp.kind == LampKind::kTangentSun) {
    const Frame frame = make_frame(lamp.direction);
    const Vec2 at = lamp.radius * disk_point(u);
    const Vec3 to = lamp.direction + at.x * frame.tangent + at.y * frame.bitangent;
    const float length = std::sqrt(glm::dot(to, to));
    sample.direction = to / length;
    // Density over the disk is even, and so is `radiance`: both are brighter by solid angle.
    const float brighter = length * length * length;
    sample.radiance *= brighter;
    sample.pdf = brighter / (kPiFloat * lamp.radius * lamp.radius);
  }
  return sample;
}

}  // namespace detail

namespace detail {

inline LampSample sample_kind(const Lamp& lamp, const Vec3& p, const Vec3& normal, const Vec2& u) {
  switch (lamp.kind) {
    case LampKind::kSphere:
      return sample_sphere(lamp, p, normal, u);
    case LampKind::kDisk:
      return sample_disk(lamp, p, u);
    case LampKind::kPoint:
      return sample_point(lamp, p);
    case LampKind::kRectangle:
    case LampKind::kEllipse:
      return sample_area(lamp, p, u);
    default:
      return sample_sun(lamp, u);
  }
}

}  // namespace detail

/// Draws a direction in which light of `lamp` may come to a point with this shading normal, by
/// solid angle wherever that is known.
inline LampSample sample_lamp(const Lamp& lamp, const Vec3& p, const Vec3& normal, const Vec2& u) {
  LampSample sample = detail::sample_kind(lamp, p, normal, u);
  if (lamp.falloff.exists()) sample.radiance *= lamp.falloff.at(sample.distance);
  return sample;
}

}  // namespace komorebi
