#pragma once

#include <limits>

#include "core/math.h"

/// The functions that shader nodes need, of any float, with the special values of the C library
/// (`round` takes halves away from 0; −0 is not told from 0). They are worked out in double, so
/// that errors stay below 0.51 units in the last place, but for angles beyond a turn: these are
/// divided by 2π in double, with an absolute error of 2e-16 · |x|.
/// tests/cpp/core/functions_test.cpp holds them beside libm.
namespace komorebi::fn {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

inline float abs(float x) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) & 0x7fffffffu);
}

namespace detail {
// Of these on, all floats are whole.
constexpr float kWhole = 8388608.0f;

// e^x as a float, with what is too large or small for one.
inline float exp_to_float(double x) {
  if (x > 89.0) return kInfinity;
  if (x < -104.0) return 0.0f;
  return x == x ? static_cast<float>(exp_double(x)) : kNaN;
}
}  // namespace detail

inline float trunc(float x) {
  return abs(x) < detail::kWhole ? static_cast<float>(static_cast<std::int32_t>(x)) : x;
}
inline float floor(float x) {
  return abs(x) < detail::kWhole ? static_cast<float>(floor_to_int(x)) : x;
}
inline float ceil(float x) {
  return -floor(-x);
}
inline float round(float x) {
  if (!(abs(x) < detail::kWhole)) return x;
  const float whole = trunc(x);
  return abs(x - whole) < 0.5f ? whole : whole + (x < 0.0f ? -1.0f : 1.0f);
}
inline float fract(float x) {
  return x - floor(x);
}

/// What is left of a / b, with the sign of a; exact. NaN for b = 0.
inline float fmod(float a, float b) {
  if (!is_finite(a) || b == 0.0f || b != b) return kNaN;
  if (!is_finite(b)) return a;
  const double divisor = abs(b);
  double rest = abs(a);
  while (rest >= divisor) {
    double step = divisor;  // so large that all of the quotient's bits fit a double's product
    while (rest >= step * 0x1p28) step *= 0x1p28;
    rest -= static_cast<double>(static_cast<std::int64_t>(rest / step)) * step;
    if (rest < 0.0) rest += step;
  }
  return static_cast<float>(a < 0.0f ? -rest : rest);
}

inline float exp(float x) {
  return detail::exp_to_float(x);
}
inline float exp2(float x) {
  return detail::exp_to_float(double{x} * 0.6931471805599453094172321);
}
/// −∞ of 0, NaN of what is below.
inline float log(float x) {
  if (!(x > 0.0f)) return x == 0.0f ? -kInfinity : kNaN;
  return is_finite(x) ? static_cast<float>(log_double(x)) : x;
}
inline float log2(float x) {
  if (!(x > 0.0f) || !is_finite(x)) return log(x);
  return static_cast<float>(log_double(x) * 1.4426950408889634073599247);
}
/// a^b: NaN for a < 0 unless b is whole.
inline float pow(float a, float b) {
  if (b == 0.0f || a == 1.0f) return 1.0f;
  if (a != a || b != b) return kNaN;
  const bool is_odd =
      abs(b) < 16777216.0f && trunc(b) == b && (static_cast<std::int32_t>(b) & 1) != 0;
  if (a < 0.0f && is_finite(a) && trunc(b) != b) return kNaN;
  float power;
  if (a == 0.0f) {
    power = b > 0.0f ? 0.0f : kInfinity;
  } else if (!is_finite(a)) {
    power = b > 0.0f ? kInfinity : 0.0f;
  } else {
    power = detail::exp_to_float(b * log_double(abs(a)));
    if (!is_finite(b) && abs(a) == 1.0f) power = 1.0f;
  }
  return a < 0.0f && is_odd ? -power : power;
}

/// sin and cos of an angle in radians, in double.
inline SinCos<double> sin_cos(float x) {
  double turns = double{x} * (0.5 / kPi);
  if (!is_finite(x)) return {kNaN, kNaN};
  if (abs(x) > 1e6f) {
    // Every double from 2^52 on is whole.
    turns = abs(x) < 0x1p54f ? turns - static_cast<double>(static_cast<std::int64_t>(turns)) : 0.0;
  }
  return sin_cos_turns(turns);
}
inline float sin(float x) {
  return static_cast<float>(sin_cos(x).sin);
}
inline float cos(float x) {
  return static_cast<float>(sin_cos(x).cos);
}
inline float tan(float x) {
  const auto [s, c] = sin_cos(x);
  return static_cast<float>(s / c);
}

/// NaN outside of [−1, 1].
inline float asin(float x) {
  if (!(abs(x) <= 1.0f)) return kNaN;
  return static_cast<float>(atan2_radians(double{x}, std::sqrt((1.0 - x) * (1.0 + x))));
}
inline float acos(float x) {
  if (!(abs(x) <= 1.0f)) return kNaN;
  return static_cast<float>(atan2_radians(std::sqrt((1.0 - x) * (1.0 + x)), double{x}));
}
inline float atan2(float y, float x) {
  if (y != y || x != x) return kNaN;
  if (!is_finite(y) || !is_finite(x)) {  // the corners of a square, as in the C library
    const auto side = [](float v) { return is_finite(v) ? 0.0 : (v < 0.0f ? -1.0 : 1.0); };
    return static_cast<float>(is_finite(y) && y < 0.0f ? -atan2_radians(0.0, side(x))
                                                       : atan2_radians(side(y), side(x)));
  }
  return static_cast<float>(atan2_radians(double{y}, double{x}));
}
inline float atan(float x) {
  return atan2(x, 1.0f);
}

inline float sinh(float x) {
  if (abs(x) > 100.0f || x != x) return x * kInfinity;
  if (abs(x) < 0.5f) {  // where the difference below cancels
    const double z = double{x} * x;
    return static_cast<float>(
        x * (1.0 + z / 6 * (1.0 + z / 20 * (1.0 + z / 42 * (1.0 + z / 72 * (1.0 + z / 110))))));
  }
  const double e = exp_double(x);
  return static_cast<float>(0.5 * (e - 1.0 / e));
}
inline float cosh(float x) {
  if (abs(x) > 100.0f || x != x) return abs(x) * kInfinity;
  const double e = exp_double(x);
  return static_cast<float>(0.5 * (e + 1.0 / e));
}
inline float tanh(float x) {
  if (abs(x) > 20.0f) return x < 0.0f ? -1.0f : 1.0f;
  if (x != x) return x;
  if (abs(x) < 0.5f) {
    const double e = exp_double(x);
    const double z = double{x} * x;
    const double s =
        x * (1.0 + z / 6 * (1.0 + z / 20 * (1.0 + z / 42 * (1.0 + z / 72 * (1.0 + z / 110)))));
    return static_cast<float>(s / (0.5 * (e + 1.0 / e)));
  }
  const double e = exp_double(2.0 * x);
  return static_cast<float>((e - 1.0) / (e + 1.0));
}

}  // namespace komorebi::fn
