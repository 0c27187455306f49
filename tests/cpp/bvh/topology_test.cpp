#include "bvh/topology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bvh/morton_grid.h"
#include "bvh/validate.h"

namespace komorebi {
namespace {

constexpr Builder kBuilders[] = {Builder::kPrincipalAxis, Builder::kList};

std::vector<Aabb> random_boxes(std::size_t count, float size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  std::vector<Aabb> boxes(count);
  for (Aabb& box : boxes) {
    const Vec3 p(number(random), number(random), number(random));
    const Vec3 e(number(random), number(random), number(random));
    box = Aabb{p, p + size * glm::abs(e)};
  }
  return boxes;
}

Topology build(std::span<const Aabb> boxes, Builder builder) {
  const Cancel cancel;
  return build_topology(boxes, builder, cancel);
}

TEST(Topology, IsValidForAnyNumberOfItems) {
  for (const Builder builder : kBuilders) {
    for (const std::size_t count : {0u, 1u, 2u, 3u, 4u, 5u, 8u, 9u, 100u, 20011u}) {
      const std::vector<Aabb> boxes = random_boxes(count, 0.1f);
      EXPECT_EQ(validate(build(boxes, builder), boxes), "") << count << " items";
    }
  }
}

TEST(Topology, StaysShallowForEqualBoxes) {
  for (const Builder builder : kBuilders) {
    const std::vector<Aabb> boxes(4096, Aabb{Vec3(1.0f), Vec3(2.0f)});
    const Topology topology = build(boxes, builder);
    EXPECT_EQ(validate(topology, boxes), "");
    EXPECT_EQ(topology.depth, 12u) << "log2 of 4096";
  }
}

TEST(Topology, IsBoundedForTheWorstSpacing) {
  // Every centre so much nearer to 0 than the one before that their mean parts off one item only:
  // 55 levels for 56 items, if nothing stopped it.
  std::vector<Aabb> boxes;
  float x = 0x1p126f;
  for (int left = 56; left > 0; --left) {
    boxes.push_back(Aabb{Vec3(x, 0.0f, 0.0f), Vec3(x, 0.0f, 0.0f)});
    x /= static_cast<float>(left);
  }
  for (const Builder builder : kBuilders) {
    const Topology topology = build(boxes, builder);
    EXPECT_EQ(validate(topology, boxes), "");
    EXPECT_LE(topology.depth, kMaxDepth);
  }
  const std::uint32_t depth = build(boxes, Builder::kPrincipalAxis).depth;
  EXPECT_GE(depth, 40u) << "not the worst spacing any more";
  EXPECT_LE(depth, 45u) << "the way out was not taken";
}

TEST(Topology, SurvivesNumbersThatAreNone) {
  std::vector<Aabb> boxes = random_boxes(1000, 0.1f);
  boxes[3].lo.x = boxes[500].hi.y = std::nanf("");
  boxes[7].lo = Vec3(-kFloatMax);
  boxes[8].hi = Vec3(kFloatMax);
  for (const Builder builder : kBuilders) {
    EXPECT_EQ(build(boxes, builder).order.size(), boxes.size());
  }
}

TEST(Topology, CanBeCancelled) {
  Cancel cancel;
  cancel.raise();
  const std::vector<Aabb> boxes = random_boxes(1000, 0.1f);
  for (const Builder builder : kBuilders) {
    EXPECT_THROW(build_topology(boxes, builder, cancel), Cancelled);
  }
}

TEST(Topology, BuildersHaveNames) {
  EXPECT_EQ(builder_from_name("LINEAR"), Builder::kLinear);
  EXPECT_EQ(builder_from_name("SAH"), Builder::kSah);
  EXPECT_STREQ(builder_name(Builder::kSah), "SAH");
  EXPECT_EQ(builder_from_name("PRINCIPAL_AXIS"), Builder::kPrincipalAxis);
  EXPECT_EQ(builder_from_name("LIST"), Builder::kList);
  EXPECT_THROW(builder_from_name("linear"), std::invalid_argument);
}

TEST(MortonGrid, TakesWideCodesForSmallItemsOnly) {
  const Aabb all{Vec3(-1.0f), Vec3(1.0f)};
  EXPECT_FALSE(choose_morton_grid(all, random_boxes(1000, 0.1f)).wide);
  EXPECT_TRUE(choose_morton_grid(all, random_boxes(1000, 1e-5f)).wide);
}

TEST(MortonGrid, CodesInterleaveBits) {
  EXPECT_EQ(morton_30(1, 0, 0), 4u);
  EXPECT_EQ(morton_30(0, 1, 0), 2u);
  EXPECT_EQ(morton_30(1023, 1023, 1023), (1u << 30) - 1);
  EXPECT_EQ(morton_63(0, 0, 1u << 20), std::uint64_t{1} << 60);
  EXPECT_EQ(morton_63(0x1fffff, 0x1fffff, 0x1fffff), (std::uint64_t{1} << 63) - 1);
  for (std::uint32_t bit = 0; bit < 10; ++bit) {
    EXPECT_EQ(morton_30(1u << bit, 0, 1u << bit), 5u << (3 * bit));
    EXPECT_EQ(morton_63(1u << bit, 0, 1u << bit), std::uint64_t{5} << (3 * bit));
  }
}

// The validator itself: each kind of damage is seen.
TEST(TopologyValidator, SeesDamage) {
  const std::vector<Aabb> boxes = random_boxes(100, 0.1f);
  const Topology good = build(boxes, Builder::kPrincipalAxis);
  ASSERT_EQ(validate(good, boxes), "");
  const auto damaged = [&](auto damage) {
    Topology bad = good;
    damage(bad);
    return validate(bad, boxes);
  };
  EXPECT_NE(damaged([](Topology& t) { t.order[3] = t.order[4]; }), "");
  EXPECT_NE(damaged([](Topology& t) { std::swap(t.left[5], t.right[5]); }), "");
  EXPECT_NE(damaged([](Topology& t) { t.left[t.root] = t.root; }), "");
  EXPECT_NE(damaged([](Topology& t) { t.left[t.root] = 5000; }), "");
  EXPECT_NE(damaged([](Topology& t) { t.bounds[t.left[t.root]].lo.x -= 1.0f; }), "");
  EXPECT_NE(damaged([](Topology& t) { t.bounds[t.left[t.root]].hi.x -= 1.0f; }), "");
  EXPECT_NE(damaged([](Topology& t) { ++t.depth; }), "");
  EXPECT_NE(damaged([](Topology& t) { t.root = t.left[t.root]; }), "");
  EXPECT_NE(damaged([](Topology& t) { t.first[5] += 1; }), "");
  EXPECT_NE(damaged([](Topology& t) { t.left.pop_back(); }), "");
}

}  // namespace
}  // namespace komorebi
