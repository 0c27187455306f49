// What is known of the sky by place: learned from a survey, told to tables, and worth it.
#include "render/sky_places.h"

#include <gtest/gtest.h>

#include <limits>

#include "bvh/traverse.h"
#include "render/light.h"
#include "render/light_kernel.h"
#include "render/sky_guide.h"
#include "support/arcade.h"
#include "support/direction_test.h"

namespace komorebi::testing {
namespace {

const Vec3 kUp(0.0f, 0.0f, 1.0f);

/// Two fields of upward points at x = 0…1 and 9…10, one of which sees the sky towards +x alone and
/// the other that towards −x; by `alike` both see all of it.
SkySurvey two_fields(bool alike) {
  SkySurvey survey;
  survey.rays_per_point = 8;
  RandomBits random(3);
  for (int i = 0; i < 20000; ++i) {
    const Bits2 at = random.next();
    const float x = to_unit_float(at.x) + (i % 2 == 0 ? 0.0f : 9.0f);
    survey.points.push_back({Vec3(x, to_unit_float(at.y), 0.0f), kUp});
    for (std::uint32_t j = 0; j < survey.rays_per_point; ++j) {
      const Bits2 bits = random.next();
      const Vec3 d = cosine_hemisphere_disk(Vec2(to_unit_float(bits.x), to_unit_float(bits.y)));
      survey.cells.push_back(static_cast<std::uint16_t>(octahedral_cell(d, SkySurvey::kGrid)));
      survey.seen.push_back(alike || (d.x > 0.0f) == (i % 2 == 0));
    }
  }
  return survey;
}

float share_at(const SkyPlaces& places, std::uint32_t place, const Vec3& direction) {
  std::vector<float> share(std::size_t{SkyPlaces::kGrid} * SkyPlaces::kGrid);
  places.shares(place, SkyVisibility::side(kUp), share);
  return share[octahedral_cell(direction, SkyPlaces::kGrid)];
}

TEST(SkyPlaces, KnowWhichSideOfTheSkyIsTheirs) {
  const SkySurvey survey = two_fields(false);
  const SkyVisibility whole(survey);
  const SkyPlaces places(survey, whole, shared_pool());
  const Vec3 east = glm::normalize(Vec3(1, 0.2f, 1)), west = glm::normalize(Vec3(-1, 0.2f, 1));
  EXPECT_NEAR(whole.share(SkyVisibility::side(kUp), east), 0.5f, 0.15f);
  for (const float x : {0.3f, 0.7f, 9.3f, 9.7f}) {
    const std::uint32_t table = table_of_place(places.view(), kUp, Vec3(x, 0.5f, 0.0f));
    ASSERT_NE(table, kNoTable) << x;
    const std::uint32_t place = places.tables()[table].place;
    const bool is_eastern = x < 5.0f;
    EXPECT_GT(share_at(places, place, is_eastern ? east : west), 0.85f) << x;
    EXPECT_LT(share_at(places, place, is_eastern ? west : east), 0.15f) << x;
  }
  EXPECT_LT(places.variance_left(), 0.3f);
}

TEST(SkyPlaces, AreWorthNothingWhereAllSeeTheSame) {
  const SkySurvey survey = two_fields(true);
  const SkyPlaces places(survey, SkyVisibility(survey), shared_pool());
  EXPECT_GT(places.variance_left(), 0.95f);
}

TEST(SkyPlaces, KnowNothingOfElsewhere) {
  const SkySurvey survey = two_fields(false);
  const SkyPlaces places(survey, SkyVisibility(survey), shared_pool());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Vec3& at : {Vec3(5, 0.5f, 0), Vec3(-3, 0.5f, 0), Vec3(0.5f, 0.5f, 7), Vec3(1e30f),
                         Vec3(nan, 0.5f, 0)}) {
    EXPECT_EQ(table_of_place(places.view(), kUp, at), kNoTable);
  }
  EXPECT_EQ(table_of_place(places.view(), -kUp, Vec3(0.5f, 0.5f, 0)), kNoTable);
}

TEST(SkyPlaces, SurveysWithoutExtentOrPointsHaveNone) {
  SkySurvey survey;
  survey.rays_per_point = 1;
  EXPECT_FALSE(SkyPlaces(survey, SkyVisibility(survey), shared_pool()).view().exists());
  survey.points.assign(100, {Vec3(1, 2, 3), kUp});
  survey.cells.assign(100, static_cast<std::uint16_t>(octahedral_cell(kUp, SkySurvey::kGrid)));
  survey.seen.assign(100, 1);
  const SkyPlaces one_point(survey, SkyVisibility(survey), shared_pool());
  EXPECT_FALSE(one_point.view().exists());
  EXPECT_EQ(one_point.variance_left(), 1.0f);
}

class SkyPlacesOfAScene : public ::testing::Test {
 protected:
  std::shared_ptr<Scene> scene_ = arcade(96, 64);
  FilterTable filter_{PixelFilter::kBox, 1.0f};
  SkyGuide guide_;

