// Our elementary functions against libm in double (long double where double is tested).
#include "core/math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace komorebi {
namespace {

constexpr long double kPiLong = 3.14159265358979323846264338327950288L;

template <typename T>
double worst_sin_cos_error(double from, double to, int steps) {
  long double worst = 0.0L;
  for (int i = 0; i <= steps; ++i) {
    const T u = static_cast<T>(from + (to - from) * i / steps);
    const auto [s, c] = sin_cos_turns(u);
    const long double turns = static_cast<long double>(u);
    const long double angle = 2.0L * kPiLong * (turns - std::floor(turns + 0.5L));
    worst = std::max(worst, std::abs(static_cast<long double>(s) - std::sin(angle)));
    worst = std::max(worst, std::abs(static_cast<long double>(c) - std::cos(angle)));
  }
  return static_cast<double>(worst);
}

TEST(Math, SinCosTurnsFloat) {
  EXPECT_LT(worst_sin_cos_error<float>(0.0, 1.0, 1 << 20), 1.2e-7);
  EXPECT_LT(worst_sin_cos_error<float>(-1000.0, 1000.0, 1 << 20), 1.2e-7);
}

TEST(Math, SinCosTurnsDouble) {
  EXPECT_LT(worst_sin_cos_error<double>(0.0, 1.0, 1 << 20), 3e-16);
  EXPECT_LT(worst_sin_cos_error<double>(-1000.0, 1000.0, 1 << 20), 3e-16);
}

TEST(Math, SinCosTurnsExactAtQuarters) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const auto [s, c] = sin_cos_turns(0.25f * static_cast<float>(quarter));
    constexpr float kSin[] = {0.0f, 1.0f, 0.0f, -1.0f};
    EXPECT_EQ(s, kSin[quarter & 3]);
    EXPECT_EQ(c, kSin[(quarter + 1) & 3]);
  }
}

TEST(Math, SinCosTurnsLiesOnTheCircle) {
  for (int i = 0; i < 1 << 16; ++i) {
    const auto [s, c] = sin_cos_turns(static_cast<float>(i) / 65536.0f);
    EXPECT_NEAR(double{s} * s + double{c} * c, 1.0, 2.5e-7);
  }
}

template <typename T>
double worst_atan_error(T scale) {
  long double worst = 0.0L;
  for (int i = 0; i <= 1 << 20; ++i) {
    const long double angle = 2.0L * kPiLong * i / (1 << 20);
    const T x = scale * static_cast<T>(std::cos(angle));
    const T y = scale * static_cast<T>(std::sin(angle));
    // + 0 turns −0 into 0, which is what ours takes it for
    const long double exact = std::atan2(y + 0.0L, static_cast<long double>(x));
    worst = std::max(worst, std::abs(static_cast<long double>(atan2_radians(y, x)) - exact));
  }
  return static_cast<double>(worst);
}

TEST(Math, Atan2Float) {
  for (const float scale : {1e-30f, 1.0f, 1e30f}) EXPECT_LT(worst_atan_error(scale), 4e-7);
}

TEST(Math, Atan2Double) {
  for (const double scale : {1e-200, 1.0, 1e200}) EXPECT_LT(worst_atan_error(scale), 8e-16);
}

TEST(Math, Atan2RelativeNearZero) {
  for (int e = -40; e <= 0; ++e) {
    const float y = std::ldexp(0.7f, e);
    EXPECT_NEAR(double{atan2_radians(y, 1.0f)} / std::atan2(double{y}, 1.0), 1.0, 3e-7) << y;
  }
}

TEST(Math, Atan2AxesAndOrigin) {
  EXPECT_EQ(atan2_radians(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(atan2_radians(0.0f, 2.0f), 0.0f);
  EXPECT_EQ(atan2_radians(2.0f, 0.0f), kPiFloat / 2);
  EXPECT_EQ(atan2_radians(0.0f, -2.0f), kPiFloat);
  EXPECT_EQ(atan2_radians(-2.0f, 0.0f), -kPiFloat / 2);
}

TEST(Math, ExpDouble) {
  for (double x = -700.0; x <= 700.0; x += 0.0917) {
    EXPECT_NEAR(exp_double(x) / std::exp(x), 1.0, 4e-16 * (1.0 + std::abs(x))) << x;
  }
  EXPECT_EQ(exp_double(0.0), 1.0);
}

TEST(Math, FloorToInt) {
  for (const double x : {-2.0, -1.5, -1.0, -0.25, 0.0, 0.75, 1.0, 3.999}) {
    EXPECT_EQ(floor_to_int(x), static_cast<std::int32_t>(std::floor(x))) << x;
  }
}

}  // namespace
}  // namespace komorebi
