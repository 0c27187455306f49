// How many light rays a camera sample casts where that is left open.
#include "render/light_samples.h"

#include <gtest/gtest.h>

#include "support/environment_maps.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

/// Ridges four to a pixel under a low sun: a camera sample meets a bright side or a dark one.
std::shared_ptr<Scene> ridges(std::uint32_t width, std::uint32_t height) {
  Polygons p;
  constexpr double kStep = 0.01;
  for (double x = -5.0; x < 5.0; x += 2.0 * kStep) {
    const auto v = p.vertex({x, -5, 0});
    p.vertex({x, 5, 0});
    p.vertex({x + kStep, 5, kStep});
    p.vertex({x + kStep, -5, kStep});
    p.vertex({x + 2.0 * kStep, 5, 0});
    p.vertex({x + 2.0 * kStep, -5, 0});
    p.face({v, v + 1, v + 2, v + 3});
    p.face({v + 3, v + 2, v + 4, v + 5});
  }
  auto scene = make_scene({{p.mesh()}}, camera_at({0, 0, 10}, {0, 0, 0}, width, height));
  auto map = std::shared_ptr<const Environment>(new Environment(sunny_map(64, 32, 31, 20, 500.0f)));
  scene->set_world_environment(map, 1.0, Mat3d(1.0));
  return committed(scene);
}

/// A box on the ground, without noise but that of the light rays and of a few edges.
std::shared_ptr<Scene> box_on_ground(std::uint32_t width, std::uint32_t height) {
  return committed(make_scene(
      {{quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh()}, {box({-1, -1, 0}, {1, 1, 2}).mesh()}},
      camera_at({4, -5, 4}, {0, 0, 0.5}, width, height)));
}

std::uint32_t chosen(const std::shared_ptr<Scene>& scene, Settings settings) {
  settings.samples = 1;
  Session session(scene, settings);
  while (!session.wait(10.0)) {
  }
  EXPECT_EQ(session.error(), "");
  return session.light_samples();
}

Settings world_light() {
  Settings settings;
  settings.method = Method::kWorldLight;
  return settings;
}

TEST(LightSamples, FewerWhereCameraSamplesDiffer) {
  EXPECT_EQ(chosen(ridges(128, 112), world_light()), kAutomaticLightSamples / 2);
  EXPECT_EQ(chosen(box_on_ground(128, 112), Settings()), kAutomaticLightSamples);
}

TEST(LightSamples, TooSmallToTell) {
  EXPECT_EQ(chosen(ridges(64, 48), world_light()), kAutomaticLightSamples);
}

TEST(LightSamples, AsAsked) {
  Settings settings = world_light();
  settings.light_samples = 3;
  EXPECT_EQ(chosen(ridges(128, 112), settings), 3u);
}

/// What is chosen belongs to the scene: parts of one picture must agree on it.
TEST(LightSamples, TheSameForEveryPart) {
  const auto scene = ridges(128, 112);
  const FilterTable filter(PixelFilter::kBox, 1.0f);
  const RenderContext context = make_context(*scene, world_light(), filter.view());
  const std::uint32_t first = choose_light_samples(context, shared_pool(), Cancel());
  ThreadPool one(1);
  RenderContext other = context;
  other.seed = 77;
  other.light_samples = 2;
  EXPECT_EQ(choose_light_samples(other, one, Cancel()), first);
  Settings border = world_light();
  border.seed = 5;
  border.sample_offset = 9;
  border.has_region = true;
  border.region = {3, 4, 21, 17};
  EXPECT_EQ(chosen(scene, border), first);
}

/// The specification of a picture with what was chosen: automatic is nothing but a number.
TEST(LightSamples, AutomaticIsThePictureOfThatNumber) {
  const auto scene = ridges(128, 112);
  Settings automatic = world_light(), four = world_light();
  automatic.samples = four.samples = 2;
  four.light_samples = kAutomaticLightSamples / 2;
  EXPECT_EQ(render(scene, automatic), render(scene, four));
}

TEST(LightSamples, CancelledAndResumed) {
  const auto scene = ridges(256, 224);
  Settings settings = world_light();
  settings.samples = 8;
  EXPECT_EQ(render_with_breaks(scene, settings), render(scene, settings));
}

}  // namespace
}  // namespace komorebi::testing
