// Each warp against its density: χ², integral 1, pdf · |det J| = 1.
#include "core/warp.h"

#include <gtest/gtest.h>

#include <random>

#include "support/direction_test.h"

namespace komorebi {
namespace {

struct Warp {
  const char* name;
  Vec3 (*sample)(const Vec2&);
  float (*pdf)(const Vec3&);
};

float sphere_pdf(const Vec3&) {
  return uniform_sphere_pdf();
}

const Warp kWarps[] = {
    {"uniform_hemisphere", uniform_hemisphere, uniform_hemisphere_pdf},
    {"cosine_hemisphere_polar", cosine_hemisphere_polar, cosine_hemisphere_pdf},
    {"cosine_hemisphere_disk", cosine_hemisphere_disk, cosine_hemisphere_pdf},
    {"uniform_sphere", uniform_sphere, sphere_pdf},
};

class Warps : public ::testing::TestWithParam<Warp> {};
INSTANTIATE_TEST_SUITE_P(All, Warps, ::testing::ValuesIn(kWarps),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(Warps, FollowsItsDensity) {
  const auto sample = [&](const Bits2& b) {
    return GetParam().sample(Vec2(to_unit_float(b.x), to_unit_float(b.y)));
  };
  const auto pdf = [&](const Vec3& d) { return double{GetParam().pdf(d)}; };
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto result = testing::test_directions({48, 32}, 1000000, seed, sample, pdf);
    EXPECT_GT(result.p_value, testing::sidak(0.01, 12)) << result.statistic;
  }
}

TEST_P(Warps, DensityIntegratesToOne) {
  double total = 0.0;
  const testing::SphereGrid grid{64, 64};
  for (const double cell : grid.integrate([&](const Vec3& d) { return GetParam().pdf(d); })) {
    total += cell;
  }
  EXPECT_NEAR(total, 1.0, 1e-6);
}

TEST_P(Warps, DensityTimesJacobianIsOne) {
  const auto map = [&](double u, double v) {
    return GetParam().sample(Vec2(static_cast<float>(u), static_cast<float>(v)));
  };
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      const double u = (i + 0.29) / 16.0, v = (j + 0.37) / 16.0;
      const bool kink = std::abs(u - v) < 0.02 || std::abs(u + v - 1.0) < 0.02;
      if (kink) continue;  // the disk map has its corners there
      const double pdf = GetParam().pdf(map(u, v));
      EXPECT_NEAR(pdf * testing::jacobian(map, u, v, 1.0 / 1024.0), 1.0, 1.5e-3) << u << ' ' << v;
    }
  }
}

TEST_P(Warps, UnitLengthAndDensityPositiveEverywhere) {
  const float edge[] = {0.0f, 1e-7f, 0.25f, 0.5f, 0.75f, kOneMinusEpsilon};
  for (const float u : edge) {
    for (const float v : edge) {
      const Vec3 d = GetParam().sample(Vec2(u, v));
      EXPECT_NEAR(glm::length(Vec3d(d)), 1.0, 3e-7) << u << ' ' << v;
    }
  }
  testing::RandomBits random(5);
  for (int i = 0; i < 100000; ++i) {
    const Vec3 d = GetParam().sample(random.next_2d());
    ASSERT_GT(GetParam().pdf(d), 0.0f);
    ASSERT_NEAR(glm::length(Vec3d(d)), 1.0, 3e-7);
  }
}

// The concentric map has no seam: squares about the middle become rings, corners stay diagonal.
TEST(CosineHemisphereDisk, IsConcentricAndContinuous) {
  const auto angle = [](const Vec3& d) { return std::atan2(d.y, d.x) / kPi; };
  EXPECT_NEAR(angle(cosine_hemisphere_disk({0.75f, 0.75f})), 0.25, 1e-6);
  EXPECT_NEAR(angle(cosine_hemisphere_disk({0.25f, 0.75f})), 0.75, 1e-6);
  EXPECT_NEAR(angle(cosine_hemisphere_disk({0.25f, 0.25f})), -0.75, 1e-6);
  EXPECT_NEAR(angle(cosine_hemisphere_disk({0.5f, 0.75f})), 0.5, 1e-6);
  EXPECT_EQ(cosine_hemisphere_disk({0.5f, 0.5f}), Vec3(0, 0, 1));
  constexpr float kStep = 1.0f / 1024.0f;
  for (float u = 0.05f; u < 0.95f; u += kStep) {
    for (float v = 0.05f; v < 0.95f; v += kStep) {
      const Vec3 here = cosine_hemisphere_disk({u, v});
      ASSERT_LT(glm::length(cosine_hemisphere_disk({u + kStep, v}) - here), 8.0f * kStep);
      ASSERT_LT(glm::length(cosine_hemisphere_disk({u, v + kStep}) - here), 8.0f * kStep);
    }
  }
}

TEST(Frame, IsOrthonormalAndRightHandedForEveryNormal) {
  testing::RandomBits random(7);
  std::vector<Vec3> normals = {{0, 0, 1},      {0, 0, -1},    {1, 0, 0},       {0, 1, 0},
                               {0, 0, -0.0f},  {0, -1, 0},    {1e-4f, 0, -1},  {1e-20f, 0, -1},
                               {0, 1e-4f, -1}, {1e-4f, 0, 1}, {1, 0, -1e-30f}, {-1, 0, 0}};
  normals[4] = Vec3(-1.0f, 0.0f, -0.0f);
  for (int i = 0; i < 100000; ++i) normals.push_back(uniform_sphere(random.next_2d()));
  for (Vec3 n : normals) {
    n = Vec3(glm::normalize(Vec3d(n)));
    const Frame f = make_frame(n);
    const Vec3d t(f.tangent), b(f.bitangent), m(n);
    ASSERT_NEAR(glm::length(t), 1.0, 1e-6);
    ASSERT_NEAR(glm::length(b), 1.0, 1e-6);
    ASSERT_NEAR(glm::dot(t, b), 0.0, 1e-6);
    ASSERT_NEAR(glm::dot(t, m), 0.0, 1e-6);
    ASSERT_NEAR(glm::dot(b, m), 0.0, 1e-6);
    ASSERT_NEAR(glm::dot(glm::cross(t, b), m), 1.0, 1e-6);
    ASSERT_NEAR(
        glm::length(Vec3d(f.to_local(f.to_world(Vec3(0.1f, 0.2f, 0.3f))) - Vec3(0.1f, 0.2f, 0.3f))),
        0.0, 1e-6);
  }
}

TEST(SampleLinear, InvertsItsDistribution) {
  for (const float a : {0.0f, 1e-30f, 0.3f, 1.0f, 1e30f}) {
    for (const float b : {0.0f, 1e-30f, 0.5f, 1.0f, 3e38f}) {
      float last = 0.0f;
      for (int i = 0; i < 1000; ++i) {
        const float u = static_cast<float>(i) / 1000.0f;
        const double x = sample_linear(u, a, b);
        ASSERT_GE(x, last);
        ASSERT_LT(x, 1.0);
        last = static_cast<float>(x);
        const double sum = double{a} + double{b};
        if (sum == 0.0) {
          ASSERT_EQ(last, u);
        } else {
          const double cdf = (double{a} * x + (double{b} - double{a}) * x * x / 2) / (sum / 2);
          ASSERT_NEAR(cdf, u, 1e-6) << a << ' ' << b;
        }
      }
    }
  }
}

}  // namespace
}  // namespace komorebi
