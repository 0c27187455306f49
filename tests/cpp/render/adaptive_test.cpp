// Adaptive sampling stops where it should, says where, and shows in nothing else.

#include "render/adaptive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "support/scenes.h"

namespace komorebi::testing {
namespace {

/// Half of the frame is a floor that sees all of the sky, without noise; on the other half stand
/// pillars.
std::shared_ptr<Scene> half_noisy_scene(std::uint32_t width, std::uint32_t height) {
  const auto floor = quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}).mesh();
  std::vector<Placed> parts{{floor}};
  const auto pillar = box(Vec3d(-0.15, -0.15, 0), Vec3d(0.15, 0.15, 1.5)).mesh();
  for (int i = 0; i < 12; ++i) {
    parts.push_back(
        {pillar, glm::translate(Mat4d(1.0), Vec3d(0.5 + 0.4 * (i % 3), 0.9 * (i / 3) - 1.5, 0))});
  }
  return committed(make_scene(parts, camera_at({-1, -7, 5}, {0, 0, 0}, width, height)));
}

Settings adaptive_settings() {
  Settings s;
  s.samples = 100;
  s.light_samples = 1;
  s.seed = 3;
  s.threads = 2;
  s.tile_size = 32;
  s.use_adaptive_sampling = true;
  s.adaptive_threshold = 0.012f;
  s.adaptive_min_samples = 8;
  s.passes = {"Combined", "Debug Sample Count"};
  return s;
}

std::size_t count_if_equal(const std::vector<float>& values, float value) {
  return static_cast<std::size_t>(std::count(values.begin(), values.end(), value));
}

class Adaptive : public ::testing::Test {
 protected:
  std::shared_ptr<Scene> scene_ = half_noisy_scene(150, 90);
  Settings settings_ = adaptive_settings();
};

TEST_F(Adaptive, StopsWhereNoiseIsLowAndGoesOnElsewhere) {
  const auto counts = render(scene_, settings_, "Debug Sample Count");
  const std::size_t pixels = counts.size();
  EXPECT_GT(count_if_equal(counts, 8.0f / 100.0f), pixels / 5);
  EXPECT_GT(count_if_equal(counts, 1.0f), pixels / 20);
  for (const float c : counts) {  // decisions are made at powers of two
    const auto n = static_cast<std::uint32_t>(std::lround(c * 100.0f));
    ASSERT_TRUE(n == 8 || n == 16 || n == 32 || n == 64 || n == 100) << n;
  }
  for (std::uint32_t y = 0; y < 90; ++y) {  // one number for each cell
    for (std::uint32_t x = 0; x < 150; ++x) {
      ASSERT_EQ(counts[150 * y + x], counts[150 * (y / 8 * 8) + x / 8 * 8]);
    }
  }
}

TEST_F(Adaptive, APixelIsThatOfARenderWithItsNumberOfSamples) {
  const auto picture = render(scene_, settings_);
  const auto counts = render(scene_, settings_, "Debug Sample Count");
  Settings plain = settings_;
  plain.use_adaptive_sampling = false;
  std::size_t compared = 0;
  for (const std::uint32_t n : {8u, 16u, 32u, 64u, 100u}) {
    plain.samples = n;
    const auto expected = render(scene_, plain);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] != static_cast<float>(n / 100.0)) continue;
      ++compared;
      for (std::size_t c = 4 * i; c < 4 * i + 4; ++c) ASSERT_EQ(picture[c], expected[c]);
    }
  }
  EXPECT_EQ(compared, counts.size());
}

TEST_F(Adaptive, ThreadsTilesAndOrderDoNotShow) {
  for (const char* pass : {"Combined", "Debug Sample Count"}) {
    settings_ = adaptive_settings();
    const auto expected = render(scene_, settings_, pass);
    for (const std::uint32_t threads : {1u, 3u}) {
      settings_.threads = threads;
      EXPECT_EQ(render(scene_, settings_, pass), expected) << threads << " threads";
    }
    for (const std::uint32_t tile : {8u, 13u, 256u}) {
      settings_.tile_size = tile;
      EXPECT_EQ(render(scene_, settings_, pass), expected) << "tiles of " << tile;
    }
    settings_.use_progressive = false;
    EXPECT_EQ(render(scene_, settings_, pass), expected) << "tile by tile";
  }
}

