#pragma once

#include "core/vector.h"
#include "shader/op.h"

namespace komorebi {

/// The vector that begins at row `first` of the inputs.
inline Vec3 input_vector(const OpCall& c, std::uint32_t first, std::uint32_t lane) {
  return Vec3(c.in[first][lane], c.in[first + 1][lane], c.in[first + 2][lane]);
}

/// Runs f(lane) → Vec3 for every lane.
template <class F>
void to_vector(const OpCall& c, F f) {
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const Vec3 v = f(i);
    for (int k = 0; k < 3; ++k) c.out[k][i] = v[k];
  }
}

/// Runs f(lane) → float for every lane.
template <class F>
void to_number(const OpCall& c, F f) {
  for (std::uint32_t i = 0; i < c.count; ++i) c.out[0][i] = f(i);
}

/// Operations that are a function of numbers.
template <float (*f)(float)>
void run1(const OpCall& c) {
  map1(c, f);
}
template <float (*f)(float, float)>
void run2(const OpCall& c) {
  map2(c, f);
}
template <float (*f)(float, float, float)>
void run3(const OpCall& c) {
  map3(c, f);
}

}  // namespace komorebi
