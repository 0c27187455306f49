#include "render/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace komorebi::testing {
namespace {

constexpr Rect kPixel{0, 0, 1, 1};

PixelSample grey(float value) {
  PixelSample s;
  s.radiance = Vec3(value);
  s.alpha = 1.0f;
  return s;
}

void add_one(Film& film, std::uint32_t index, const PixelSample& sample,
             std::vector<float> row = {}) {
  row.resize(film.layout().size());
  TileSums sums;
  film.reset(sums, 1);
  film.add(sums, 0, index, sample, row.data());
  sums.samples = 1;
  film.merge({&kPixel, 1}, sums);
}

std::vector<float> read(const Film& film, const char* pass) {
  std::vector<float> out(find_pass(pass).channels);
  film.read(pass, kPixel, out.data());
  return out;
}

TEST(Film, OrderOfSamplesDoesNotShow) {
  Settings settings;
  settings.samples = 5000;
  std::mt19937 random(3);
  std::lognormal_distribution<float> radiance(0.0f, 4.0f);
  std::vector<float> values;
  for (int i = 0; i < 5000; ++i) values.push_back(std::min(radiance(random), 6e4f));
  Film forward(kPixel, settings, 65146.0f), backward(kPixel, settings, 65146.0f);
  double sum = 0.0;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    add_one(forward, i, grey(values[i]));
    add_one(backward, 4999 - i, grey(values[4999 - i]));
    sum += values[i];
  }
  EXPECT_EQ(read(forward, "Combined"), read(backward, "Combined"));
  EXPECT_NEAR(read(forward, "Combined")[0], sum / 5000.0, 1e-6 * sum / 5000.0);
  EXPECT_EQ(forward.clamped_samples(), 0u);
}

TEST(Film, KeepsDarkCornersUnderASun) {
  Settings settings;  // a sky 10⁵ times as bright as the sample, and the sample still to 1 %
  Film film(kPixel, settings, 1e5f);
  for (std::uint32_t i = 0; i < 4; ++i) add_one(film, i, grey(3e-5f));
  EXPECT_NEAR(read(film, "Combined")[0], 3e-5f, 3e-7f);
}

TEST(Film, TheLargestSumDoesNotOverflow) {
  Settings settings;
  settings.samples = 1u << 16;
  Film film(kPixel, settings, 1000.0f);
  TileSums sums;
  film.reset(sums, 1);
  const std::vector<float> row(film.layout().size());
  for (std::uint32_t i = 0; i < settings.samples; ++i) {
    film.add(sums, 0, i, grey(31999.0f), row.data());
  }
  sums.samples = settings.samples;
  film.merge({&kPixel, 1}, sums);
  EXPECT_FLOAT_EQ(read(film, "Combined")[0], 31999.0f);
  EXPECT_EQ(film.clamped_samples(), 0u);
}

TEST(Film, CountsWhatCannotBe) {
  Film film(kPixel, Settings{}, 1.0f);
  add_one(film, 0, grey(std::numeric_limits<float>::quiet_NaN()));
  add_one(film, 1, grey(std::numeric_limits<float>::infinity()));
  EXPECT_EQ(film.clamped_samples(), 6u);  // three channels each
  EXPECT_TRUE(std::isfinite(read(film, "Combined")[0]));
}

TEST(Film, DepthIsTheFirstSamplesInAnyOrder) {
  Settings settings;
  settings.sample_offset = 10;
  Film film(kPixel, settings, 1.0f);
  for (const std::uint32_t i : {12u, 10u, 11u}) {
    std::vector<float> row(film.layout().size());
    film.layout().put(row.data(), Quantity::kDepth, static_cast<float>(i));
    add_one(film, i, grey(1.0f), row);
  }
  EXPECT_EQ(read(film, "Depth")[0], 10.0f);
}

TEST(Film, KeepsNoMoreThanIsAskedFor) {
  const Rect region{3, 5, 203, 105};
  Settings settings;
  settings.passes = {"Combined"};
  Film film(region, settings, 1.0f);
  EXPECT_LT(film.byte_count(), 33 * region.area());
  TileSums sums;
  film.reset(sums, 64);
  EXPECT_TRUE(sums.means.empty() && sums.firsts.empty());
  std::vector<float> out(3 * region.area());
  EXPECT_THROW(film.read("Depth", region, out.data()), std::invalid_argument);
  EXPECT_THROW(film.read("Normal", region, out.data()), std::invalid_argument);
  EXPECT_GT(Film(region, Settings{}, 1.0f).byte_count(), 60 * region.area());
}

