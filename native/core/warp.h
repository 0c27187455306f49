#pragma once

#include "core/math.h"

/// Maps from the unit square [0,1)² to directions, each with its density by solid angle beside it.
/// The pole is +z. u.x = 0 and u.x → 1 meet without a seam where the first coordinate is an angle.
namespace komorebi {

/// Directions above the plane z = 0, all equally likely. z is u.y, so never below the plane.
inline Vec3 uniform_hemisphere(const Vec2& u) {
  const auto [sin_phi, cos_phi] = sin_cos_turns(u.x);
  const float z = u.y;
  const float r = std::sqrt((1.0f - z) * (1.0f + z));
  return Vec3(r * cos_phi, r * sin_phi, z);
}
inline float uniform_hemisphere_pdf(const Vec3& direction) {
  return direction.z >= 0.0f ? kInvTwoPi : 0.0f;
}

/// Directions above the plane with density cos θ / π, by the inverse transform in polar angles:
/// sin²θ is uniform.
inline Vec3 cosine_hemisphere_polar(const Vec2& u) {
  const auto [sin_phi, cos_phi] = sin_cos_turns(u.x);
  const float r = std::sqrt(u.y);
  return Vec3(r * cos_phi, r * sin_phi, std::sqrt(1.0f - u.y));
}

/// The same density by Malley's method: a uniform point of the disk, lifted. The disk comes from
/// the concentric map (Shirley and Chiu 1997), which keeps neighbours neighbours.
inline Vec3 cosine_hemisphere_disk(const Vec2& u) {
  const float a = 2.0f * u.x - 1.0f;
  const float b = 2.0f * u.y - 1.0f;
  const bool wide = a * a > b * b;
  const float r = wide ? a : b;
  if (r == 0.0f) return Vec3(0.0f, 0.0f, 1.0f);
  const float turns = wide ? 0.125f * (b / a) : 0.25f - 0.125f * (a / b);
  const auto [sin_phi, cos_phi] = sin_cos_turns(turns);
  return Vec3(r * cos_phi, r * sin_phi, std::sqrt((1.0f - r) * (1.0f + r)));
}
inline float cosine_hemisphere_pdf(const Vec3& direction) {
  return direction.z > 0.0f ? direction.z * kInvPi : 0.0f;
}

/// All directions, equally likely.
inline Vec3 uniform_sphere(const Vec2& u) {
  const auto [sin_phi, cos_phi] = sin_cos_turns(u.x);
  const float z = 2.0f * u.y - 1.0f;
  // 1 − z² = 4 u (1 − u), without cancellation at the poles
  const float r = 2.0f * std::sqrt(u.y * (1.0f - u.y));
  return Vec3(r * cos_phi, r * sin_phi, z);
}
inline float uniform_sphere_pdf() {
  return kInvFourPi;
}

/// A right-handed orthonormal frame about a unit normal.
struct Frame {
  Vec3 tangent, bitangent, normal;
  Vec3 to_world(const Vec3& v) const { return v.x * tangent + v.y * bitangent + v.z * normal; }
  Vec3 to_local(const Vec3& v) const {
    return Vec3(glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal));
  }
};

/// Without a branch that degenerates: Duff et al., "Building an Orthonormal Basis, Revisited",
/// JCGT 6(1), 2017. `normal` must have unit length.
inline Frame make_frame(const Vec3& normal) {
  const float sign = normal.z < 0.0f ? -1.0f : 1.0f;
  const float a = -1.0f / (sign + normal.z);
  const float b = normal.x * normal.y * a;
  return {Vec3(1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
          Vec3(b, sign + normal.y * normal.y * a, -normal.y), normal};
}

/// A sample from the density proportional to a + (b − a)·x on [0, 1]; `u` in [0, 1), a, b ≥ 0.
/// Monotone in u; the result is below 1. Uniform when both are 0.
inline float sample_linear(float u, float a, float b) {
  const float largest = a < b ? b : a;
  if (!(largest > 0.0f) || !(u > 0.0f)) return u;
  a /= largest;  // the squares below stay in range
  b /= largest;
  const float x = u * (a + b) / (a + std::sqrt(a * a * (1.0f - u) + b * b * u));
  return x < kOneMinusEpsilon ? x : kOneMinusEpsilon;
}

}  // namespace komorebi
