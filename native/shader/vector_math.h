#pragma once

#include "core/vector.h"
#include "shader/scalar_math.h"

/// What nodes do to vectors.
namespace komorebi::node {

inline float length(const Vec3& v) {
  return std::sqrt(dot(v, v));
}
/// v / |v|; 0 stays 0.
inline Vec3 safe_normalize(const Vec3& v) {
  const float size = length(v);
  return size != 0.0f ? v * (1.0f / size) : v;
}
inline Vec3 unit(const Vec3& v) {
  return safe_normalize(v);
}
inline Vec3 project(const Vec3& a, const Vec3& b) {
  const float size = dot(b, b);
  return size != 0.0f ? b * (dot(a, b) / size) : Vec3(0.0f);
}
inline Vec3 reflect(const Vec3& a, const Vec3& normal) {
  const Vec3 n = unit(normal);
  return a - n * (2.0f * dot(a, n));
}
/// 0 where all is reflected. @param n  unit
inline Vec3 refract(const Vec3& a, const Vec3& n, float eta) {
  const float cosine = dot(n, a);
  const float k = 1.0f - eta * eta * (1.0f - cosine * cosine);
  if (k < 0.0f) return Vec3(0.0f);
  return a * eta - n * (eta * cosine + std::sqrt(k));
}
/// About a unit axis (Rodrigues).
inline Vec3 rotate(const Vec3& v, const Vec3& axis, float angle) {
  const auto [sine, cosine] = fn::sin_cos(angle);
  const auto s = static_cast<float>(sine), c = static_cast<float>(cosine);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1.0f - c));
}
/// About X, then Y, then Z; or back.
inline Vec3 rotate_euler(const Vec3& v, const Vec3& euler, bool back) {
  Vec3 turned = v;
  for (int step = 0; step < 3; ++step) {
    const int axis = back ? 2 - step : step;
    const auto [sine, cosine] = fn::sin_cos(back ? -euler[axis] : euler[axis]);
    const auto s = static_cast<float>(sine), c = static_cast<float>(cosine);
    const int first = (axis + 1) % 3, second = (axis + 2) % 3;
    const float a = turned[first], b = turned[second];
    turned[first] = a * c - b * s;
    turned[second] = a * s + b * c;
  }
  return turned;
}
/// The normal of the world of an object's normal n, by the inverse transpose of its axes.
inline Vec3 normal_from_axes(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& n) {
  const Vec3 yz = cross(y, z);
  const Vec3 normal = yz * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
  return dot(x, yz) < 0.0f ? -normal : normal;
}
/// The v of v.x x + v.y y + v.z z = w; 0 where the axes do not span space.
inline Vec3 solve(const Vec3& x, const Vec3& y, const Vec3& z, const Vec3& w) {
  const Vec3 yz = cross(y, z);
  const float volume = dot(x, yz);
  if (volume == 0.0f) return Vec3(0.0f);
  return Vec3(dot(w, yz), dot(w, cross(z, x)), dot(w, cross(x, y))) * (1.0f / volume);
}

}  // namespace komorebi::node
