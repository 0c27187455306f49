#include "core/math.h"
#include "shader/op_table.h"

namespace komorebi {
namespace {

constexpr OpInfo kOps[] = {
    {"add", [](const OpCall& c) { map2(c, [](float a, float b) { return a + b; }); }, 2, 1},
    {"subtract", [](const OpCall& c) { map2(c, [](float a, float b) { return a - b; }); }, 2, 1},
    {"multiply", [](const OpCall& c) { map2(c, [](float a, float b) { return a * b; }); }, 2, 1},
    // As Cycles has it: nothing is divided by 0.
    {"divide",
     [](const OpCall& c) { map2(c, [](float a, float b) { return b != 0.0f ? a / b : 0.0f; }); }, 2,
     1},
    // in: factor, a, b
    {"mix",
     [](const OpCall& c) {
       map3(c, [](float f, float a, float b) { return a * (1.0f - f) + b * f; });
     },
     3, 1},
    {"clamp01",
     [](const OpCall& c) {
       map1(c, [](float x) { return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f; });
     },
     1, 1},
};

}  // namespace

std::span<const OpInfo> arithmetic_ops() {
  return kOps;
}

}  // namespace komorebi
