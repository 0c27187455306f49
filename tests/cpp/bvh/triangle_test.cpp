// The specification of ray and triangle, against exact arithmetic.
#include "core/triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace komorebi {
namespace {

bool meet(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c,
          TriangleHit* hit) {
  const SlabRay slab = make_slab_ray(origin, direction, Vec3(max_abs(origin) * kPadding));
  return intersect_triangle(make_shear_ray(origin, direction), slab, Interval{0.0f, kFloatMax},
                            0.0f, kFloatMax, a, b, c, hit);
}

TEST(Triangle, DecidesByTheExactSignWhereFloatSeesZero) {
  // c.x·b.y = 1 + 2⁻¹¹ + 2⁻²⁴ and c.y·b.x = 1 + 2⁻¹¹ are one float: the ray along z seems to pass
  // through the edge from b to c and is in truth 2⁻²⁵ beside it.
  const Vec3 b(1 + 0x1p-11f, 1 + 0x1p-12f, 0), c(1 + 0x1p-12f, 1, 0);
  const Vec3 origin(0, 0, 1), down(0, 0, -1);
  ASSERT_EQ(c.x * b.y, c.y * b.x);
  TriangleHit hit;
  // b and c lie on one side of the ray; take d so that the edge's line passes it on to the far one.
  const Vec3 far_c(-c.x, -c.y, 0);
  const Vec3 left(-1, 1, 0), right(1, -1, 0);
  const bool in_left = meet(origin, down, left, b, far_c, &hit);
  const bool in_right = meet(origin, down, right, b, far_c, &hit);
  EXPECT_NE(in_left, in_right) << "exactly one of the two triangles at the edge is hit";
}

TEST(Triangle, AgreesWithDoubleAtEveryScale) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto point = [&] { return Vec3d(number(random), number(random), number(random)); };
  for (const double scale : {1e-15, 1e-3, 1.0, 1e3, 1e12}) {
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 a(scale * point()), b(scale * point()), c(scale * point());
      const Vec3 origin(4.0 * scale * point());
      const Vec3 direction = Vec3(0.3 * scale * point()) - origin;
      const Vec3d e1 = Vec3d(b) - Vec3d(a), e2 = Vec3d(c) - Vec3d(a), d(direction);
      const Vec3d across = glm::cross(d, e2), from_a = Vec3d(origin) - Vec3d(a);
      const double determinant = glm::dot(e1, across);
      const double u = glm::dot(from_a, across) / determinant;
      const double v = glm::dot(d, glm::cross(from_a, e1)) / determinant;
      const double t = glm::dot(e2, glm::cross(from_a, e1)) / determinant;
      const double sine =
          std::abs(determinant) / (glm::length(glm::cross(e1, e2)) * glm::length(d));
      const double height = glm::length(glm::cross(e1, e2)) /
                            std::max({glm::length(e1), glm::length(e2), glm::length(e1 - e2)});
      const double bound = 1e-5 * scale / (sine * height);
      if (bound > 0.01) continue;  // grazing or a sliver: no digits to compare
      TriangleHit hit;
      const bool found = meet(origin, direction, a, b, c, &hit);
      const double margin = std::min({u, v, 1 - u - v, t});
      if (std::abs(margin) <= bound) continue;
      ASSERT_EQ(found, margin > 0);
      if (!found) continue;
      ++hits;
      ASSERT_NEAR(hit.u, u, bound);
      ASSERT_NEAR(hit.v, v, bound);
      ASSERT_NEAR(hit.t, t, bound);
    }
    EXPECT_GT(hits, 1000) << "scale " << scale;
  }
}

