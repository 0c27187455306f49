#include "render/film.h"

#include <gtest/gtest.h>

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

void add_one(Film& film, std::uint32_t index, const PixelSample& sample) {
  TileSums sums;
  film.reset(sums, 1);
  film.add(sums, 0, index, sample);
  sums.samples = 1;
  film.merge({&kPixel, 1}, sums);
}

std::vector<float> read(const Film& film, const char* pass) {
  std::vector<float> out(Film::pass(pass).channels);
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
  for (std::uint32_t i = 0; i < settings.samples; ++i) film.add(sums, 0, i, grey(31999.0f));
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
    PixelSample s = grey(1.0f);
    s.depth = static_cast<float>(i);
    add_one(film, i, s);
  }
  EXPECT_EQ(read(film, "Depth")[0], 10.0f);
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
