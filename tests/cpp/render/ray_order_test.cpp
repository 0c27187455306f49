// The order that scattered rays are traced in: each once, an octant after the other, along the
// curve, and those of a cell as they came.
#include "render/ray_order.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/morton.h"
#include "render/ray_batch.h"
#include "support/direction_test.h"

namespace komorebi::testing {
namespace {

/// Octant and cell of a grid of 128 over origins from −1 to 1.
std::uint32_t key(const Ray& ray) {
  const auto cell = [](float x) {
    return std::min(static_cast<std::uint32_t>((x + 1.0f) * 64.0f), 127u);
  };
  const std::uint32_t octant = (ray.direction.x < 0.0f ? 1u : 0u) |
                               (ray.direction.y < 0.0f ? 2u : 0u) |
                               (ray.direction.z < 0.0f ? 4u : 0u);
  return octant << 21 | morton_30(cell(ray.origin.x), cell(ray.origin.y), cell(ray.origin.z));
}

TEST(RayOrder, IsByOctantAndCell) {
  RandomBits random(5);
  RayOrder order;
  for (const std::uint32_t count : {2u, 3u, 17u, 500u, 4096u, 70000u}) {
    RayBatch rays;
    std::vector<std::uint64_t> expected;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Bits2 a = random.next(), b = random.next();
      Ray ray;  // many of a cell, and the corners of the grid
      const float side = i == 0 ? -1.0f : i == 1 ? 1.0f : 0.0f;
      ray.origin = i < 2 ? Vec3(side)
                         : Vec3(static_cast<float>(a.x % 9), static_cast<float>(a.y % 9),
                                static_cast<float>(b.x % 9)) /
                                   4.0f -
                               1.0f;
      ray.direction = uniform_sphere(Vec2(to_unit_float(b.x), to_unit_float(b.y)));
      rays.push(ray);
      expected.push_back(std::uint64_t{key(ray)} << 32 | i);
    }
    std::sort(expected.begin(), expected.end());
    const std::vector<std::uint32_t>& found = order.sort(rays.span());
    ASSERT_EQ(found.size(), count);
    for (std::uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(found[i], static_cast<std::uint32_t>(expected[i])) << i << " of " << count;
    }
  }
}

TEST(RayOrder, OfNoneOneAndAllAtOnePlace) {
  RayOrder order;
  RayBatch rays;
  rays.reserve(1);
  EXPECT_TRUE(order.sort(rays.span()).empty());
  Ray ray;
  ray.origin = Vec3(3.0f);
  ray.direction = Vec3(0.0f, 0.0f, 1.0f);
  for (std::uint32_t i = 0; i < 40; ++i) {
    rays.push(ray);
    const std::vector<std::uint32_t>& found = order.sort(rays.span());
    ASSERT_EQ(found.size(), i + 1);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    EXPECT_EQ(found.back(), i);
  }
}

}  // namespace
}  // namespace komorebi::testing
