// Owen-scrambled Sobol' points: structure, independence and convergence.
#include "core/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "core/math.h"
#include "support/chi_square.h"
#include "support/convergence.h"

namespace komorebi {
namespace {

// Sobol's second dimension by its definition: v[0] = 1/2, v[k+1] = v[k] XOR v[k]/2.
std::uint32_t sobol_1_by_definition(std::uint32_t index) {
  std::uint32_t result = 0, direction = 1u << 31;
  for (; index != 0; index >>= 1, direction ^= direction >> 1) {
    if (index & 1u) result ^= direction;
  }
  return result;
}

TEST(Sobol, MatchesItsDefinition) {
  for (std::uint32_t i = 0; i < 1u << 16; ++i) {
    ASSERT_EQ(reverse_bits(sobol_1_reversed(i)), sobol_1_by_definition(i));
  }
  for (std::uint32_t i = 1; i != 0; i <<= 1) {
    ASSERT_EQ(reverse_bits(sobol_1_reversed(i - 1)), sobol_1_by_definition(i - 1));
    ASSERT_EQ(reverse_bits(sobol_1_reversed(~i)), sobol_1_by_definition(~i));
  }
}

TEST(Sobol, ReversesBits) {
  for (int bit = 0; bit < 32; ++bit) EXPECT_EQ(reverse_bits(1u << bit), 1u << (31 - bit));
}

// Is there one point in each box 2^-i × 2^-(k−i), for every i?
bool is_net(const std::vector<Bits2>& points, unsigned k) {
  for (unsigned i = 0; i <= k; ++i) {
    std::vector<bool> taken(points.size(), false);
    for (const Bits2& p : points) {
      const std::uint32_t x = i == 0 ? 0 : p.x >> (32 - i);
      const std::uint32_t y = i == k ? 0 : p.y >> (32 - (k - i));
      const std::uint32_t box = (x << (k - i)) | y;
      if (taken[box]) return false;
      taken[box] = true;
    }
  }
  return true;
}

TEST(Sampler, EveryAlignedRunIsANet) {
  for (std::uint32_t pixel = 0; pixel < 8; ++pixel) {
    const Sampler sampler(3, pixel, 7 * pixel);
    for (std::uint32_t dimension : {0u, 2u, 8u, 24u}) {
      for (unsigned k = 0; k <= 12; ++k) {
        for (std::uint32_t run : {0u, 1u, 5u}) {
          std::vector<Bits2> points;
          for (std::uint32_t i = 0; i < 1u << k; ++i) {
            points.push_back(sampler.bits_2d(dimension, (run << k) + i));
          }
          ASSERT_TRUE(is_net(points, k)) << "pixel " << pixel << ", run " << run << " of 2^" << k;
        }
      }
    }
  }
}

TEST(Sampler, TheNetTestCanFail) {
  std::vector<Bits2> points;
  for (std::uint32_t i = 0; i < 64; ++i) points.push_back(Sampler(0, 0, 0).bits_2d(0, i));
  points[17].x ^= 1u << 26;
  EXPECT_FALSE(is_net(points, 6));
}

TEST(Sampler, OneDimensionIsStratified) {
  const Sampler sampler(0, 12, 34);
  for (unsigned k = 1; k <= 14; ++k) {
    std::set<std::uint32_t> strata;
    for (std::uint32_t i = 0; i < 1u << k; ++i) {
      strata.insert(sampler.bits_1d(kDimensionTime, i) >> (32 - k));
    }
    EXPECT_EQ(strata.size(), std::size_t{1} << k);
  }
}

TEST(Sampler, FloatsStayBelowOne) {
  EXPECT_LT(to_unit_float(0xffffffffu), 1.0f);
  EXPECT_EQ(to_unit_float(0xffffffffu), 1.0f - 0x1p-24f);
  EXPECT_EQ(to_unit_float(0u), 0.0f);
}

TEST(Sampler, IsAPureFunction) {
  const Sampler a(9, 100, 200), b(9, 100, 200);
  std::vector<float> forward, backward;
  for (std::uint32_t i = 0; i < 256; ++i) forward.push_back(a.sample_2d(8, i).y);
  for (std::uint32_t i = 256; i-- > 0;) backward.push_back(b.sample_2d(8, i).y);
  for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(forward[i], backward[255 - i]);
}

TEST(Sampler, DimensionTableIsFixed) {
  EXPECT_EQ(vertex_dimension(0, kVertexLightDirection), 8u);
  EXPECT_EQ(vertex_dimension(0, kVertexAmbient), 14u);
  EXPECT_EQ(vertex_dimension(0, kVertexLobe), 16u);
  EXPECT_EQ(vertex_dimension(0, kVertexLamp), 18u);
  EXPECT_EQ(vertex_dimension(2, kVertexScatter), 44u);
}

// Known values: a change of the hash or of the order of operations changes every picture.
TEST(Sampler, KeepsItsValues) {
  const Sampler sampler(1, 2, 3);
  EXPECT_EQ(sampler.bits_2d(0, 0).x, 0x3ca35fc4u);
  EXPECT_EQ(sampler.bits_2d(0, 0).y, 0x32a41cd3u);
  EXPECT_EQ(sampler.bits_1d(4, 77), 0xff03cdb7u);
}

// Correlation of two streams of 1/2-centred values, times √n: normal with variance 1 if
// independent.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - 0.5) * (b[i] - 0.5);
  return sum * 12.0 / std::sqrt(static_cast<double>(a.size()));
}

// The same sample of neighbouring pixels, seeds and dimensions must look independent.
TEST(Sampler, PixelsSeedsAndDimensionsAreDecorrelated) {
  constexpr std::uint32_t kSide = 256;
  struct Offset {
    std::uint32_t seed, x, y, dimension, index;
  };
  const Offset offsets[] = {{0, 1, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 1, 1, 0, 0},  {0, 0, 64, 0, 0},
                            {1, 0, 0, 0, 0}, {2, 1, 0, 0, 0}, {0, 0, 0, 2, 0},  {0, 0, 0, 8, 0},
                            {0, 1, 0, 8, 0}, {0, 0, 1, 2, 1}, {1, 1, 1, 16, 0}, {0, 0, 0, 4, 3}};
  for (const std::uint32_t index : {0u, 1u, 2u, 5u, 1000u}) {
    for (const Offset& o : offsets) {
      std::vector<double> x0, y0, x1, y1;
      for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
          const Vec2 a = Sampler(5, x, y).sample_2d(8, index);
          const Vec2 b =
              Sampler(5 + o.seed, x + o.x, y + o.y).sample_2d(8 + o.dimension, index + o.index);
          x0.push_back(double{a.x}), y0.push_back(double{a.y});
          x1.push_back(double{b.x}), y1.push_back(double{b.y});
        }
      }
      // 5 × 12 × 4 tests: 4.6 standard deviations are met by chance once in a thousand runs
      EXPECT_LT(std::abs(correlation(x0, x1)), 4.6);
      EXPECT_LT(std::abs(correlation(x0, y1)), 4.6);
      EXPECT_LT(std::abs(correlation(y0, x1)), 4.6);
      EXPECT_LT(std::abs(correlation(y0, y1)), 4.6);
    }
  }
}

