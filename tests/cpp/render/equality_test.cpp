// The same picture to the bit, however the work is cut, ordered, interrupted or vectorised.

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "bvh/traverse.h"
#include "render/one_ray.h"
#include "render/sky_guide.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

std::shared_ptr<const Environment> gradient_map() {
  std::vector<float> texels;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const float sun = x == 9 && y == 12 ? 900.0f : 0.0f;
      texels.insert(texels.end(), {0.1f + 0.02f * static_cast<float>(x) + sun, 0.5f + sun,
                                   0.03f * static_cast<float>(y) + sun});
    }
  }
  return std::make_shared<Environment>("gradient", 32, 16, std::move(texels));
}

/// Ground, a smooth ball, a mirrored and sheared flat one, and a box scaled to a plate.
std::shared_ptr<Scene> busy_scene(Builder builder = Builder::kLinear) {
  const auto ball = sphere(24, {0, 0, 1}, 1.0, true).mesh(builder);
  const auto facets = sphere(9, Vec3d(0), 0.7, false).mesh(builder);
  const auto plate = box(Vec3d(-1), Vec3d(1)).mesh(builder);
  Mat4d sheared = glm::translate(Mat4d(1.0), Vec3d(-1.8, 0.4, 0.8));
  sheared[2][0] = 0.6;
  sheared[0][0] = -1.0;
  const Mat4d flat = glm::scale(glm::translate(Mat4d(1.0), Vec3d(1.5, -1, 2)), Vec3d(1, 0.5, 0));
  auto scene = make_scene({{quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh(builder)},
                           {ball},
                           {facets, sheared},
                           {plate, flat}},
                          camera_at({5, -4, 3}, {0, 0, 0.8}, 150, 90));
  scene->set_world_environment(gradient_map(), 0.7, Mat3d(1.0));
  return committed(scene);
}

Settings small_settings(Method method) {
  Settings s;
  s.method = method;
  s.samples = 7;
  s.light_samples = 3;
  s.seed = 5;
  s.tile_size = 32;
  s.threads = 2;
  return s;
}

class Equality : public ::testing::TestWithParam<Method> {
 protected:
  Settings settings_ = small_settings(GetParam());
};

TEST_P(Equality, BatchesAgreeWithOneRayAfterAnother) {
  const auto scene = busy_scene();
  settings_.has_region = true;
  settings_.region = {30, 20, 110, 70};
  const FilterTable filter(settings_.pixel_filter, settings_.filter_width);
  RenderContext context = make_context(*scene, settings_, filter.view());
  SkyGuide guide;
  guide.prepare(*scene, shared_pool(), Cancel(), context);
  Film film(settings_.region, settings_, scene->max_radiance());
  for (const Rect& cell : cells_of(settings_.region)) {
    TileSums sums;
    film.reset(sums, cell.area());
    std::size_t pixel = 0;
    for (std::uint32_t y = cell.y_min; y < cell.y_max; ++y) {
      for (std::uint32_t x = cell.x_min; x < cell.x_max; ++x, ++pixel) {
        for (std::uint32_t i = 0; i < settings_.samples; ++i) {
          film.add(sums, pixel, i, render_sample(context, x, y, i));
        }
      }
    }
    sums.samples = settings_.samples;
    film.merge({&cell, 1}, sums);
  }
  for (const PassDesc& pass : known_passes()) {
    std::vector<float> expected(pass.channels * settings_.region.area());
    film.read(pass.name, settings_.region, expected.data());
    EXPECT_EQ(render(scene, settings_, pass.name), expected) << pass.name;
  }
}

TEST_P(Equality, ThreadsTilesOrderAndRepetitionDoNotShow) {
  const auto scene = busy_scene();
  const auto expected = render(scene, settings_);
  EXPECT_EQ(render(scene, settings_), expected);
  for (const std::uint32_t threads : {1u, 3u, 7u}) {
    settings_.threads = threads;
    EXPECT_EQ(render(scene, settings_), expected) << threads << " threads";
  }
  for (const std::uint32_t tile : {8u, 13u, 256u}) {
    settings_.tile_size = tile;
    EXPECT_EQ(render(scene, settings_), expected) << "tiles of " << tile;
  }
  settings_.use_progressive = false;
  EXPECT_EQ(render(scene, settings_), expected) << "tile by tile";
}

TEST_P(Equality, BuildersDoNotShow) {
  const auto expected = render(busy_scene(), settings_);
  EXPECT_EQ(render(busy_scene(Builder::kPrincipalAxis), settings_), expected);
  EXPECT_EQ(render(busy_scene(Builder::kList), settings_), expected);
}

TEST_P(Equality, InstructionSetsDoNotShow) {
  const auto scene = busy_scene();
  const auto expected = render(scene, settings_);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
}

TEST_P(Equality, ABorderIsTheCropOfTheWhole) {
  const auto scene = busy_scene();
  const auto whole = render(scene, settings_);
  settings_.has_region = true;
  settings_.region = {37, 11, 101, 64};
  const auto part = render(scene, settings_);
  std::size_t i = 0;
  for (std::uint32_t y = 11; y < 64; ++y) {
    for (std::uint32_t k = 4 * 37; k < 4 * 101; ++k, ++i) {
      ASSERT_EQ(part[i], whole[4 * 150 * y + k]) << "row " << y;
    }
  }
  EXPECT_EQ(i, part.size());
}

TEST_P(Equality, SampleRangesAddUp) {
  const auto scene = busy_scene();
  settings_.samples = 8;
  const auto whole = render(scene, settings_);
  settings_.samples = 4;
  const auto first = render(scene, settings_);
  settings_.sample_offset = 4;
  const auto second = render(scene, settings_);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    ASSERT_NEAR(whole[i], 0.5 * (double{first[i]} + second[i]), 1e-6 * (1.0 + whole[i]));
  }
  EXPECT_NE(first, second);
}

TEST_P(Equality, CancelAndResumeDoNotShow) {
  const auto scene = busy_scene();
  settings_.samples = 48;
  const auto expected = render(scene, settings_);
  EXPECT_EQ(testing::render_with_breaks(scene, settings_), expected);
}

INSTANTIATE_TEST_SUITE_P(Methods, Equality,
                         ::testing::Values(Method::kAmbientOcclusion, Method::kWorldLight),
                         [](const auto& p) {
                           return p.param == Method::kWorldLight ? "WorldLight"
                                                                 : "AmbientOcclusion";
                         });

TEST(Seed, ChangesTheNoiseAndNothingElse) {
  const auto scene = busy_scene();
  Settings settings = small_settings(Method::kAmbientOcclusion);
  const auto one = render(scene, settings);
  settings.seed = 6;
  const auto other = render(scene, settings);
  EXPECT_NE(one, other);
  const Estimate a = estimate(one), b = estimate(other);
  EXPECT_NEAR(a.mean, b.mean, 0.005);
}

}  // namespace
}  // namespace komorebi::testing
