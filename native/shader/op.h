#pragma once

#include <cstdint>
#include <span>

#include "shader/points.h"

namespace komorebi {

class Texture;

/// One operation over some points. Rows are columns of floats, a lane a point; those of `out` are
/// never those of `in`.
struct OpCall {
  std::uint32_t count = 0;  ///< lanes
  const float* const* in = nullptr;
  float* const* out = nullptr;
  const float* numbers = nullptr;  ///< OpInfo::numbers of them
  std::span<const float> table;    ///< of a curve or ramp
  const Texture* texture = nullptr;
  const ShadePoints* points = nullptr;
};

/// An operation that programs are made of. All of its rows are single floats; a vector is three of
/// them.
struct OpInfo {
  const char* name;
  void (*run)(const OpCall& call);
  std::uint32_t inputs, outputs;
  std::uint32_t numbers = 0;  ///< parameters that are the same at all points
  bool has_table = false, has_texture = false;
};

inline constexpr std::uint32_t kMostInputs = 32, kMostOutputs = 16;

/// Runs f(row values...) → float for every lane.
template <class F>
void map1(const OpCall& c, F f) {
  for (std::uint32_t i = 0; i < c.count; ++i) c.out[0][i] = f(c.in[0][i]);
}
template <class F>
void map2(const OpCall& c, F f) {
  for (std::uint32_t i = 0; i < c.count; ++i) c.out[0][i] = f(c.in[0][i], c.in[1][i]);
}
template <class F>
void map3(const OpCall& c, F f) {
  for (std::uint32_t i = 0; i < c.count; ++i) c.out[0][i] = f(c.in[0][i], c.in[1][i], c.in[2][i]);
}

}  // namespace komorebi