  RenderContext guided() {
    Settings settings;
    settings.method = Method::kWorldLight;
    RenderContext context = make_context(*scene_, settings, filter_.view());
    guide_.prepare(*scene_, shared_pool(), Cancel(), context);
    return context;
  }
};

TEST_F(SkyPlacesOfAScene, DensityIsThatOfTheSamplesAndComesToOne) {
  const RenderContext context = guided();
  ASSERT_TRUE(context.product.places.exists());
  const EnvironmentView& e = context.sky;
  const ProductView& p = context.product;
  RandomBits random(8);
  int tables = 0;
  for (const Vec3& place : {Vec3(3, 0, 0), Vec3(6, 1, 0), Vec3(10, -1, 0), Vec3(14, 0, 0)}) {
    const Vec3 at = place - Vec3(context.origin);
    tables += table_of_place(p.places, kUp, at) != kNoTable;
    for (int i = 0; i < 500; ++i) {
      const EnvironmentSample s = sample_product(e, p, kUp, at, random.next());
      const auto found = detail::locate(e, s.direction);
      if (found.s < 1e-3f || found.s > 0.999f || found.z_fraction < 1e-3f ||
          found.z_fraction > 0.999f) {
        continue;  // the direction may be found in the next patch
      }
      ASSERT_NEAR(product_pdf(e, p, kUp, at, s.direction), s.pdf, 5e-3f * s.pdf);
    }
    constexpr std::uint32_t kSide = 512;  // equal areas
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const Vec2 u((static_cast<float>(i % kSide) + 0.5f) / kSide,
                   (static_cast<float>(i / kSide) + 0.5f) / kSide);
      sum += double{product_pdf(e, p, kUp, at, uniform_sphere(u))};
    }
    EXPECT_NEAR(sum * 4.0 * kPi / (kSide * kSide), 1.0, 0.02);
  }
  EXPECT_GE(tables, 3);
}

/// Of surfaces within places, between them and outside, some at no place at all.
TEST_F(SkyPlacesOfAScene, AreFoundInLanesAsOneByOne) {
  const RenderContext context = guided();
  ASSERT_TRUE(context.product.places.exists());
  constexpr std::uint32_t kCount = 4096;
  RandomBits random(4);
  std::vector<float> columns[6];
  std::vector<SurfacePoint> points;
  std::vector<std::uint32_t> seeds, first(kCount, 0);
  std::uint32_t of_places = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const Vec2 a = random.next_2d(), b = random.next_2d();
    SurfacePoint point;
    point.normal = i % 3 != 0 ? kUp : uniform_sphere(b);
    point.geometric_normal = point.normal;
    point.position = Vec3(20.0f * a.x - 1.0f, 8.0f * a.y - 4.0f, i % 4 != 0 ? 0.0f : 4.0f * b.x) -
                     Vec3(context.origin);
    if (i % 100 == 1) point.position.y = std::numeric_limits<float>::quiet_NaN();
    if (i % 100 == 2) point.position *= 1e20f;
    for (int c = 0; c < 3; ++c) {
      columns[static_cast<std::size_t>(c)].push_back(point.normal[c]);
      columns[static_cast<std::size_t>(3 + c)].push_back(leaving_origin(point)[c]);
    }
    const Vec3 local = context.sky.texture_from_world * point.normal;
    of_places +=
        table_of_place(context.product.places, local, leaving_origin(point)) != kNoTable ? 1u : 0u;
    points.push_back(point);
    seeds.push_back(random.next().x);
  }
  EXPECT_GT(of_places, kCount / 8);
  EXPECT_LT(of_places, kCount - kCount / 8);
  LightBlock block{};
  block.point_count = kCount;
  for (std::size_t c = 0; c < 3; ++c) {
    block.normal[c] = block.geometric_normal[c] = columns[c].data();
    block.origin[c] = columns[3 + c].data();
  }
  block.pixel_seed = seeds.data();
  block.first_index = first.data();
  block.rays_per_point = 1;
  block.stride = kCount;
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    std::vector<float> drawn[6];
    for (auto& column : drawn) column.resize(kCount);
    for (std::size_t c = 0; c < 3; ++c) {
      block.direction[c] = drawn[c].data();
      block.contribution[c] = drawn[3 + c].data();
    }
    sample_lights(context, block);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const LightSample expected = sample_light(context, points[i], Sampler(seeds[i]), 0);
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(drawn[static_cast<std::size_t>(3 + c)][i], expected.contribution[c])
            << name << " " << i;
        if (expected.contribution == Vec3(0.0f)) continue;
        ASSERT_EQ(drawn[static_cast<std::size_t>(c)][i], expected.direction[c]) << name << " " << i;
      }
    }
  }
  force_instruction_set("");
}

