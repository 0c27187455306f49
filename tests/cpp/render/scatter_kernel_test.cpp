// Paths scattered in lanes go on as scatter lets them, to the bit, for every instruction set.
#include "render/scatter_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bvh/traverse.h"
#include "render/scatter.h"
#include "support/direction_test.h"

namespace komorebi::testing {
namespace {

constexpr std::size_t kPadding = 16;

/// Vertices of paths, and what is found of them.
struct Vertices {
  std::vector<float> floats[13];  // normal, geometric normal, frequency, throughput, direction
  std::vector<std::uint32_t> words[4];  // pixel_seed, sample, goes_on, path_key

  explicit Vertices(std::size_t count) {
    for (auto& column : floats) column.resize(count + kPadding);
    for (auto& column : words) column.resize(count + kPadding);
  }
  Vec3 vector(std::size_t first, std::size_t i) const {
    return Vec3(floats[first][i], floats[first + 1][i], floats[first + 2][i]);
  }
  void set(std::size_t first, std::size_t i, const Vec3& v) {
    for (std::size_t c = 0; c < 3; ++c) floats[first + c][i] = v[static_cast<int>(c)];
  }
  ScatterBlock block() {
    ScatterBlock block{};
    block.count = static_cast<std::uint32_t>(words[0].size() - kPadding);
    for (std::size_t c = 0; c < 3; ++c) {
      block.normal[c] = floats[c].data();
      block.geometric_normal[c] = floats[3 + c].data();
      block.throughput[c] = floats[7 + c].data();
      block.direction[c] = floats[10 + c].data();
    }
    block.frequency = floats[6].data();
    block.pixel_seed = words[0].data();
    block.sample = words[1].data();
    block.goes_on = words[2].data();
    block.path_key = words[3].data();
    return block;
  }
};

/// Axes and many at random; throughputs from nothing to more than 1, some of them no numbers.
Vertices some_vertices(std::size_t count) {
  RandomBits random(9);
  const auto direction = [&] { return uniform_sphere(random.next_2d()); };
  const Vec3 axes[] = {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-1, -0.0f, 0),
                       Vec3(0, 1, -0.0f)};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float odd[] = {0.0f, -0.0f, -1.0f, 1.0f, 1e-38f, 1e30f, nan};
  Vertices made(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 normal = i < std::size(axes) ? axes[i] : direction();
    made.set(0, i, normal);
    made.set(3, i, i % 2 == 0 ? normal : glm::normalize(normal + 0.7f * direction()));
    made.floats[6][i] = i % 3 == 0 ? 1.0f : 1.0f + random.next_2d().x;
    const Vec2 a = random.next_2d(), b = random.next_2d();
    made.set(7, i, 1.2f * Vec3(a.x, a.y, b.x));
    if (i % 5 == 0) made.floats[7 + i % 3][i] = odd[i / 5 % std::size(odd)];
    if (i % 31 == 0) made.set(7, i, Vec3(0.0f));
    made.words[0][i] = random.next().x;
    made.words[1][i] = static_cast<std::uint32_t>(i) * 7u;
  }
  return made;
}

void expect_equal_to_scalar(const RenderContext& context, std::uint32_t vertex, std::size_t count) {
  const Vertices given = some_vertices(count);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    Vertices found = given;
    scatter_all(context, vertex, found.block());
    std::size_t gone_on = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const ScatterPoint point{given.vector(0, i), given.vector(3, i), Vec3(0.0f),
                               given.floats[6][i]};
      Vec3 throughput = given.vector(7, i);
      Ray ray;
      const bool goes_on = scatter(context, vertex, point, Sampler(given.words[0][i]),
                                   given.words[1][i], throughput, ray);
      ASSERT_EQ(found.words[2][i], goes_on ? 1u : 0u) << name << " " << i;
      if (!goes_on) continue;
      ++gone_on;
      ASSERT_EQ(found.vector(10, i), ray.direction) << name << " " << i;
      ASSERT_EQ(found.words[3][i], ray.path_key) << name << " " << i;
      for (int c = 0; c < 3; ++c) {  // with those that are no numbers
        const float ours = found.vector(7, i)[c], expected = throughput[c];
        ASSERT_TRUE(ours == expected || (std::isnan(ours) && std::isnan(expected)))
            << name << " " << i;
      }
    }
    EXPECT_GT(gone_on, count / 3) << name;
  }
  force_instruction_set("");
}

TEST(ScatterKernel, FirstVerticesScatterAll) {
  expect_equal_to_scalar(RenderContext(), 0, 3000);
  expect_equal_to_scalar(RenderContext(), 1, 19);
}

TEST(ScatterKernel, LaterOnesPlayRoulette) {
  expect_equal_to_scalar(RenderContext(), kSureScatters, 5000);
  expect_equal_to_scalar(RenderContext(), 7, 777);
}

TEST(ScatterKernel, CosinesAreCut) {
  RenderContext context;
  context.cuts_cosines = true;
  expect_equal_to_scalar(context, 0, 3000);
  expect_equal_to_scalar(context, 3, 3000);
}

}  // namespace
}  // namespace komorebi::testing