TEST_F(Adaptive, ABorderIsTheCropOfTheWhole) {
  for (const char* pass : {"Combined", "Debug Sample Count"}) {
    settings_ = adaptive_settings();
    const std::size_t channels = find_pass(pass).channels;
    const auto whole = render(scene_, settings_, pass);
    settings_.has_region = true;
    settings_.region = {37, 11, 101, 64};  // through the middle of cells
    const auto part = render(scene_, settings_, pass);
    std::size_t i = 0;
    for (std::uint32_t y = 11; y < 64; ++y) {
      for (std::size_t k = channels * 37; k < channels * 101; ++k, ++i) {
        ASSERT_EQ(part[i], whole[channels * 150 * y + k]) << "row " << y;
      }
    }
    EXPECT_EQ(i, part.size());
  }
}

TEST_F(Adaptive, CancelAndResumeDoNotShow) {
  settings_.samples = 400;
  settings_.adaptive_threshold = 0.005f;
  const auto expected = render(scene_, settings_);
  EXPECT_EQ(testing::render_with_breaks(scene_, settings_), expected);
}

TEST_F(Adaptive, ConvergedCellsCostNoMoreRays) {
  Session adaptive(scene_, settings_);
  ASSERT_TRUE(adaptive.wait(60.0));
  const Progress p = adaptive.progress();
  std::vector<float> counts(150 * 90);
  adaptive.read("Debug Sample Count", adaptive.settings().region, counts.data());
  double samples = 0.0;
  for (const float c : counts) samples += std::round(100.0 * c);
  EXPECT_NEAR(p.mean_samples, samples / (150 * 90), 1e-6);
  EXPECT_LT(p.mean_samples, 80.0);
  EXPECT_LE(static_cast<double>(p.rays), 2.0 * samples);  // one camera and one light ray
  EXPECT_GT(static_cast<double>(p.rays), 1.5 * samples);
  EXPECT_EQ(p.fraction, 1.0);
  EXPECT_EQ(p.sample, 100u);
  EXPECT_EQ(p.tile, p.tiles);
}

TEST_F(Adaptive, AFrameWithoutNoiseEndsEarly) {
  const auto floor = quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}).mesh();
  const auto scene = committed(make_scene({{floor}}, camera_at({0, -7, 5}, {0, 0, 0}, 64, 64)));
  settings_.samples = 1 << 20;
  Session session(scene, settings_);
  ASSERT_TRUE(session.wait(60.0));
  EXPECT_EQ(session.progress().fraction, 1.0);
  EXPECT_EQ(session.progress().sample, 8u);
  EXPECT_EQ(session.progress().mean_samples, 8.0);
}

/// A small lamp in a black sky, and rays that do not aim at it: one in a thousand finds it. Every
/// cell must go on, though most of its pixels have seen nothing yet.
TEST_F(Adaptive, RareBrightSamplesAreNotMissed) {
  const auto floor = quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}).mesh();
  std::vector<float> texels(3 * std::size_t{64} * 32, 0.0f);
  std::fill_n(&texels[3 * (64 * 27 + 20)], 3, 300.0f);  // one texel of 2048
  auto scene = make_scene({{floor}}, camera_at({0, -3, 6}, {0, 0, 0}, 64, 64));
  scene->set_world_environment(std::make_shared<Environment>("spot", 64, 32, texels), 1.0,
                               Mat3d(1.0));
  committed(scene);
  settings_.method = Method::kWorldLight;
  settings_.environment_sampling = EnvironmentSampling::kCosine;  // finds it once in a thousand
  settings_.adaptive_threshold = 0.0f;
  settings_.adaptive_min_samples = 0;
  settings_.samples = 128;
  const auto counts = render(scene, settings_, "Debug Sample Count");
  EXPECT_EQ(count_if_equal(counts, 1.0f), counts.size());
}

