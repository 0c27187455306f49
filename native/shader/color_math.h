#pragma once

#include "core/vector.h"
#include "shader/scalar_math.h"

/// What nodes do to colours.
namespace komorebi::node {

/// Hue, saturation and value.
inline Vec3 rgb_to_hsv(const Vec3& c) {
  const float high = most(c.x, most(c.y, c.z)), low = least(c.x, least(c.y, c.z));
  const float range = high - low;
  const float saturation = high != 0.0f ? range / high : 0.0f;
  float hue = 0.0f;
  if (saturation != 0.0f) {
    const Vec3 d = (Vec3(high) - c) / range;
    if (c.x == high) {
      hue = d.z - d.y;
    } else if (c.y == high) {
      hue = 2.0f + d.x - d.z;
    } else {
      hue = 4.0f + d.y - d.x;
    }
    hue /= 6.0f;
    if (hue < 0.0f) hue += 1.0f;
  }
  return Vec3(hue, saturation, high);
}

inline Vec3 hsv_to_rgb(const Vec3& hsv) {
  const float s = hsv.y, v = hsv.z;
  if (s == 0.0f) return Vec3(v);
  const float h = hsv.x == 1.0f ? 0.0f : hsv.x * 6.0f;
  const float sector = fn::floor(h), f = h - sector;
  const float p = v * (1.0f - s), q = v * (1.0f - s * f), t = v * (1.0f - s * (1.0f - f));
  if (sector == 0.0f) return Vec3(v, t, p);
  if (sector == 1.0f) return Vec3(q, v, p);
  if (sector == 2.0f) return Vec3(p, v, t);
  if (sector == 3.0f) return Vec3(p, q, v);
  if (sector == 4.0f) return Vec3(t, p, v);
  return Vec3(v, p, q);
}

/// Hue, saturation and lightness.
inline Vec3 rgb_to_hsl(const Vec3& c) {
  const float high = most(c.x, most(c.y, c.z)), low = least(c.x, least(c.y, c.z));
  const float lightness = least(1.0f, (high + low) * 0.5f);
  if (high == low) return Vec3(0.0f, 0.0f, lightness);
  const float range = high - low;
  const float saturation = range / (lightness > 0.5f ? 2.0f - high - low : high + low);
  float hue;
  if (high == c.x) {
    hue = (c.y - c.z) / range + (c.y < c.z ? 6.0f : 0.0f);
  } else if (high == c.y) {
    hue = (c.z - c.x) / range + 2.0f;
  } else {
    hue = (c.x - c.y) / range + 4.0f;
  }
  return Vec3(hue / 6.0f, saturation, lightness);
}

inline Vec3 hsl_to_rgb(const Vec3& hsl) {
  const float h = hsl.x * 6.0f;
  const float chroma = (1.0f - fn::abs(2.0f * hsl.z - 1.0f)) * hsl.y;
  const Vec3 pure(clamp01(fn::abs(h - 3.0f) - 1.0f), clamp01(2.0f - fn::abs(h - 2.0f)),
                  clamp01(2.0f - fn::abs(h - 4.0f)));
  return (pure - Vec3(0.5f)) * chroma + Vec3(hsl.z);
}

inline Vec3 mix(float t, const Vec3& a, const Vec3& b) {
  return a + (b - a) * t;
}

/// The hue 0.5 turns by nothing.
inline Vec3 hue_saturation(const Vec3& c, float hue, float saturation, float value, float factor) {
  Vec3 hsv = rgb_to_hsv(c);
  hsv.x = fn::fract(hsv.x + hue + 0.5f);
  hsv.y = clamp01(hsv.y * saturation);
  hsv.z *= value;
  const Vec3 turned = hsv_to_rgb(hsv) * factor + c * (1.0f - factor);
  return Vec3(most(turned.x, 0.0f), most(turned.y, 0.0f), most(turned.z, 0.0f));
}

inline float gamma(float x, float exponent) {
  if (exponent == 0.0f) return 1.0f;
  return x > 0.0f ? fn::pow(x, exponent) : x;
}

// Blending channel by channel: t, a, b.

inline float blend_screen(float t, float a, float b) {
  return 1.0f - (1.0f - t + t * (1.0f - b)) * (1.0f - a);
}
inline float blend_overlay(float t, float a, float b) {
  if (a < 0.5f) return a * (1.0f - t + 2.0f * t * b);
  return 1.0f - (1.0f - t + 2.0f * t * (1.0f - b)) * (1.0f - a);
}
inline float blend_divide(float t, float a, float b) {
  return b != 0.0f ? (1.0f - t) * a + t * a / b : a;
}
inline float blend_dodge(float t, float a, float b) {
  if (a == 0.0f) return a;
  const float rest = 1.0f - t * b;
  return rest <= 0.0f ? 1.0f : least(a / rest, 1.0f);
}
inline float blend_burn(float t, float a, float b) {
  const float rest = 1.0f - t + t * b;
  return rest <= 0.0f ? 0.0f : clamp(1.0f - (1.0f - a) / rest, 0.0f, 1.0f);
}
inline float blend_soft_light(float t, float a, float b) {
  const float screen = 1.0f - (1.0f - b) * (1.0f - a);
  return (1.0f - t) * a + t * ((1.0f - a) * b * a + a * screen);
}
inline float blend_linear_light(float t, float a, float b) {
  return a + t * (2.0f * b - 1.0f);
}
inline float blend_exclusion(float t, float a, float b) {
  return most(a + t * (a + b - 2.0f * a * b - a), 0.0f);
}

// Blending of what colours are in HSV.

inline Vec3 blend_hue(float t, const Vec3& a, const Vec3& b) {
  const Vec3 other = rgb_to_hsv(b);
  if (other.y == 0.0f) return a;
  const Vec3 own = rgb_to_hsv(a);
  return mix(t, a, hsv_to_rgb(Vec3(other.x, own.y, own.z)));
}
inline Vec3 blend_saturation(float t, const Vec3& a, const Vec3& b) {
  const Vec3 own = rgb_to_hsv(a);
  if (own.y == 0.0f) return a;
  return hsv_to_rgb(Vec3(own.x, (1.0f - t) * own.y + t * rgb_to_hsv(b).y, own.z));
}
inline Vec3 blend_value(float t, const Vec3& a, const Vec3& b) {
  const Vec3 own = rgb_to_hsv(a);
  return hsv_to_rgb(Vec3(own.x, own.y, (1.0f - t) * own.z + t * rgb_to_hsv(b).z));
}
inline Vec3 blend_color(float t, const Vec3& a, const Vec3& b) {
  const Vec3 other = rgb_to_hsv(b);
  if (other.y == 0.0f) return a;
  return mix(t, a, hsv_to_rgb(Vec3(other.x, other.y, rgb_to_hsv(a).z)));
}

}  // namespace komorebi::node
