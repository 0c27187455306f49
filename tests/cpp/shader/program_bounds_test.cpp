// What programs give lies within what they give of ranges.
#include "shader/program_bounds.h"

#include <gtest/gtest.h>

#include <random>

#include "support/leaf_picture.h"
#include "support/materials.h"

namespace komorebi::testing {
namespace {

/// Every operation that bounds know, and an input and an operation that they do not.
std::shared_ptr<const Program> arithmetic(const std::shared_ptr<const Texture>& leaf) {
  MadeProgram made;
  const auto a = made.attribute("a"), b = made.attribute("b");
  const auto x = MadeProgram::Vec{a[0]}, y = MadeProgram::Vec{a[1]}, z = MadeProgram::Vec{b[3]};
  const auto named = [&](const std::string& name, std::uint32_t outputs,
                         const std::vector<MadeProgram::Vec>& operands,
                         const std::vector<float>& numbers = {}) {
    return made.op({name, {}, numbers, {}, "", nullptr}, outputs, operands);
  };
  const auto moved =
      named("transform", 3, {x, y, z}, {0.5f, -1, 0.25f, 3, 2, 0, -1, 0.5f, 1, 1, 1, -2});
  const auto texel = made.op({"image", {}, {1, 0, 0}, {}, "", leaf}, 4, {x, y, made.number(0)});
  const auto coarse = made.op({"image", {}, {1, 0, 0}, {}, "", leaf}, 4, {x, y, z});
  const auto alpha = MadeProgram::Vec{texel[3]};
  return made.program({named("add", 1, {x, y}),
                       named("subtract", 1, {x, z}),
                       named("multiply", 1, {x, y}),
                       named("multiply_add", 1, {x, y, z}),
                       named("mix", 1, {named("clamp01", 1, {x}), y, z}),
                       named("greater_than", 1, {x, y}),
                       named("less_than", 1, {x, y}),
                       named("round", 1, {named("multiply", 1, {x, made.number(7)})}),
                       moved,
                       named("subtract", 1, {made.number(1), alpha}),
                       texel,
                       // from here on nothing is known
                       named("sine", 1, {x}),
                       MadeProgram::Vec{coarse[3]},
                       made.input("ray_length", 1),
                       {made.attribute("dx:a")[0]}});
}

TEST(ProgramBounds, HoldWhatProgramsGive) {
  ThreadPool pool(1);
  const auto leaf = leaf_picture(64, 64, TexelType::kByte, 4, {}, pool);
  const auto program = arithmetic(leaf);
  TextureBoundsTable textures;
  const ProgramBounds bounds(*program, textures, pool);
  ASSERT_EQ(bounds.attributes(), (std::vector<std::string>{"a", "b"}));
  constexpr std::size_t kKnown = 16, kOutputs = 20;
  ASSERT_EQ(bounds.output_count(), kOutputs);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-2.0f, 2.0f), share(0.0f, 1.0f);
  Program::Scratch scratch;
  std::vector<FloatRange> values;
  for (int i = 0; i < 500; ++i) {
    FloatRange attributes[2][4];
    for (auto& attribute : attributes) {
      for (FloatRange& range : attribute) {
        const float low = place(random);
        range = {low, low + std::exp2(-10.0f * share(random))};
      }
    }
    FloatRange found[kOutputs];
    bounds.run(attributes, values, found);
    float columns[3][4][Program::kLanes], length[Program::kLanes], out[kOutputs][Program::kLanes];
    const float* pointers[3][4];
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t c = 0; c < 4; ++c) {
        const FloatRange& range = attributes[a % 2][c];
        for (std::uint32_t l = 0; l < Program::kLanes; ++l) {
          const float x = range.lo + share(random) * (range.hi - range.lo);
          columns[a][c][l] = l == 0 ? range.lo : l == 1 ? range.hi : std::min(x, range.hi);
          length[l] = 1.0f;
        }
        pointers[a][c] = columns[a][c];
      }
    }
    ShadePoints points;
    points.count = Program::kLanes;
    points.attribute = pointers;
    points.input[static_cast<std::size_t>(PointInput::kRayLength)][0] = length;
    float* rows[kOutputs];
    for (std::size_t o = 0; o < kOutputs; ++o) rows[o] = out[o];
    program->run(points, scratch, rows);
    for (std::size_t o = 0; o < kOutputs; ++o) {
      EXPECT_EQ(found[o].known(), o < kKnown) << o;
      for (const float value : out[o]) {
        EXPECT_LE(found[o].lo, value) << o;
        EXPECT_GE(found[o].hi, value) << o;
      }
    }
  }
}

TEST(ProgramBounds, KnowNothingAfterAnOverflow) {
  MadeProgram made;
  const auto a = made.attribute("a");
  const auto square = made.each("multiply", {a[0]}, {a[0]});
  const auto gone = made.each("subtract", square, square);
  const auto kept = made.op({"clamp01", {}, {}, {}, "", nullptr}, 1, {gone});
  TextureBoundsTable textures;
  ThreadPool pool(1);
  const ProgramBounds bounds(*made.program({square, gone, kept}), textures, pool);
  const FloatRange attributes[1][4] = {{{1e30f, 2e30f}, {}, {}, {}}};
  std::vector<FloatRange> values;
  FloatRange found[3];
  bounds.run(attributes, values, found);
  EXPECT_FALSE(found[0].known());
  EXPECT_FALSE(found[1].known());
  EXPECT_EQ(found[2].lo, 0.0f);
  EXPECT_EQ(found[2].hi, 1.0f);
}

}  // namespace
}  // namespace komorebi::testing