TEST(AdaptiveRule, HasTheAutomaticValuesOfCycles) {
  Settings s;
  s.use_adaptive_sampling = true;
  for (const auto& [threshold, samples] :
       {std::pair(0.1f, 32u), std::pair(0.01f, 64u), std::pair(0.001f, 128u)}) {
    s.adaptive_threshold = threshold;
    EXPECT_EQ(AdaptiveRule(s, 1).min_samples(), samples);
  }
  s.adaptive_threshold = 0.0f;
  s.samples = 500;
  EXPECT_FLOAT_EQ(AdaptiveRule(s, 1).threshold(), 0.002f);
  EXPECT_EQ(AdaptiveRule(s, 1).min_samples(), 16u);
  s.samples = 125;  // as many light rays
  EXPECT_FLOAT_EQ(AdaptiveRule(s, 4).threshold(), 0.002f);
  s.samples = 5000;
  EXPECT_FLOAT_EQ(AdaptiveRule(s, 1).threshold(), 0.001f);
}

TEST(AdaptiveRule, ComparesTheErrorOfCycles) {
  Settings s;
  s.samples = 1024;
  s.use_adaptive_sampling = true;
  s.adaptive_threshold = 0.01f;
  const AdaptiveRule rule(s, 1);
  EXPECT_TRUE(rule.decides_at(64) && rule.decides_at(512));
  EXPECT_FALSE(rule.decides_at(32) || rule.decides_at(96) || rule.decides_at(1024));
  EXPECT_TRUE(rule.remembers_at(32) && !rule.remembers_at(16) && !rule.remembers_at(512));
  // √(R + G + B) = 0.6, so the limit of 5 · 0.01 is a difference of 0.03, each channel 0.01.
  const float before[4] = {0.12f, 0.12f, 0.12f, 1.0f};
  const float below[4] = {0.1297f, 0.1297f, 0.1297f, 1.0f};
  const float above[4] = {0.1310f, 0.1310f, 0.1310f, 1.0f};
  EXPECT_TRUE(rule.converged(below, before, 1, 64));
  EXPECT_FALSE(rule.converged(above, before, 1, 64));
  const float edge[4] = {0.12f, 0.12f, 0.12f, 0.9f};  // noise in alpha alone
  EXPECT_FALSE(rule.converged(edge, before, 1, 64));
}

TEST(TimeLimit, EndsWithAWholePassThatItsCountRepeats) {
  const auto scene = half_noisy_scene(64, 48);
  for (const bool adaptive : {false, true}) {
    Settings settings = adaptive_settings();
    settings.use_adaptive_sampling = adaptive;
    settings.adaptive_threshold = 0.0f;
    settings.adaptive_min_samples = 0;
    settings.samples = 1 << 16;
    settings.time_limit = 0.3f;
    Session session(scene, settings);
    ASSERT_TRUE(session.wait(60.0));
    const Progress p = session.progress();
    EXPECT_EQ(p.fraction, 1.0);
    EXPECT_GE(p.sample, 1u);
    EXPECT_LT(p.sample, 1u << 16);
    std::vector<float> picture(4 * 64 * 48);
    session.read("Combined", session.settings().region, picture.data());

    settings.time_limit = 0.0f;
    settings.samples = p.sample;
    if (adaptive) {
      settings.adaptive_threshold = session.adaptive_rule().threshold();
      settings.adaptive_min_samples = session.adaptive_rule().min_samples();
    } else {
      EXPECT_EQ(p.mean_samples, p.sample);
    }
    EXPECT_EQ(render(scene, settings), picture) << (adaptive ? "adaptive" : "");
  }
}

TEST(TimeLimit, OutlivesACancel) {
  const auto scene = half_noisy_scene(64, 48);
  Settings settings = adaptive_settings();
  settings.use_adaptive_sampling = false;
  settings.samples = 1 << 16;
  settings.time_limit = 0.2f;
  Session session(scene, settings);
  session.wait(0.05);
  session.cancel();
  ASSERT_TRUE(session.wait(10.0));
  session.resume();
  ASSERT_TRUE(session.wait(60.0));
  const Progress p = session.progress();
  std::vector<float> picture(4 * 64 * 48);
  session.read("Combined", session.settings().region, picture.data());
  settings.time_limit = 0.0f;
  settings.samples = p.sample;
  EXPECT_EQ(render(scene, settings), picture);
}

}  // namespace
}  // namespace komorebi::testing
