// Light rays drawn in lanes are those of sample_light, to the bit, for every instruction set.
#include <gtest/gtest.h>

#include <algorithm>

#include "bvh/traverse.h"
#include "render/light.h"
#include "render/light_block.h"
#include "support/direction_test.h"
#include "support/environment_maps.h"

namespace komorebi {
namespace {

using testing::RandomBits;

Vec3 random_direction(RandomBits& random) {
  const Bits2 bits = random.next();
  return uniform_sphere(Vec2(to_unit_float(bits.x), to_unit_float(bits.y)));
}

/// Ends of octahedral bins, axes, −0, and many at random; half of them with a geometric normal of
/// their own.
std::vector<SurfacePoint> some_points(std::size_t count) {
  RandomBits random(7);
  std::vector<SurfacePoint> points;
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-1, -0.0f, 0),
                        Vec3(0, 1, -0.0f), Vec3(-0.0f, -1, 0), glm::normalize(Vec3(1, 1, 1e-7f)),
                        glm::normalize(Vec3(-1, 1, -1e-7f)), glm::normalize(Vec3(1, 0, 1))}) {
    SurfacePoint point;
    point.normal = point.geometric_normal = n;
    points.push_back(point);
  }
  while (points.size() < count) {
    SurfacePoint point;
    point.normal = point.geometric_normal = random_direction(random);
    if (points.size() % 2 == 0) {
      point.geometric_normal = glm::normalize(point.normal + 0.7f * random_direction(random));
    }
    points.push_back(point);
  }
  return points;
}

/// What a LightBlock reads, padded.
class PointArrays {
 public:
  void push(const SurfacePoint& point, std::uint32_t pixel_seed, std::uint32_t first_index) {
    for (int c = 0; c < 3; ++c) {
      floats_[c].push_back(point.normal[c]);
      floats_[3 + c].push_back(point.geometric_normal[c]);
      floats_[6 + c].push_back(leaving_origin(point)[c]);
    }
    words_[0].push_back(pixel_seed);
    words_[1].push_back(first_index);
  }

  LightBlock block() {
    LightBlock block{};
    block.point_count = static_cast<std::uint32_t>(words_[0].size());
    for (auto& column : floats_) column.resize(column.size() + LightBlock::kLanes);
    for (auto& column : words_) column.resize(column.size() + LightBlock::kLanes);
    for (std::size_t c = 0; c < 3; ++c) {
      block.normal[c] = floats_[c].data();
      block.geometric_normal[c] = floats_[3 + c].data();
      block.origin[c] = floats_[6 + c].data();
    }
    block.pixel_seed = words_[0].data();
    block.first_index = words_[1].data();
    return block;
  }

 private:
  std::vector<float> floats_[9];
  std::vector<std::uint32_t> words_[2];
};

void expect_equal_to_scalar(RenderContext context, std::uint32_t rays, std::size_t count) {
  context.light_samples = rays;
  const std::vector<SurfacePoint> points = some_points(count);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    LightBlockBuffer block(rays);
    std::uint32_t lit = 0;
    for (std::uint32_t first = 0; first < points.size(); first += block.capacity()) {
      const auto end =
          std::min(first + block.capacity(), static_cast<std::uint32_t>(points.size()));
      PointArrays arrays;
      for (std::uint32_t p = first; p < end; ++p) {
        arrays.push(points[p], Sampler(3, p, 5).pixel_seed, 11 * p);
      }
      block.draw(context, arrays.block());
      for (std::uint32_t p = first; p < end; ++p) {
        for (std::uint32_t j = 0; j < rays; ++j) {
          const LightSample expected =
              sample_light(context, points[p], Sampler(3, p, 5), 11 * p + j);
          const std::uint32_t place = block.place(p - first, j);
          ASSERT_EQ(block.contribution(place), expected.contribution) << name << " " << p;
          if (expected.contribution == Vec3(0.0f)) continue;
          ASSERT_EQ(block.direction(place), expected.direction) << name << " " << p;
          ++lit;
        }
      }
    }
    EXPECT_GT(lit, points.size() * rays / 3) << name;
  }
  force_instruction_set("");
}

TEST(LightKernel, AmbientOcclusion) {
  RenderContext context;
  expect_equal_to_scalar(context, 1, 3000);
  expect_equal_to_scalar(context, 5, 777);
  expect_equal_to_scalar(context, 1500, 20);
  context.ao_sampling = AoSampling::kUniform;
  expect_equal_to_scalar(context, 2, 100);
}

TEST(LightKernel, EvenSky) {
  RenderContext context;
  context.method = Method::kWorldLight;
  context.albedo = Vec3(0.8f, 0.5f, 0.3f);
  context.sky.constant = Vec3(0.05f, 1.7f, 0.0f);
  expect_equal_to_scalar(context, 1, 3000);
  expect_equal_to_scalar(context, 5, 777);
}

TEST(LightKernel, ProductOfMapAndCosine) {
  const Mat3d turn(glm::dvec3(0.36, 0.48, -0.8), glm::dvec3(-0.8, 0.6, 0.0),
                   glm::dvec3(0.48, 0.64, 0.6));
  RenderContext context;
  context.method = Method::kWorldLight;
  context.albedo = Vec3(0.8f, 0.5f, 0.3f);
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {5, 3}, {64, 31}, {150, 70}}) {
    const Environment map = testing::random_map(static_cast<std::uint32_t>(width),
                                                static_cast<std::uint32_t>(height), 3);
    if (map.black()) continue;
    context.sky = map.view(1.7, turn);
    context.product = map.product_table().view();
    expect_equal_to_scalar(context, 3, 2000);
  }
  const Environment sunny = testing::sunny_map(1024, 512, 77, 400, 1e6f);
  context.sky = sunny.view(1.0, Mat3d(1.0));
  context.product = sunny.product_table().view();
  expect_equal_to_scalar(context, 16, 4000);
}

TEST(LightKernel, MapsOfEveryStorage) {
  RenderContext context;
  context.method = Method::kWorldLight;
  for (const auto storage : {LightStorage::kHalf, LightStorage::kRgbe}) {
    const Environment map = testing::stored_map(150, 70, 3, storage);
    context.sky = map.view(1.7);
    ASSERT_EQ(context.sky.storage, storage);
    context.product = map.product_table().view();
    expect_equal_to_scalar(context, 3, 2000);
  }
}

TEST(LightKernel, OtherStrategies) {
  const Environment map = testing::random_map(30, 20, 5);
  RenderContext context;
  context.method = Method::kWorldLight;
  context.sky = map.view();
  context.cosine_share = 0.5f;
  expect_equal_to_scalar(context, 2, 200);
}

}  // namespace
}  // namespace komorebi
