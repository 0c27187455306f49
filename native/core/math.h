#pragma once

#include <bit>
#include <cmath>  // std::sqrt alone: IEEE 754 demands the one correct rounding, on every machine

#include "core/vector.h"

/// Elementary functions from + − * / and sqrt alone, so that the same bits come out of every
/// compiler, C library and processor (libm picks its code by processor). Each comes in float, for
/// shading, and in double, for tables. Coefficients are Chebyshev fits computed with 50 digits;
/// stated errors are maxima against libm in double, checked in tests/cpp/core/math_test.cpp.
namespace komorebi {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr float kPiFloat = 3.14159265358979323846f;
inline constexpr float kTwoPi = 6.28318530717958647693f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInvTwoPi = 0.15915494309189533577f;
inline constexpr float kInvFourPi = 0.07957747154594766788f;
/// The largest float below 1.
inline constexpr float kOneMinusEpsilon = 0.99999994f;

template <typename T>
struct SinCos {
  T sin, cos;
};

namespace detail {

// Horner's rule; c[0] is the constant term.
template <typename T, std::size_t N>
inline T polynomial(T x, const T (&c)[N]) {
  T sum = c[N - 1];
  for (std::size_t i = N - 1; i > 0; --i) sum = sum * x + c[i - 1];
  return sum;
}

// sin(πr/2) / r in r², |r| ≤ 1/2
inline float sin_quarter(float z) {
  constexpr float c[] = {1.570796327f, -0.6459640961f, 0.07969258273f, -0.004681266257f,
                         0.0001582063036f};
  return polynomial(z, c);
}
inline double sin_quarter(double z) {
  constexpr double c[] = {1.5707963267948966192,    -0.64596409750624625222,
                          0.07969262624616692448,   -0.0046817541353148270709,
                          0.0001604411847266723001, -3.5988427171448577997e-6,
                          5.6919278504896334155e-8, -6.6276249389924723622e-10};
  return polynomial(z, c);
}

// cos(πr/2) in r², |r| ≤ 1/2
inline float cos_quarter(float z) {
  constexpr float c[] = {1.0f, -1.233700541f, 0.2536692037f, -0.0208600695f, 0.0009036280664f};
  return polynomial(z, c);
}
inline double cos_quarter(double z) {
  constexpr double c[] = {1.0,
                          -1.2337005501361698273,
                          0.25366950790104801258,
                          -0.020863480763352917446,
                          0.00091926027483853309188,
                          -0.000025202042362733304783,
                          4.7108740775364386663e-7,
                          -6.3863254633863562277e-9,
                          6.5066542354246979324e-11};
  return polynomial(z, c);
}

// atan(r) / r in r², |r| ≤ tan(π/8)
inline float atan_ratio(float z) {
  constexpr float c[] = {0.9999999994f,  -0.3333330689f, 0.1999818304f,
                         -0.1423953267f, 0.1056982881f,  -0.06026305228f};
  return polynomial(z, c);
}
inline double atan_ratio(double z) {
  constexpr double c[] = {
      0.99999999999999999874,   -0.33333333333333121163,  0.19999999999940891462,
      -0.14285714279250244942,  0.11111110744919658237,   -0.090908968090640270761,
      0.076920453309022249521,  -0.066629518136291900881, 0.058468782973308725201,
      -0.050351024566015518428, 0.037965257453865936236,  -0.017805397205419445228};
  return polynomial(z, c);
}

}  // namespace detail

/// The largest whole number ≤ x, for |x| < 2^31.
template <typename T>
inline std::int32_t floor_to_int(T x) {
  const auto i = static_cast<std::int32_t>(x);
  return static_cast<T>(i) > x ? i - 1 : i;
}

/// sin and cos of 2πu: angles in turns, so that the range reduction is exact.
/// |u| < 2^20. Error ≤ 1.2e-7 in float, 3e-16 in double; sin² + cos² = 1 within the same.
template <typename T>
inline SinCos<T> sin_cos_turns(T u) {
  const std::int32_t quarter = floor_to_int(T(4) * u + T(0.5));
  const T r = T(4) * u - static_cast<T>(quarter);  // exact, in [−1/2, 1/2]
  const T s = r * detail::sin_quarter(r * r);
  const T c = detail::cos_quarter(r * r);
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

/// The angle of (x, y) in radians, in [−π, π]; 0 for (0, 0); −0 counts as 0.
/// Error ≤ 4e-7 in float (relative 3e-7 near 0), 8e-16 in double. Arguments finite, and so far
/// from the ends of the range that x + y neither overflows nor vanishes.
template <typename T>
inline T atan2_radians(T y, T x) {
  const T ax = x < T(0) ? -x : x;
  const T ay = y < T(0) ? -y : y;
  const T large = ax < ay ? ay : ax;
  const T small = ax < ay ? ax : ay;
  if (!(large > T(0))) return T(0);
  constexpr T kTanEighth = T(0.41421356237309504880);
  T angle;
  if (small > kTanEighth * large) {  // atan(q) = π/4 + atan((q − 1) / (q + 1))
    const T r = (small - large) / (small + large);
    angle = T(kPi / 4) + r * detail::atan_ratio(r * r);
  } else {
    const T r = small / large;
    angle = r * detail::atan_ratio(r * r);
  }
  if (ax < ay) angle = T(kPi / 2) - angle;
  if (x < T(0)) angle = T(kPi) - angle;
  return y < T(0) ? -angle : angle;
}

/// 2^k for −1022 ≤ k ≤ 1023.
inline double power_of_two(std::int32_t k) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// e^x for −700 ≤ x ≤ 700, relative error ≤ 4e-16 · (1 + |x|).
inline double exp_double(double x) {
  constexpr double kLog2 = 0.6931471805599453094172321;
  const std::int32_t k = floor_to_int(x / kLog2 + 0.5);
  const double r = x - static_cast<double>(k) * kLog2;
  constexpr double c[] = {
      0.99999999999999999693,   0.99999999999999999976,    0.50000000000000183855,
      0.16666666666666680806,   0.041666666666488095495,   0.0083333333333196006109,
      0.0013888888952314774652, 0.00019841269890047113707, 0.000024801485482328492419,
      2.7557240918578969823e-6, 2.7632639639041029749e-7,  2.5110037605963777712e-8};
  return detail::polynomial(r, c) * power_of_two(k);
}

/// The natural logarithm of a positive, normal number, error ≤ 4e-16 · (1 + |log x|).
inline double log_double(double x) {
  constexpr double kLog2 = 0.6931471805599453094172321;
  constexpr std::uint64_t kFraction = (std::uint64_t{1} << 52) - 1;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto k = static_cast<std::int32_t>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & kFraction) | std::bit_cast<std::uint64_t>(1.0));
  if (m > 1.4142135623730951) {
    m *= 0.5;
    ++k;
  }
  // 2 atanh(s) as its series, |s| ≤ 3 − √8
  const double s = (m - 1.0) / (m + 1.0);
  constexpr double c[] = {1.0,      1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11,
                          1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23};
  return 2.0 * s * detail::polynomial(s * s, c) + static_cast<double>(k) * kLog2;
}

/// Whether x is neither infinite nor NaN.
inline bool is_finite(float x) {
  return (std::bit_cast<std::uint32_t>(x) & 0x7f800000u) != 0x7f800000u;
}

}  // namespace komorebi