TEST(Triangle, NeighboursLeaveNoGap) {
  // Fans around a point, aimed at that point and along its spokes: at least one is hit, always.
  std::mt19937 random(2);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  for (int i = 0; i < 20000; ++i) {
    const float scale = std::ldexp(1.0f, i % 40 - 20);
    const Vec3 middle = scale * Vec3(number(random), number(random), number(random));
    Vec3 rim[5];
    for (int k = 0; k < 5; ++k) {
      rim[k] = middle + scale * Vec3(std::cos(1.2566f * float(k)), std::sin(1.2566f * float(k)),
                                     0.5f * number(random));
    }
    Vec3 origin = middle + scale * Vec3(number(random), number(random), 3.0f);
    if (i % 4 == 0) origin = Vec3(middle.x, middle.y, origin.z);  // exactly along an axis
    const Vec3 target = middle + (i % 2 == 0 ? 0.0f : 0.5f) * (rim[i % 5] - middle);
    int found = 0;
    TriangleHit hit;
    for (int k = 0; k < 5; ++k) {
      Vec3 corner[3];
      corner[i % 3] = middle;
      corner[(i + 1) % 3] = rim[k];
      corner[(i + 2) % 3] = rim[(k + 1) % 5];
      found += meet(origin, target - origin, corner[0], corner[1], corner[2], &hit) ? 1 : 0;
    }
    ASSERT_GE(found, 1) << "ray " << i;
  }
}

TEST(Triangle, HitsLieInTheTrianglesOwnInterval) {
  // Also where rays graze and t has few digits: a box is skipped by its interval alone.
  std::mt19937 random(6);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  const auto point = [&] { return Vec3(number(random), number(random), number(random)); };
  int hits = 0;
  for (int i = 0; i < 50000; ++i) {
    const Vec3 a = point(), b = a + 0.01f * point(), c = a + 0.01f * point();
    const Vec3 target = (a + b + c) / 3.0f;
    const Vec3 direction = (a - b) + (i % 2 == 0 ? 0.0f : 1e-8f) * point();
    const Vec3 origin = target - 300.0f * direction;
    TriangleHit hit;
    if (!meet(origin, direction, a, b, c, &hit)) continue;
    ++hits;
    const SlabRay slab = make_slab_ray(origin, direction, Vec3(max_abs(origin) * kPadding));
    const Interval inside =
        slab_interval(slab, triangle_bounds(a, b, c), Interval{0.0f, kFloatMax});
    ASSERT_TRUE(inside.begin <= hit.t && hit.t <= inside.end) << "ray " << i;
  }
  EXPECT_GT(hits, 1000);
}

TEST(Triangle, NoAreaIsSeenExactly) {
  const Vec3 a(0.1f, 0.2f, 0.3f), b(0.4f, 0.8f, 1.2f);
  EXPECT_TRUE(is_degenerate(a, a, b));
  EXPECT_TRUE(is_degenerate(a, b, a));
  EXPECT_TRUE(is_degenerate(Vec3(0.0f), a, 2.0f * a));
  EXPECT_FALSE(is_degenerate(a, b, Vec3(0.4f, 0.8f, std::nextafter(1.2f, 2.0f))));
  EXPECT_FALSE(is_degenerate(Vec3(0.0f), Vec3(1e-30f, 0, 0), Vec3(0, 1e-30f, 0)));
  EXPECT_TRUE(is_degenerate(a, b, Vec3(std::nanf(""), 0, 0)));
}

TEST(Slab, BoxesInBoxesHaveIntervalsInIntervals) {
  // Exactly, not up to rounding: this is what makes hits independent of the tree.
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  const auto point = [&] { return Vec3(number(random), number(random), number(random)); };
  for (int i = 0; i < 200000; ++i) {
    const Vec3 p = point(), q = p + 1e-6f * point();
    const Aabb inner = triangle_bounds(p, q, p);
    const Aabb outer = united(inner, Aabb{p + 1e-6f * point(), p + 1e-6f * point()});
    Vec3 direction = point();
    if (i % 3 == 0) direction[i % 2] = i % 4 < 2 ? 0.0f : -0.0f;
    const Vec3 origin = i % 5 == 0 ? p - direction : 10.0f * point();
    const SlabRay ray = make_slab_ray(origin, direction, Vec3(max_abs(origin) * kPadding));
    const Interval of_inner = slab_interval(ray, inner, Interval{0.0f, kFloatMax});
    const Interval of_outer = slab_interval(ray, outer, Interval{0.0f, kFloatMax});
    ASSERT_LE(of_outer.begin, of_inner.begin);
    ASSERT_GE(of_outer.end, of_inner.end);
    if (i % 5 != 0) continue;
    ASSERT_FALSE(of_inner.is_empty()) << "the ray passes through a corner";
  }
}

}  // namespace
}  // namespace komorebi
