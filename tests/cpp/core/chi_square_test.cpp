// The test of the tests: does the χ² test accept what is right and reject what is slightly wrong?
#include "support/chi_square.h"

#include <gtest/gtest.h>

#include "support/direction_test.h"

namespace komorebi::testing {
namespace {

TEST(ChiSquare, GivesTabulatedProbabilities) {
  // upper 5 % and 0.1 % points of the χ² distribution with 1, 10 and 100 degrees (any table)
  EXPECT_NEAR(boost::math::gamma_q(0.5, 0.5 * 3.841458820694124), 0.05, 1e-12);
  EXPECT_NEAR(boost::math::gamma_q(5.0, 0.5 * 18.307038053275146), 0.05, 1e-12);
  EXPECT_NEAR(boost::math::gamma_q(50.0, 0.5 * 149.44925277903886), 0.001, 1e-12);
}

TEST(ChiSquare, WorkedExample) {
  // A die thrown 60 times: 5, 8, 9, 8, 10, 20. χ² = 13.4 with 5 degrees, p = 0.0199.
  const ChiSquare result = chi_square({5, 8, 9, 8, 10, 20}, std::vector<double>(6, 10.0));
  EXPECT_NEAR(result.statistic, 13.4, 1e-12);
  EXPECT_EQ(result.degrees, 5);
  EXPECT_NEAR(result.p_value, 0.0199, 1e-4);
}

TEST(ChiSquare, PoolsSmallCells) {
  const ChiSquare result = chi_square({1, 2, 3, 10, 20}, {2.0, 2.0, 2.0, 10.0, 20.0});
  EXPECT_EQ(result.degrees, 2);
  EXPECT_EQ(result.statistic, 0.0);
}

TEST(ChiSquare, RejectsTheImpossible) {
  EXPECT_EQ(chi_square({1, 50, 50}, {0.0, 50.0, 50.0}).p_value, 0.0);
}

TEST(ChiSquare, SidakKeepsTheFamilyWiseError) {
  const double each = sidak(0.01, 20);
  EXPECT_NEAR(1.0 - std::pow(1.0 - each, 20.0), 0.01, 1e-12);
}

class SlightlyWrongDensity : public ::testing::Test {
 protected:
  double p_value(const std::function<double(const Vec3&)>& pdf) const {
    return test_directions({16, 16}, 4000000, 11, sample, pdf).p_value;
  }
  static Vec3 sample(const Bits2& bits) {
    return cosine_hemisphere_polar(Vec2(to_unit_float(bits.x), to_unit_float(bits.y)));
  }
  static double cosine(const Vec3& d) { return cosine_hemisphere_pdf(d); }
};

TEST_F(SlightlyWrongDensity, RightOnePasses) {
  EXPECT_GT(p_value(cosine), 0.01);
}

TEST_F(SlightlyWrongDensity, TwoPercentTooLargeFails) {
  EXPECT_LT(p_value([](const Vec3& d) { return 1.02 * cosine(d); }), 1e-6);
}

TEST_F(SlightlyWrongDensity, TwoPercentTiltedFails) {
  EXPECT_LT(p_value([](const Vec3& d) { return cosine(d) * (1.0 + 0.02 * d.x); }), 1e-6);
}

TEST_F(SlightlyWrongDensity, ExponentTwoPercentOffFails) {
  EXPECT_LT(p_value([](const Vec3& d) {
              return d.z > 0.0f ? std::pow(double{d.z}, 1.02) * (2.02 / (2.0 * kPi)) : 0.0;
            }),
            1e-6);
}

}  // namespace
}  // namespace komorebi::testing