TEST_F(SkyPlacesOfAScene, AreTheSameForAnyNumberOfThreads) {
  const RenderContext context = guided();
  ThreadPool one(1), three(3);
  SkySurvey a, b;
  ASSERT_TRUE(survey_sky(context, kPlacesSurvey, one, Cancel(), a));
  ASSERT_TRUE(survey_sky(context, kPlacesSurvey, three, Cancel(), b));
  EXPECT_EQ(a.seen, b.seen);
  EXPECT_EQ(a.cells, b.cells);
}

double mean_of(const std::vector<float>& picture) {
  double sum = 0.0;
  for (std::size_t i = 1; i < picture.size(); i += 4) sum += static_cast<double>(picture[i]);
  return sum / (static_cast<double>(picture.size()) / 4.0);
}

/// Guided by places or not at all, the mean of many pictures is the same.
TEST_F(SkyPlacesOfAScene, DoNotChangeTheMean) {
  for (const std::uint32_t bounces : {0u, 2u}) {
    Settings settings;
    settings.method = Method::kWorldLight;
    settings.samples = 4;
    settings.bounces = bounces;
    double sums[2] = {}, squares[2] = {};
    constexpr int kSeeds = 24;
    for (const bool is_guided : {false, true}) {
      settings.guides_light = is_guided;
      for (int seed = 1; seed <= kSeeds; ++seed) {
        settings.seed = static_cast<std::uint32_t>(seed);
        const double mean = mean_of(render(scene_, settings));
        sums[is_guided] += mean;
        squares[is_guided] += mean * mean;
      }
    }
    double error[2], mean[2];
    for (int i = 0; i < 2; ++i) {
      mean[i] = sums[i] / kSeeds;
      error[i] = std::sqrt((squares[i] / kSeeds - mean[i] * mean[i]) / (kSeeds - 1));
    }
    EXPECT_NEAR(mean[1], mean[0], 4.0 * std::hypot(error[0], error[1])) << bounces;
    EXPECT_LT(error[0], 0.02 * mean[0]);
  }
}

/// As many rays by what the whole sees leave more noise.
TEST_F(SkyPlacesOfAScene, LeaveLessNoise) {
  RenderContext context = guided();
  RenderContext of_whole = context;
  of_whole.product.places = {};
  double squares[2] = {};
  int rays = 0;
  RandomBits random(4);
  for (int i = 0; i < 40000; ++i) {
    const Bits2 place = random.next(), bits = random.next();
    Ray ray;
    ray.origin =
        Vec3(1.0f + 14.0f * to_unit_float(place.x), 3.0f * to_unit_float(place.y) - 1.5f, 0.01f) -
        Vec3(context.origin);
    ray.mask = context.light_mask;
    if (table_of_place(context.product.places, kUp, ray.origin) == kNoTable) continue;
    ++rays;
    for (const bool by_place : {false, true}) {
      const RenderContext& by = by_place ? context : of_whole;
      const EnvironmentSample s = sample_product(by.sky, by.product, kUp, ray.origin, bits);
      ray.direction = s.direction;
      if (!(s.direction.z > 0.0f) || occluded_scalar(context.scene, ray)) continue;
      const double value = double{s.radiance.y} * double{s.direction.z} / double{s.pdf};
      squares[by_place] += value * value;
    }
  }
  EXPECT_GT(rays, 20000);
  EXPECT_LT(squares[1], 0.8 * squares[0]);
}

}  // namespace
}  // namespace komorebi::testing
