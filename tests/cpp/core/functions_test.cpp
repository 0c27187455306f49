// The functions of shader nodes against libm in double.
#include "core/functions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace komorebi {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// How many units in the last place of the exact value's float two values are apart.
double units_apart(float ours, double exact) {
  const auto rounded = static_cast<float>(exact);
  if (ours == rounded || (std::isnan(ours) && std::isnan(exact))) return 0.0;
  if (!std::isfinite(ours) || !std::isfinite(rounded)) return kInf;
  const float size = std::max(std::abs(rounded), std::numeric_limits<float>::min());
  const double unit = std::nextafter(size, std::numeric_limits<float>::infinity()) - size;
  return std::abs(static_cast<double>(ours) - exact) / unit;
}

// Every 1009th float of all that there are.
template <class F>
void for_all_floats(F f) {
  for (std::uint64_t bits = 0; bits <= 0xffffffffu; bits += 1009) {
    f(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  }
  for (const float x : {0.0f, -0.0f, 1.0f, -1.0f, 0.5f, 1.5f, 2.5f, -0.5f, -2.5f, fn::kInfinity,
                        -fn::kInfinity, 8388607.5f, 8388609.0f, 2147483648.0f}) {
    f(x);
  }
}

void expect_close(float (*ours)(float), double (*exact)(double), double units,
                  float largest = fn::kInfinity) {
  double worst = 0.0;
  float at = 0.0f;
  for_all_floats([&](float x) {
    if (std::abs(x) > largest) return;
    const double apart = units_apart(ours(x), exact(x));
    if (apart > worst) {
      worst = apart;
      at = x;
    }
  });
  EXPECT_LE(worst, units) << at << " gives " << ours(at) << ", not " << exact(at);
}

TEST(Functions, WholeNumbers) {
  expect_close(fn::floor, std::floor, 0.0);
  expect_close(fn::ceil, std::ceil, 0.0);
  expect_close(fn::trunc, std::trunc, 0.0);
  expect_close(fn::round, std::round, 0.0);
}

TEST(Functions, Exponentials) {
  expect_close(fn::exp, std::exp, 0.51);
  expect_close(fn::exp2, std::exp2, 0.51);
  expect_close(fn::log, std::log, 0.51);
  expect_close(fn::log2, std::log2, 0.51);
  expect_close(fn::sinh, std::sinh, 0.51);
  expect_close(fn::cosh, std::cosh, 0.51);
  expect_close(fn::tanh, std::tanh, 0.51);
}

TEST(Functions, Angles) {
  expect_close(fn::asin, std::asin, 0.51);
  expect_close(fn::acos, std::acos, 0.51);
  expect_close(fn::atan, std::atan, 0.51);
  expect_close(fn::sin, std::sin, 0.6, 6.3f);
  expect_close(fn::cos, std::cos, 0.6, 6.3f);
  expect_close(fn::tan, std::tan, 0.6, 6.3f);
  for_all_floats([](float x) {
    if (!std::isfinite(x) || std::abs(x) > 1e15f) return;
    const double error = 1e-7 + 2e-16 * std::abs(double{x});
    ASSERT_NEAR(fn::sin(x), std::sin(double{x}), error) << x;
    ASSERT_NEAR(fn::cos(x), std::cos(double{x}), error) << x;
  });
  for (const float x : {1e20f, 3e38f, -1e30f}) EXPECT_LE(std::abs(fn::sin(x)), 1.0f);
  EXPECT_TRUE(std::isnan(fn::sin(fn::kInfinity)));
}

template <class F>
void for_pairs(F f) {
  constexpr float kSpecial[] = {0.0f,  1.0f,   -1.0f,         2.0f,           -2.0f,
                                3.0f,  -3.0f,  0.5f,          -0.5f,          1e-40f,
                                1e38f, -1e38f, fn::kInfinity, -fn::kInfinity, fn::kNaN};
  for (const float a : kSpecial) {
    for (const float b : kSpecial) f(a, b);
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<float> small(-4.0f, 4.0f);
  for (int i = 0; i < 1 << 20; ++i) {
    f(small(random), small(random));
    f(std::bit_cast<float>(static_cast<std::uint32_t>(random())),
      std::bit_cast<float>(static_cast<std::uint32_t>(random())));
    f(std::abs(small(random)) * 4.0f, small(random) * 8.0f);
    f(small(random), std::round(small(random)));
  }
}

TEST(Functions, Pairs) {
  double pow = 0.0, atan2 = 0.0;
  for_pairs([&](float a, float b) {
    pow = std::max(pow, units_apart(fn::pow(a, b), std::pow(double{a}, double{b})));
    ASSERT_LE(pow, 0.51) << a << " " << b << ": " << fn::pow(a, b);
    atan2 = std::max(atan2, units_apart(fn::atan2(a, b), std::atan2(double{a} + 0.0, b + 0.0)));
    ASSERT_LE(atan2, 0.51) << a << " " << b << ": " << fn::atan2(a, b);
    ASSERT_LE(units_apart(fn::fmod(a, b), std::fmod(double{a}, double{b})), 0.0) << a << " " << b;
  });
}

}  // namespace
}  // namespace komorebi
