#pragma once

#include "core/functions.h"

/// What nodes do to numbers, as Cycles has it where it leaves the C library's way: nothing is
/// divided by 0, and no root, power or logarithm is taken of what has none.
namespace komorebi::node {

inline float divide(float a, float b) {
  return b != 0.0f ? a / b : 0.0f;
}
inline float least(float a, float b) {
  return a < b ? a : b;
}
inline float most(float a, float b) {
  return a > b ? a : b;
}
inline float clamp(float x, float low, float high) {
  return least(most(x, low), high);
}
inline float clamp01(float x) {
  return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f;
}
inline float power(float a, float b) {
  return a < 0.0f && b != fn::trunc(b) ? 0.0f : fn::pow(a, b);
}
inline float logarithm(float a, float b) {
  if (!(a > 0.0f) || !(b > 0.0f)) return 0.0f;
  return divide(fn::log(a), fn::log(b));
}
inline float square_root(float x) {
  return x > 0.0f ? std::sqrt(x) : 0.0f;
}
inline float inverse_sqrt(float x) {
  return x > 0.0f ? 1.0f / std::sqrt(x) : 0.0f;
}
inline float modulo(float a, float b) {
  return b != 0.0f ? fn::fmod(a, b) : 0.0f;
}
inline float floored_modulo(float a, float b) {
  return b != 0.0f ? a - fn::floor(a / b) * b : 0.0f;
}
inline float snap(float a, float b) {
  return fn::floor(divide(a, b)) * b;
}
inline float wrap(float x, float high, float low) {
  const float range = high - low;
  return range != 0.0f ? x - range * fn::floor((x - low) / range) : low;
}
inline float ping_pong(float x, float scale) {
  if (scale == 0.0f) return 0.0f;
  return fn::abs(fn::fract((x - scale) / (scale * 2.0f)) * scale * 2.0f - scale);
}
/// min(a, b), rounded off by a cubic where they are nearer than `distance`.
inline float smooth_min(float a, float b, float distance) {
  if (distance == 0.0f) return least(a, b);
  const float h = most(distance - fn::abs(a - b), 0.0f) / distance;
  return least(a, b) - h * h * h * distance * (1.0f / 6.0f);
}
inline float smooth_max(float a, float b, float distance) {
  return -smooth_min(-a, -b, distance);
}
inline float sign(float x) {
  return x == 0.0f ? 0.0f : (x < 0.0f ? -1.0f : 1.0f);
}
inline float compare(float a, float b, float epsilon) {
  return a == b || fn::abs(a - b) <= most(epsilon, std::numeric_limits<float>::epsilon()) ? 1.0f
                                                                                          : 0.0f;
}
inline float arcsine(float x) {
  return fn::asin(clamp(x, -1.0f, 1.0f));
}
inline float arccosine(float x) {
  return fn::acos(clamp(x, -1.0f, 1.0f));
}
inline float smoothstep(float t) {
  return (3.0f - 2.0f * t) * (t * t);
}
inline float smootherstep(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

}  // namespace komorebi::node
