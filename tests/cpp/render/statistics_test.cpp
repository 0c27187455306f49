// Estimators that should have the same mean have it, and errors fall as theory says.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/scenes.h"

namespace komorebi::testing {
namespace {

/// A sky of soft blue with a sun that holds most of the energy in one texel of 2048.
std::shared_ptr<const Environment> sunny_sky() {
  std::vector<float> texels;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float sun = x == 20 && y == 26 ? 3000.0f : 0.0f;
      texels.insert(texels.end(), {0.2f + sun, 0.3f + sun, 0.6f + 0.8f * sun});
    }
  }
  return std::make_shared<Environment>("sunny", 64, 32, std::move(texels));
}

std::shared_ptr<Scene> sunny_scene() {
  const auto ball = sphere(24, {0, 0, 1}, 1.0, true).mesh();
  const auto ground = quad({-8, -8, 0}, {16, 0, 0}, {0, 16, 0}).mesh();
  auto scene = make_scene({{ground}, {ball}}, camera_at({5, -4, 3}, {0, 0, 0.5}, 48, 32));
  scene->set_world_environment(sunny_sky(), 1.0, Mat3d(1.0));
  return committed(scene);
}

Settings sky_settings(EnvironmentSampling sampling, std::uint32_t samples) {
  Settings s;
  s.method = Method::kWorldLight;
  s.environment_sampling = sampling;
  s.samples = samples;
  s.light_samples = 1;
  s.pixel_filter = PixelFilter::kBox;
  return s;
}

/// Means of whole pictures over seeds: independent, so their spread is the standard error.
Estimate over_seeds(const std::shared_ptr<Scene>& scene, Settings settings, int seeds) {
  std::vector<double> means;
  for (int seed = 0; seed < seeds; ++seed) {
    settings.seed = static_cast<std::uint32_t>(100 + seed);
    means.push_back(estimate(render(scene, settings)).mean);
  }
  const double n = seeds;
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / n;
  double squares = 0.0;
  for (const double m : means) squares += (m - mean) * (m - mean);
  return {mean, std::sqrt(squares / (n - 1.0) / n)};
}

TEST(Strategies, AgreeInMeanUnderASun) {
  const auto scene = sunny_scene();
  const Estimate mis = over_seeds(scene, sky_settings(EnvironmentSampling::kMis, 64), 12);
  const Estimate product = over_seeds(scene, sky_settings(EnvironmentSampling::kProduct, 64), 12);
  const Estimate map = over_seeds(scene, sky_settings(EnvironmentSampling::kEnvironment, 64), 12);
  const Estimate cosine = over_seeds(scene, sky_settings(EnvironmentSampling::kCosine, 256), 12);
  EXPECT_NEAR(mis.mean, map.mean, 4.0 * std::hypot(mis.error, map.error));
  EXPECT_NEAR(mis.mean, cosine.mean, 4.5 * std::hypot(mis.error, cosine.error));
  EXPECT_NEAR(product.mean, map.mean, 4.0 * std::hypot(product.error, map.error));
  EXPECT_NEAR(product.mean, mis.mean, 4.0 * std::hypot(product.error, mis.error));
  EXPECT_LT(product.error, 0.01 * product.mean);
  EXPECT_LT(mis.error, 0.01 * mis.mean);
  EXPECT_LT(cosine.error, 0.05 * cosine.mean);
}

TEST(Strategies, UniformAndCosineOcclusionAgreeInMean) {
  const auto scene = sunny_scene();
  Settings settings;
  settings.samples = 16;
  const Estimate cosine = over_seeds(scene, settings, 12);
  settings.ao_sampling = AoSampling::kUniform;
  const Estimate uniform = over_seeds(scene, settings, 12);
  EXPECT_NEAR(cosine.mean, uniform.mean, 4.5 * std::hypot(cosine.error, uniform.error));
  EXPECT_LT(uniform.error, 0.002);
}

TEST(Strategies, AConstantMapIsAUniformColour) {
  const auto ball = sphere(24, {0, 0, 1}, 1.0, false).mesh();
  const auto ground = quad({-8, -8, 0}, {16, 0, 0}, {0, 16, 0}).mesh();
  const auto camera = camera_at({5, -4, 3}, {0, 0, 0.5}, 48, 32);
  auto with_map = make_scene({{ground}, {ball}}, camera);
  with_map->set_world_environment(
      std::make_shared<Environment>("grey", 8, 4, std::vector<float>(8 * 4 * 3, 0.5f)), 2.0,
      Mat3d(1.0));
  const auto uniform = committed(make_scene({{ground}, {ball}}, camera));
  committed(with_map);
  // Cosine sampling draws the same rays either way.
  const auto settings = sky_settings(EnvironmentSampling::kCosine, 16);
  const auto a = render(with_map, settings), b = render(uniform, settings);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-5f);
  const Estimate mis = over_seeds(with_map, sky_settings(EnvironmentSampling::kMis, 32), 8);
  const Estimate exact = over_seeds(uniform, settings, 8);
  EXPECT_NEAR(mis.mean, exact.mean, 4.5 * std::hypot(mis.error, exact.error));
  const Estimate product = over_seeds(with_map, sky_settings(EnvironmentSampling::kProduct, 32), 8);
  EXPECT_NEAR(product.mean, exact.mean, 4.5 * std::hypot(product.error, exact.error));
}

/// Root mean square difference of two pictures.
double rms(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Slope of log error over log samples between 8 and 128: −1/2 for independent samples; a
/// low-discrepancy set must do at least as well, and better where visibility is smooth.
double slope(const std::shared_ptr<Scene>& scene, Settings settings) {
  settings.seed = 77;
  settings.samples = 4096;
  const auto reference = render(scene, settings);
  settings.seed = 1;
  settings.samples = 8;
  const double coarse = rms(render(scene, settings), reference);
  settings.samples = 128;
  const double fine = rms(render(scene, settings), reference);
  return std::log(fine / coarse) / std::log(128.0 / 8.0);
}

TEST(Convergence, IsAtLeastAsFastAsTheory) {
  const auto scene = sunny_scene();
  const double sky = slope(scene, sky_settings(EnvironmentSampling::kProduct, 1));
  EXPECT_LT(sky, -0.5);
  EXPECT_GT(sky, -1.6);
  Settings occlusion;
  occlusion.light_samples = 1;
  occlusion.pixel_filter = PixelFilter::kBox;
  const double open = slope(scene, occlusion);
  EXPECT_LT(open, -0.6);
  EXPECT_GT(open, -1.6);
}

}  // namespace
}  // namespace komorebi::testing