// Within a pixel, points of different pairs combine at random: of 4096 samples each cell of a 16 ×
// 16 grid over one coordinate of each has about 16 (standard deviation 4; the counts depend on each
// other, so this is no χ² test). Unshuffled, a sixteenth of the cells would have 256, the rest
// none.
TEST(Sampler, PairsOfOnePixelAreDecorrelated) {
  for (std::uint32_t pixel = 0; pixel < 16; ++pixel) {
    const Sampler sampler(0, pixel, 3);
    for (const std::uint32_t other : {2u, 4u, 8u, 16u}) {
      std::vector<int> counts(256, 0);
      for (std::uint32_t i = 0; i < 4096; ++i) {
        const std::uint32_t a = sampler.bits_2d(0, i).x, b = sampler.bits_2d(other, i).x;
        ++counts[(a >> 28) * 16 + (b >> 28)];
      }
      for (const int count : counts) {
        ASSERT_GT(count, 0);
        ASSERT_LT(count, 40);
      }
    }
  }
}

// Over pixels, each sample by itself is uniform in the square.
TEST(Sampler, EachSampleIsUniformOverPixels) {
  constexpr std::uint32_t kSide = 512, kCells = 32;
  const std::uint32_t indices[] = {0, 1, 2, 3, 100, 0x80000000u, 0xffffffffu};
  for (const std::uint32_t index : indices) {
    std::vector<std::uint64_t> observed(kCells * kCells, 0);
    for (std::uint32_t y = 0; y < kSide; ++y) {
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const Bits2 b = Sampler(0, x, y).bits_2d(0, index);
        ++observed[(b.x >> 27) * kCells + (b.y >> 27)];
      }
    }
    const std::vector<double> expected(observed.size(),
                                       double{kSide} * kSide / (double{kCells} * kCells));
    EXPECT_GT(testing::chi_square(observed, expected).p_value, testing::sidak(0.01, 7)) << index;
  }
}

double smooth(const Vec2& u) {
  return std::exp(double{u.x}) * std::cos(double{u.y});
}
double disk(const Vec2& u) {
  return u.x * u.x + u.y * u.y < 0.5f ? 1.0 : 0.0;
}
double corner(const Vec2& u) {
  return u.x + u.y < 0.7f ? 1.0 : 0.0;
}

double slope(double (*f)(const Vec2&), double exact) {
  return testing::convergence_slope(4, 12, 256, [&](std::uint32_t pixel, std::uint32_t count) {
    const Sampler sampler(0, pixel, pixel / 16);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) sum += f(sampler.sample_2d(8, i));
    return sum / count - exact;
  });
}

// Owen (1997): n^-3/2 for smooth integrands; n^-3/4 for a set bounded by a smooth curve.
TEST(Sampler, ConvergesAsTheorySays) {
  EXPECT_NEAR(slope(smooth, (std::exp(1.0) - 1.0) * std::sin(1.0)), -1.5, 0.1);
  EXPECT_NEAR(slope(disk, kPi / 8.0), -0.75, 0.1);
  EXPECT_NEAR(slope(corner, 0.5 * 0.7 * 0.7), -0.75, 0.1);
}

// Light ray j of n of sample i has index i·n + j: n rays are as well spread as n times the samples.
TEST(Sampler, SubsequencesAreStratifiedToo) {
  const Sampler sampler(0, 3, 4);
  for (std::uint32_t i = 0; i < 16; ++i) {
    std::vector<Bits2> rays;
    for (std::uint32_t j = 0; j < 16; ++j) rays.push_back(sampler.bits_2d(8, i * 16 + j));
    EXPECT_TRUE(is_net(rays, 4));
  }
}

}  // namespace
}  // namespace komorebi
