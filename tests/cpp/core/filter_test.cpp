// Pixel filters against their formulas, written here a second time.
#include "render/filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/chi_square.h"
#include "support/direction_test.h"

namespace komorebi {
namespace {

struct Case {
  PixelFilter filter;
  float width;
  double radius;
};
const Case kCases[] = {
    {PixelFilter::kBlackmanHarris, 1.5f, 1.5},
    {PixelFilter::kBlackmanHarris, 0.01f, 0.01},
    {PixelFilter::kBlackmanHarris, 10.0f, 10.0},
    {PixelFilter::kGaussian, 1.5f, 2.25},
    {PixelFilter::kGaussian, 2.0f, 3.0},
    {PixelFilter::kBox, 1.5f, 0.5},
    {PixelFilter::kBox, 7.0f, 0.5},
};

double formula(const Case& c, double x) {
  if (std::abs(x) > c.radius) return 0.0;
  if (c.filter == PixelFilter::kBox) return 1.0;
  if (c.filter == PixelFilter::kGaussian) return std::exp(-8.0 * x * x / (c.width * c.width));
  const double a = 2.0 * kPi * (x / (2.0 * c.width) + 0.5);
  return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
}

double integral(const Case& c, double from, double to) {
  constexpr int kSteps = 400;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += formula(c, from + (to - from) * (i + 0.5) / kSteps);
  return sum * (to - from) / kSteps;
}

class Filters : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, Filters, ::testing::ValuesIn(kCases));

TEST_P(Filters, FollowsTheFormula) {
  const FilterTable table(GetParam().filter, GetParam().width);
  const FilterView view = table.view();
  EXPECT_NEAR(view.radius, GetParam().radius, 1e-6 * GetParam().radius);
  constexpr int kBins = 101, kSamples = 2000000;
  std::vector<std::uint64_t> observed(kBins, 0);
  testing::RandomBits random(21);
  for (int i = 0; i < kSamples / 2; ++i) {
    const Vec2 offset = sample_filter(view, random.next_2d());
    for (const float x : {offset.x, offset.y}) {
      const double position = (double{x} / double{view.radius} + 1.0) * 0.5 * kBins;
      ++observed[static_cast<std::size_t>(std::min(std::max(position, 0.0), kBins - 1.0))];
    }
  }
  const double r = GetParam().radius;
  double total = 0.0;
  for (int i = 0; i < kBins; ++i)
    total += integral(GetParam(), -r + 2 * r * i / kBins, -r + 2 * r * (i + 1) / kBins);
  std::vector<double> expected;
  for (int i = 0; i < kBins; ++i) {
    expected.push_back(kSamples / total *
                       integral(GetParam(), -r + 2 * r * i / kBins, -r + 2 * r * (i + 1) / kBins));
  }
  EXPECT_GT(testing::chi_square(observed, expected).p_value, testing::sidak(0.01, 7));
}

TEST_P(Filters, DensityMatchesAndIntegratesToOne) {
  const FilterTable table(GetParam().filter, GetParam().width);
  const FilterView view = table.view();
  const double r = GetParam().radius;
  const double norm = integral(GetParam(), -r, r), peak = formula(GetParam(), 0.0) / norm;
  constexpr int kSteps = 100000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = -r + 2 * r * (i + 0.5) / kSteps;
    const double pdf = filter_pdf(view, static_cast<float>(x));
    EXPECT_NEAR(pdf, formula(GetParam(), x) / norm, 2e-5 * peak) << x;
    sum += pdf * 2 * r / kSteps;
  }
  EXPECT_NEAR(sum, 1.0, 1e-5);
  EXPECT_EQ(filter_pdf(view, static_cast<float>(1.001 * r)), 0.0f);
}

TEST_P(Filters, IsMonotoneSymmetricAndInside) {
  const FilterTable table(GetParam().filter, GetParam().width);
  const FilterView view = table.view();
  float last = -view.radius;
  constexpr std::uint32_t kLast = (1u << 24) - 1;
  for (std::uint32_t k = 0; k <= kLast; k += k < 4096 || k > kLast - 8192 ? 1 : 513) {
    const float u = static_cast<float>(k) * 0x1p-24f;
    const float x = sample_filter(view, u);
    ASSERT_GE(x, last);
    ASSERT_LT(std::abs(x), view.radius);
    ASSERT_EQ(x, -sample_filter(view, static_cast<float>(kLast - k) * 0x1p-24f));
    last = x;
  }
}

TEST(Filter, VarianceIsThatOfTheWindow) {
  const Case& c = kCases[0];
  const FilterTable table(c.filter, c.width);
  double variance = 0.0, exact = 0.0, norm = 0.0;
  constexpr int kSteps = 1 << 20;
  for (int i = 0; i < kSteps; ++i) {
    const double x = sample_filter(table.view(), static_cast<float>((i + 0.5) / kSteps));
    variance += x * x / kSteps;
    const double y = -c.radius + 2 * c.radius * (i + 0.5) / kSteps;
    exact += y * y * formula(c, y), norm += formula(c, y);
  }
  EXPECT_NEAR(variance / (exact / norm), 1.0, 1e-4);
}

TEST(Filter, RefusesImpossibleWidths) {
  EXPECT_THROW(FilterTable(PixelFilter::kGaussian, 0.0f), std::invalid_argument);
  EXPECT_THROW(FilterTable(PixelFilter::kBlackmanHarris, -1.0f), std::invalid_argument);
  EXPECT_THROW(FilterTable(PixelFilter::kGaussian, std::nanf("")), std::invalid_argument);
  EXPECT_NO_THROW(FilterTable(PixelFilter::kBox, -1.0f));
}

}  // namespace
}  // namespace komorebi
