// Light rays that go where the sky is seen: what is measured of a scene, that the mean of the
// picture does not depend on it, and that it pays.
#include "render/sky_guide.h"

#include <gtest/gtest.h>

#include "render/sky_visibility.h"
#include "support/environment_maps.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

/// A room of 4 × 4 × 3 m with one window of 1 × 1 m in the wall at x = 2, and what is seen from
/// beside it.
std::shared_ptr<Scene> room_with_window() {
  const auto wall = [](const Vec3d& corner, const Vec3d& a, const Vec3d& b) {
    return Placed{quad(corner, a, b).mesh()};
  };
  auto scene =
      make_scene({wall({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), wall({-2, -2, 3}, {4, 0, 0}, {0, 4, 0}),
                  wall({-2, -2, 0}, {4, 0, 0}, {0, 0, 3}), wall({-2, 2, 0}, {4, 0, 0}, {0, 0, 3}),
                  wall({-2, -2, 0}, {0, 4, 0}, {0, 0, 3}), wall({2, -2, 0}, {0, 4, 0}, {0, 0, 1}),
                  wall({2, -2, 2}, {0, 4, 0}, {0, 0, 1}), wall({2, -2, 1}, {0, 1.5, 0}, {0, 0, 1}),
                  wall({2, 0.5, 1}, {0, 1.5, 0}, {0, 0, 1})},
                 camera_at({1.8, -1.8, 2.5}, {-1, 0.5, 0.3}, 48, 36));
  auto map = std::shared_ptr<const Environment>(new Environment(random_map(64, 32, 5)));
  scene->set_world_environment(map, 0.7, Mat3d(1.0));
  return committed(scene);
}

std::shared_ptr<Scene> open_ground() {
  return committed(make_scene({{quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh()}},
                              camera_at({0, -4, 3}, {0, 0, 0}, 48, 36)));
}

RenderContext context_of(const Scene& scene, Method method, const FilterTable& filter) {
  Settings settings;
  settings.method = method;
  return make_context(scene, settings, filter.view());
}

SkyVisibility measured(const Scene& scene, Method method) {
  const FilterTable filter(PixelFilter::kBox, 1.0f);
  const RenderContext context = context_of(scene, method, filter);
  SkySurvey survey;
  EXPECT_TRUE(survey_sky(context, kWholeSurvey, shared_pool(), Cancel(), survey));
  return SkyVisibility(survey);
}

TEST(SkyVisibility, KnowsTheWindow) {
  const SkyVisibility seen = measured(*room_with_window(), Method::kWorldLight);
  const std::uint32_t up = SkyVisibility::side({0, 0, 1}), inwards = SkyVisibility::side({1, 0, 0});
  const Vec3 through = glm::normalize(Vec3(2, -0.1, 1.2));
  EXPECT_GT(seen.share(up, through), 0.15f);
  EXPECT_LT(seen.share(up, Vec3(0.1f, 0.1f, 1)), 0.02f);
  EXPECT_LT(seen.share(up, glm::normalize(Vec3(-2, 0.1, 1.2))), 0.05f);
  EXPECT_LT(seen.share(inwards, Vec3(0.9f, 0.3f, 0.3f)), 0.5f);
  EXPECT_LT(seen.variance_left(), 0.4f);
}

TEST(SkyVisibility, OpenGroundSeesAll) {
  const SkyVisibility seen = measured(*open_ground(), Method::kAmbientOcclusion);
  const Vec3 up(0, 0, 1);
  EXPECT_GT(seen.share(SkyVisibility::side(up), up), 0.9f);
}

TEST(SkyVisibility, SidesAreTheNearestAxes) {
  for (std::uint32_t side = 0; side < SkyVisibility::kSides; ++side) {
    Vec3 normal(0.3f, -0.2f, 0.25f);
    normal[static_cast<int>(side / 2)] = side % 2 == 0 ? 0.8f : -0.8f;
    EXPECT_EQ(SkyVisibility::side(normal), side);
  }
}

TEST(SkyGuide, IsForWhatHidesTheSky) {
  const FilterTable filter(PixelFilter::kBox, 1.0f);
  SkyGuide in_room, outside;
  const auto room = room_with_window(), ground = open_ground();
  RenderContext context = context_of(*room, Method::kAmbientOcclusion, filter);
  in_room.prepare(*room, shared_pool(), Cancel(), context);
  EXPECT_GT(context.product.bins, 0u);
  context = context_of(*ground, Method::kAmbientOcclusion, filter);
  outside.prepare(*ground, shared_pool(), Cancel(), context);
  EXPECT_EQ(context.product.bins, 0u);
}

TEST(SkyGuide, CancelLeavesItToTheNextTime) {
  const FilterTable filter(PixelFilter::kBox, 1.0f);
  const auto scene = room_with_window();
  RenderContext context = context_of(*scene, Method::kWorldLight, filter);
  const std::uint32_t* const of_the_map = context.product.row_cdf;
  Cancel cancel;
  cancel.raise();
  SkyGuide guide;
  guide.prepare(*scene, shared_pool(), cancel, context);
  EXPECT_EQ(context.product.row_cdf, of_the_map);
  guide.prepare(*scene, shared_pool(), Cancel(), context);
  EXPECT_NE(context.product.row_cdf, of_the_map);
}

/// The mean of the picture's green, over many seeds, and its standard error.
Estimate mean_of(const std::shared_ptr<Scene>& scene, Settings settings) {
  constexpr int kSeeds = 24;
  double sum = 0.0, squares = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    settings.seed = static_cast<std::uint32_t>(seed);
    const std::vector<float> picture = render(scene, settings);
    double mean = 0.0;
    for (std::size_t i = 1; i < picture.size(); i += 4) mean += static_cast<double>(picture[i]);
    mean /= static_cast<double>(picture.size() / 4);
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / kSeeds;
  return {mean, std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1))};
}

/// Of the pixels' errors against a good picture.
double squared_error(const std::shared_ptr<Scene>& scene, Settings settings,
                     const std::vector<float>& truth) {
  settings.samples = 4;
  settings.seed = 99;
  const std::vector<float> picture = render(scene, settings);
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const double d = static_cast<double>(picture[i]) - static_cast<double>(truth[i]);
    sum += d * d;
  }
  return sum;
}

/// Guided and unguided settings have the same mean; guided ones have less noise.
void expect_same_but_better(const Settings& guided, const Settings& unguided) {
  const auto scene = room_with_window();
  const Estimate a = mean_of(scene, guided), b = mean_of(scene, unguided);
  EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.error, b.error));
  EXPECT_LT(b.error, 0.03 * b.mean);
  Settings good = guided;
  good.samples = 256;
  good.seed = 1234;
  const std::vector<float> truth = render(scene, good);
  EXPECT_LT(2.0 * squared_error(scene, guided, truth), squared_error(scene, unguided, truth));
}

TEST(SkyGuide, WorldLightInARoom) {
  Settings guided, unguided;
  guided.method = unguided.method = Method::kWorldLight;
  guided.samples = unguided.samples = 8;
  unguided.environment_sampling = EnvironmentSampling::kMis;
  expect_same_but_better(guided, unguided);
}

TEST(SkyGuide, AmbientOcclusionInARoom) {
  Settings guided, unguided;
  guided.samples = unguided.samples = 8;
  unguided.ao_sampling = AoSampling::kUniform;
  expect_same_but_better(guided, unguided);
}

}  // namespace
}  // namespace komorebi::testing