TEST(Film, ReadsAnyRectangleOnAnyNumberOfThreads) {
  const Rect region{3, 5, 203, 305}, part{10, 6, 100, 299};
  Film film(region, Settings{}, 1.0f);
  for (const Rect& cell : cells_of(region)) {
    TileSums sums;
    film.reset(sums, cell.area());
    for (std::size_t i = 0; i < cell.area(); ++i) {
      const PixelSample s = grey(static_cast<float>(cell.x_min + i % cell.width()) / 256.0f);
      std::vector<float> row(film.layout().size());
      const float height = static_cast<float>(cell.y_min + i / cell.width()) / 512.0f;
      film.layout().put(row.data(), Quantity::kNormal, Vec3(0.0f, 0.0f, height));
      film.add(sums, i, 0, s, row.data());
    }
    sums.samples = 1;
    film.merge({&cell, 1}, sums);
  }
  ThreadPool pool(3);
  std::vector<float> rgba(4 * part.area()), normal(3 * part.area());
  film.read("Combined", part, rgba.data(), pool);
  film.read("Normal", part, normal.data(), pool);
  for (std::size_t i = 0; i < part.area(); ++i) {
    const auto x = static_cast<float>(part.x_min + i % part.width());
    const auto y = static_cast<float>(part.y_min + i / part.width());
    ASSERT_EQ(rgba[4 * i + 1], x / 256.0f);
    ASSERT_EQ(normal[3 * i + 2], y / 512.0f);
  }
}

TEST(Film, VarianceIsThatOfTheSamples) {
  Settings settings;
  settings.passes = {"Combined", "Variance"};
  settings.samples = 1000;
  std::mt19937 random(11);
  std::lognormal_distribution<float> radiance(0.0f, 1.0f);
  Film film(kPixel, settings, 3000.0f);
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const float value = i == 500 ? 60000.0f : radiance(random);  // a sun among dim samples
    add_one(film, i, grey(value));
    sum += double{value};
    squares += double{value} * double{value};
  }
  const double expected = (squares - sum * sum / 1000.0) / 999.0;
  for (const float variance : read(film, "Variance"))
    EXPECT_NEAR(variance, expected, 1e-6 * expected);
  Film flat(kPixel, settings, 1.0f);
  for (std::uint32_t i = 0; i < 7; ++i) add_one(flat, i, grey(0.3f));
  EXPECT_LT(read(flat, "Variance")[0], 1e-9f);
}

TEST(Film, MattesRankByCoverageInAnyOrder) {
  Settings settings;
  settings.passes = {"Combined", "CryptoObject00", "CryptoObject01"};
  const float a = 1.5f, b = 0.25f, c = -7.0f;
  std::vector<float> seen = {a, b, b, c, c, c, 0.0f, 0.0f};  // 0: nothing
  std::mt19937 random(2);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::shuffle(seen.begin(), seen.end(), random);
    Film film(kPixel, settings, 1.0f);
    for (std::uint32_t i = 0; i < seen.size(); ++i) add_one(film, i, grey(1.0f), {seen[i]});
    EXPECT_EQ(read(film, "CryptoObject00"), (std::vector<float>{c, 0.375f, b, 0.25f}));
    EXPECT_EQ(read(film, "CryptoObject01"), (std::vector<float>{a, 0.125f, 0.0f, 0.0f}));
  }
}

TEST(Film, RoundsToNearestEven) {
  EXPECT_EQ(round_to_integer(2.5), 2);
  EXPECT_EQ(round_to_integer(3.5), 4);
  EXPECT_EQ(round_to_integer(-2.5), -2);
  EXPECT_EQ(round_to_integer(-0.4), 0);
  EXPECT_EQ(round_to_integer(70368744177663.6), 70368744177664);  // 2^46, the largest sample
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-7e13, 7e13);
  for (int i = 0; i < 10000; ++i) {
    const double x = any(random);
    ASSERT_EQ(round_to_integer(x), static_cast<std::int64_t>(std::nearbyint(x)));
  }
}

TEST(Film, RefusesWhatItDoesNotHave) {
  Settings settings;
  settings.passes = {"Combined", "Glossy"};
  EXPECT_THROW(Film(kPixel, settings, 1.0f), std::invalid_argument);
  Film film(kPixel, Settings{}, 1.0f);
  float out[4];
  EXPECT_THROW(film.read("Combined", {0, 0, 2, 1}, out), std::invalid_argument);
}

}  // namespace
}  // namespace komorebi::testing
