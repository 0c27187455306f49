// The same picture to the bit, however the work is cut, ordered, interrupted or vectorised.

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "bvh/traverse.h"
#include "render/one_ray.h"
#include "render/sky_guide.h"
#include "support/arcade.h"
#include "support/busy_scenes.h"

namespace komorebi::testing {
namespace {

std::vector<std::string> every_pass() {
  std::vector<std::string> names = {"CryptoObject00", "CryptoMaterial00", "CryptoAsset00",
                                    "CryptoObject01", "Material Value 1 3"};
  for (const PassDesc& pass : known_passes()) names.emplace_back(pass.name);
  return names;
}

class Equality : public ::testing::TestWithParam<Method> {
 protected:
  Settings settings_ = small_settings(GetParam());
};

void expect_batches_as_one_ray(const std::shared_ptr<Scene>& scene, Settings settings_) {
  settings_.has_region = true;
  settings_.region = {30, 20, 110, 70};
  settings_.ao_distance = 1.5f;
  settings_.passes = every_pass();
  const FilterTable filter(settings_.pixel_filter, settings_.filter_width);
  RenderContext context = make_context(*scene, settings_, filter.view());
  SkyGuide guide;
  guide.prepare(*scene, shared_pool(), Cancel(), context);
  Film film(settings_.region, settings_, max_radiance(*scene, settings_), scene->has_catchers(),
            scene->tables().max_value());
  for (const Rect& cell : cells_of(settings_.region)) {
    TileSums sums;
    film.reset(sums, cell.area());
    std::vector<float> row(film.layout().size());
    std::size_t pixel = 0;
    for (std::uint32_t y = cell.y_min; y < cell.y_max; ++y) {
      for (std::uint32_t x = cell.x_min; x < cell.x_max; ++x, ++pixel) {
        for (std::uint32_t i = 0; i < settings_.samples; ++i) {
          const PixelSample sample = render_sample(context, x, y, i, row.data());
          film.add(sums, pixel, i, sample, row.data());
        }
      }
    }
    sums.samples = settings_.samples;
    film.merge({&cell, 1}, sums);
  }
  for (const std::string& pass : settings_.passes) {
    std::vector<float> expected(find_pass(pass).channels * settings_.region.area());
    film.read(pass, settings_.region, expected.data());
    EXPECT_EQ(render(scene, settings_, pass), expected) << pass;
    const auto differs = [&](float value) { return value != expected.front(); };
    if (pass == "Debug Sample Count" || pass == "CryptoObject01") continue;  // the same everywhere
    if (pass == "Environment" && scene->world_is_uniform()) continue;
    if (pass == "Emission" && scene->tables().surfaces.empty()) continue;  // nothing shines
    if (!scene->has_catchers()) continue;
    EXPECT_TRUE(std::any_of(expected.begin(), expected.end(), differs)) << pass << " is empty";
  }
}

TEST_P(Equality, BatchesAgreeWithOneRayAfterAnother) {
  expect_batches_as_one_ray(telling_scene(), settings_);
}

TEST(EqualityOfPlaces, BatchesAgreeWithOneRayAfterAnother) {
  Settings settings = small_settings(Method::kWorldLight);
  settings.bounces = 3;
  expect_batches_as_one_ray(arcade(160, 100), settings);
}

TEST_P(Equality, BatchesAgreeWithOneRayWhereLampsAreAllTheLight) {
  expect_batches_as_one_ray(telling_scene(nullptr, {}, true), settings_);
}

TEST_P(Equality, BatchesAgreeWithOneRayInMotion) {
  expect_batches_as_one_ray(moving_scene(), settings_);
}

TEST_P(Equality, BatchesAgreeWithOneRayAfterAnotherThroughBounces) {
  settings_.samples = 3;
  for (const std::uint32_t bounces : {1u, 2u, 5u}) {  // of the last, paths end by roulette
    settings_.bounces = bounces;
    expect_batches_as_one_ray(telling_scene(), settings_);
    settings_.sample_clamp_direct = 0.5f;
    settings_.sample_clamp_indirect = 0.2f;
  }
  expect_batches_as_one_ray(moving_scene(), settings_);
}

TEST_P(Equality, BatchesAgreeWithOneRayByFastGi) {
  settings_.samples = 2;
  settings_.bounces = 3;
  settings_.use_fast_gi = true;
  settings_.fast_gi_distance = 0.8f;
  settings_.fast_gi_factor = 0.7f;
  const auto expect_alike = [&] {
    expect_batches_as_one_ray(telling_scene(), settings_);
    expect_batches_as_one_ray(telling_scene(nullptr, {}, true), settings_);
  };
  for (settings_.fast_gi_bounces = 1; settings_.fast_gi_bounces <= 3; ++settings_.fast_gi_bounces) {
    expect_alike();
  }
  settings_.fast_gi_method = FastGiMethod::kAdd;
  expect_alike();
  settings_.world_max_bounces = 1;
  expect_alike();
}

TEST_P(Equality, ThroughBouncesThreadsTilesBuildersAndInstructionSetsDoNotShow) {
  settings_.bounces = 4;
  const auto scene = busy_scene();
  const auto expected = render(scene, settings_);
  settings_.threads = 1;
  settings_.tile_size = 24;
  EXPECT_EQ(render(scene, settings_), expected);
  EXPECT_EQ(render(busy_scene(Builder::kList), settings_), expected);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
  settings_.bounces = 3;
  EXPECT_NE(render(scene, settings_), expected);
}

TEST_P(Equality, BatchesAgreeWithOneRayOnMaterials) {
  settings_.samples = 3;
  settings_.bounces = 3;
  expect_batches_as_one_ray(telling_scene(nullptr, many_lobes()), settings_);
}

TEST_P(Equality, OfMaterialsThreadsTilesAndInstructionSetsDoNotShow) {
  settings_.bounces = 2;
  const auto scene = telling_scene(nullptr, many_lobes());
  const auto expected = render(scene, settings_);
  EXPECT_NE(render(telling_scene(), settings_), expected);
  settings_.threads = 1;
  settings_.tile_size = 24;
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
}

TEST_P(Equality, BatchesAgreeWithOneRayThroughCutOuts) {
  const Lottery lottery(0.6);
  expect_batches_as_one_ray(telling_scene(&lottery), settings_);
  expect_batches_as_one_ray(moving_scene(Builder::kLinear, &lottery), settings_);
  EXPECT_GT(lottery.asked(), 10000u);
}

TEST_P(Equality, OfCutOutsThreadsTilesBuildersAndInstructionSetsDoNotShow) {
  const Lottery lottery(0.6);
  const auto scene = moving_scene(Builder::kLinear, &lottery);
  const auto expected = render(scene, settings_);
  EXPECT_NE(render(moving_scene(), settings_), expected);
  settings_.threads = 1;
  settings_.tile_size = 24;
  EXPECT_EQ(render(moving_scene(Builder::kSah, &lottery), settings_), expected);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
}

TEST_P(Equality, OfMotionThreadsTilesBuildersAndInstructionSetsDoNotShow) {
  const auto scene = moving_scene();
  const auto expected = render(scene, settings_);
  settings_.threads = 1;
  settings_.tile_size = 24;
  EXPECT_EQ(render(scene, settings_), expected);
  EXPECT_EQ(render(moving_scene(Builder::kList), settings_), expected);
  EXPECT_EQ(render(moving_scene(Builder::kSah), settings_), expected);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
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
