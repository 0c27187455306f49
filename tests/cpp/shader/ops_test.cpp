// All operations of programs, run over numbers of every kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "core/functions.h"
#include "shader/op_table.h"

namespace komorebi {
namespace {

constexpr std::uint32_t kCount = 64;

std::vector<const OpInfo*> ops() {
  std::vector<const OpInfo*> all;
  for (const auto& family : {arithmetic_ops(), math_ops(), vector_ops(), color_ops(), table_ops(),
                             spectrum_ops(), surface_ops(), texture_ops()}) {
    for (const OpInfo& op : family) all.push_back(&op);
  }
  return all;
}

// Runs an operation over rows that hold anything that a float can be.
struct OddRun {
  OddRun(const OpInfo& info, std::uint32_t seed, std::uint32_t rows) : op(info) {
    std::mt19937 random(seed);
    constexpr float kOdd[] = {0.0f,   -0.0f, 1.0f, -1.0f,  0.5f,          1e-42f,         1e38f,
                              -1e38f, 1e9f,  2.0f, 380.0f, fn::kInfinity, -fn::kInfinity, fn::kNaN};
    const auto number = [&] {
      switch (random() % 3) {
        case 0:
          return kOdd[random() % std::size(kOdd)];
        case 1:
          return std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        default:
          return static_cast<float>(random() % 4096) / 1024.0f - 2.0f;
      }
    };
    for (std::uint32_t k = 0; k < op.inputs; ++k) {
      inputs.emplace_back();
      for (std::uint32_t i = 0; i < kCount; ++i) inputs.back().push_back(number());
    }
    for (std::uint32_t k = 0; k < op.numbers; ++k) numbers.push_back(number());
    for (std::uint32_t k = 0; op.has_table && k < 4 * rows; ++k) table.push_back(number());
  }

  std::vector<std::uint32_t> bits(std::uint32_t first, std::uint32_t count) const {
    std::vector<std::vector<float>> rows(op.outputs, std::vector<float>(count));
    std::vector<const float*> in;
    std::vector<float*> out;
    for (const auto& row : inputs) in.push_back(row.data() + first);
    for (auto& row : rows) out.push_back(row.data());
    OpCall call;
    call.count = count;
    call.in = in.data();
    call.out = out.data();
    call.numbers = numbers.data();
    call.table = table;
    op.run(call);
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < count; ++i) {
      for (const auto& row : rows) {  // all NaN are one
        result.push_back(row[i] == row[i] ? std::bit_cast<std::uint32_t>(row[i]) : 0x7fc00000u);
      }
    }
    return result;
  }

  const OpInfo& op;
  std::vector<std::vector<float>> inputs;
  std::vector<float> numbers, table;
};

// Sanitizers see what is undefined here; without them the test says that a lane is worked out the
// same whatever stands beside it.
TEST(Ops, AnyNumberInAnyLane) {
  for (const OpInfo* op : ops()) {
    if (op->has_texture) continue;
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      const OddRun run(*op, seed, 1 + seed % 3);
      const auto together = run.bits(0, kCount);
      std::vector<std::uint32_t> apart;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        for (const std::uint32_t value : run.bits(i, 1)) apart.push_back(value);
      }
      EXPECT_EQ(together, apart) << op->name;
    }
  }
}

TEST(Ops, FootprintIsTheShorterHalfAxisOfAnEllipse) {
  const OpInfo& op = *find_op("footprint");
  std::mt19937 random(5);
  const auto number = [&] { return static_cast<float>(random() % 2001) / 1000.0f - 1.0f; };
  for (int k = 0; k < 200; ++k) {
    float values[9], width = 0.0f;
    for (float& v : values) v = number();
    if (k % 2 == 0) values[2] = values[5] = values[8] = 0.0f;  // in a picture's plane
    const float* in[9];
    for (int i = 0; i < 9; ++i) in[i] = &values[i];
    float* out[] = {&width};
    OpCall call;
    call.count = 1;
    call.in = in;
    call.out = out;
    op.run(call);
    double shortest = 1e9;
    for (int step = 0; step < 20000; ++step) {
      const double angle = 3.141592653589793 * step / 20000;
      double square = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double p = double{values[3 + c]} - double{values[c]};
        const double q = double{values[6 + c]} - double{values[c]};
        const double along = std::cos(angle) * p + std::sin(angle) * q;
        square += along * along;
      }
      shortest = std::min(shortest, std::sqrt(square));
    }
    EXPECT_NEAR(double{width}, shortest, 1e-3) << k;
  }
}

TEST(Ops, NamesAreTheirOwnAndFound) {
  for (const OpInfo* op : ops()) {
    EXPECT_EQ(find_op(op->name), op) << op->name;
    EXPECT_LE(op->inputs, kMostInputs);
    EXPECT_LE(op->outputs, kMostOutputs);
  }
  EXPECT_EQ(find_op("no such operation"), nullptr);
}

}  // namespace
}  // namespace komorebi
