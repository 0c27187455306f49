#include "render/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "render/tiles.h"

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
  sums.reset(1);
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
  sums.reset(1);
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

TEST(WorkItems, CoverEverySampleOfEveryPixelOnce) {
  for (const bool progressive : {true, false}) {
    for (const std::uint32_t samples : {1u, 7u, 64u, 100u}) {
      Settings settings;
      settings.samples = samples;
      settings.sample_offset = 3;
      settings.tile_size = 16;
      settings.use_progressive = progressive;
      const Rect region{5, 9, 60, 50};
      std::vector<std::vector<int>> seen(60 * 50, std::vector<int>(samples + 3));
      for (const WorkItem& item : work_items(region, settings)) {
        for (std::uint32_t y = item.tile.y_min; y < item.tile.y_max; ++y) {
          for (std::uint32_t x = item.tile.x_min; x < item.tile.x_max; ++x) {
            for (std::uint32_t i = 0; i < item.count; ++i) ++seen.at(y * 60 + x).at(item.first + i);
          }
        }
      }
      for (std::uint32_t y = 0; y < 50; ++y) {
        for (std::uint32_t x = 0; x < 60; ++x) {
          const bool inside = x >= 5 && y >= 9;
          for (std::uint32_t i = 0; i < samples + 3; ++i) {
            ASSERT_EQ(seen[y * 60 + x][i], inside && i >= 3 ? 1 : 0);
          }
        }
      }
    }
  }
}

TEST(WorkItems, RefineTheWholeFrameFromItsCentre) {
  Settings settings;
  settings.samples = 64;
  settings.tile_size = 32;
  const auto items = work_items({0, 0, 320, 160}, settings);
  const std::size_t tiles = 10 * 5;
  for (std::size_t i = 0; i < tiles; ++i) EXPECT_EQ(items[i].first + items[i].count, 1u);
  EXPECT_EQ(items[0].tile.y_min, 64u);
  EXPECT_TRUE(items[0].tile.x_min == 128u || items[0].tile.x_min == 160u);
  EXPECT_EQ(items[tiles].first, 1u);
}

}  // namespace
}  // namespace komorebi::testing
