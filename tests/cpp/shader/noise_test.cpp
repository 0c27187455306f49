#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bvh/traverse.h"
#include "shader/fractal_noise.h"
#include "shader/hash.h"
#include "shader/perlin.h"
#include "shader/program.h"

namespace komorebi {
namespace {

constexpr std::uint32_t kLanes = Program::kLanes;
using Row = float[kLanes];

struct Rows {
  Row p[4], detail, roughness, lacunarity, offset, gain;

  Rows() {
    for (std::uint32_t i = 0; i < kLanes; ++i) {
      const auto x = static_cast<float>(i);
      for (std::uint32_t d = 0; d < 4; ++d)
        p[d][i] = 0.37f * x - 9.1f + 1.7f * static_cast<float>(d);
      detail[i] = 0.11f * x;
      roughness[i] = 0.4f + 0.01f * x;
      lacunarity[i] = 1.9f + 0.01f * x;
      offset[i] = 0.7f;
      gain[i] = 1.3f;
    }
  }
  FractalRows from(std::uint32_t i) const {
    return {{p[0] + i, p[1] + i, p[2] + i, p[3] + i},
            detail + i,
            roughness + i,
            lacunarity + i,
            offset + i,
            gain + i};
  }
};

TEST(Noise, HashedFloatsFillTheUnitInterval) {
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const float h = hash_floats(static_cast<float>(i), 0.5f, -3.0f);
    ASSERT_GE(h, 0.0f);
    ASSERT_LE(h, 1.0f);
    sum += h;
    squares += double{h} * h;
  }
  EXPECT_NEAR(sum / 10000.0, 1.0 / 2.0, 0.012);
  EXPECT_NEAR(squares / 10000.0, 1.0 / 3.0, 0.012);
}

TEST(Noise, WordsBecomeTheNearestFloat) {
  for (const std::uint32_t bits : {0u, 1u, 0xffffffffu, 0x80000040u, 0x7fffffffu, 0xdeadbeefu}) {
    EXPECT_EQ(unit_float(bits), static_cast<float>(bits) * (1.0f / 4294967295.0f));
  }
}

TEST(Noise, PerlinIsZeroOnWholeNumbersAndContinuous) {
  for (int i = -5; i < 5; ++i) {
    const auto x = static_cast<float>(i);
    EXPECT_EQ(perlin<1>({x}), 0.0f);
    EXPECT_EQ(perlin<2>({x, x + 3.0f}), 0.0f);
    EXPECT_EQ(perlin<3>({x, 2.0f, -x}), 0.0f);
    EXPECT_EQ(perlin<4>({x, 7.0f, x, 1.0f}), 0.0f);
    const float below = perlin<3>({x - 1e-4f, 0.4f, 0.7f}),
                above = perlin<3>({x + 1e-4f, 0.4f, 0.7f});
    EXPECT_NEAR(below, above, 1e-3f);
  }
}

TEST(Noise, EachLaneIsTheSameByItself) {
  const Rows rows;
  for (std::uint32_t dimensions = 1; dimensions <= 4; ++dimensions) {
    for (std::uint32_t type = 0; type < 5; ++type) {
      for (const bool counts_first : {false, true}) {
        const FractalKind kind{dimensions, static_cast<FractalType>(type), !counts_first,
                               counts_first};
        Row all, one;
        fractal_noise(kind, rows.from(0), kLanes, all);
        for (std::uint32_t i = 0; i < kLanes; ++i) {
          fractal_noise(kind, rows.from(i), 1, one);
          ASSERT_EQ(all[i], one[0]) << dimensions << " " << type << " " << i;
        }
      }
    }
  }
}

TEST(Noise, EachInstructionSetGivesTheSame) {
  const Rows rows;
  for (std::uint32_t dimensions = 1; dimensions <= 4; ++dimensions) {
    const FractalKind kind{dimensions, FractalType::kFbm, true};
    Row plain, out;
    force_instruction_set("SCALAR");
    fractal_noise(kind, rows.from(0), kLanes, plain);
    for (const std::string& name : built_instruction_sets()) {
      force_instruction_set(name);
      fractal_noise(kind, rows.from(0), kLanes, out);
      for (std::uint32_t i = 0; i < kLanes; ++i) EXPECT_EQ(out[i], plain[i]) << name;
    }
    force_instruction_set("");
  }
}

TEST(Noise, RepeatsFarFromTheOrigin) {
  const float near[] = {12345.25f}, far[] = {112345.25f}, farther[] = {2012345.25f};
  const float* const at_near[] = {near};
  const float* const at_far[] = {far};
  const float* const at_farther[] = {farther};
  float a, b, c;
  perlin_rows(1, at_near, 1, NoiseRepeat::kEvery100000, &a);
  perlin_rows(1, at_far, 1, NoiseRepeat::kEvery100000, &b);
  EXPECT_EQ(a, b);
  perlin_rows(1, at_far, 1, NoiseRepeat::kNever, &b);
  EXPECT_NE(a, b);
  perlin_rows(1, at_farther, 1, NoiseRepeat::kEvery100000, &c);
  EXPECT_EQ(c, perlin<1>({12345.25f + 0.5f}));
}

TEST(Noise, BadCoordinatesGiveNumbers) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kInf, -kInf, std::numeric_limits<float>::quiet_NaN(), 3e38f, -1e20f}) {
    EXPECT_EQ(perlin<3>({bad, bad, bad}), 0.0f);
  }
}

}  // namespace
}  // namespace komorebi
