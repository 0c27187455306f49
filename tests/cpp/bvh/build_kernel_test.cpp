// The builders' inner loops in lanes against their scalar specification.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <random>

#include "bvh/quantise.h"
#include "bvh/traverse.h"
#include "bvh/treelet.h"

namespace komorebi {
namespace {

TEST(BuildKernel, QuantisesAsTheScalarFunctionDoes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  for (const std::string& set : built_instruction_sets()) {
    force_instruction_set(set);
    const BuildKernel& kernel = build_kernel();
    for (int round = 0; round < 20000; ++round) {
      const int count = 1 + round % kWidth;
      const float scale = std::ldexp(1.0f, round % 200 - 100);
      const float offset = round % 3 == 0 ? 0.0f : 100.0f * number(random);
      Aabb boxes[kWidth];
      BinaryNode nodes[kWidth];
      std::uint32_t children[kWidth];
      std::iota(children, children + kWidth, 0u);
      for (int i = 0; i < count; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          const float a = scale * (offset + number(random)), b = scale * (offset + number(random));
          boxes[i].lo[axis] = min_of(a, b);
          boxes[i].hi[axis] = round % 7 == axis ? min_of(a, b) : max_of(a, b);
        }
        nodes[i].set_box(boxes[i]);
        nodes[i].first = ~0u;  // not-a-number, if it were taken for a coordinate
        nodes[i].info = ~0u;
      }
      WideNode expected{}, found{};
      quantise(boxes, count, expected);
      kernel.quantise(nodes, children, count, found);
      ASSERT_EQ(std::memcmp(&expected, &found, sizeof expected), 0) << set << ", round " << round;
    }
  }
  force_instruction_set("");
}

}  // namespace
}  // namespace komorebi
