#include "shader/op_bounds.h"

#include "core/functions.h"
#include "shader/op_sampling.h"
#include "texture/texture_bounds.h"

namespace komorebi {
namespace {

const FloatRange kShare(0.0f, 1.0f);

/// Of an operation that never falls where its one input rises, and gives numbers alone.
template <class F>
FloatRange rising(const FloatRange& x, F f) {
  return x.known() ? FloatRange(f(x.lo), f(x.hi)) : FloatRange();
}

float share(float x) {
  return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f;
}

/// Whether a > b: 0, 1 or either.
FloatRange above(const FloatRange& a, const FloatRange& b) {
  if (!a.known() || !b.known()) return kShare;
  return {a.lo > b.hi ? 1.0f : 0.0f, a.hi > b.lo ? 1.0f : 0.0f};
}

/// A row of a matrix times a vector, in the order in which the operation adds.
FloatRange row(const float* m, const FloatRange* v) {
  const auto term = [&](int i) { return FloatRange::of(m[i]) * v[i]; };
  return ((term(0) + term(1)) + term(2)) + FloatRange::of(m[3]);
}

struct Entry {
  std::string_view name;
  OpBounds* bounds;
};

constexpr Entry kEntries[] = {
    {"add", [](const BoundsCall& c) { c.out[0] = c.in[0] + c.in[1]; }},
    {"subtract", [](const BoundsCall& c) { c.out[0] = c.in[0] - c.in[1]; }},
    {"multiply", [](const BoundsCall& c) { c.out[0] = c.in[0] * c.in[1]; }},
    {"multiply_add", [](const BoundsCall& c) { c.out[0] = c.in[0] * c.in[1] + c.in[2]; }},
    {"mix",
     [](const BoundsCall& c) {
       const FloatRange rest = FloatRange::of(1.0f) - c.in[0];
       c.out[0] = c.in[1] * rest + c.in[2] * c.in[0];
     }},
    {"clamp01",
     [](const BoundsCall& c) {
       c.out[0] = c.in[0].known() ? FloatRange(share(c.in[0].lo), share(c.in[0].hi)) : kShare;
     }},
    {"greater_than", [](const BoundsCall& c) { c.out[0] = above(c.in[0], c.in[1]); }},
    {"less_than", [](const BoundsCall& c) { c.out[0] = above(c.in[1], c.in[0]); }},
    {"round",
     [](const BoundsCall& c) {
       c.out[0] = rising(c.in[0], [](float x) { return fn::floor(x + 0.5f); });
     }},
    {"transform",
     [](const BoundsCall& c) {
       for (int i = 0; i < 3; ++i) c.out[i] = row(c.numbers + 4 * i, c.in);
     }},
    // What lets rays through is read at a picture's finest level.
    {"image",
     [](const BoundsCall& c) {
       FloatRange found[4];
       if (c.in[2].lo == 0.0f && c.in[2].hi == 0.0f) {
         c.texture->lookup(sampling_of(c.numbers), c.in[0], c.in[1], found);
       }
       for (int i = 0; i < 4; ++i) c.out[i] = found[i];
     }},
};

}  // namespace

OpBounds* find_op_bounds(std::string_view name) {
  for (const Entry& entry : kEntries) {
    if (entry.name == name) return entry.bounds;
  }
  return nullptr;
}

}  // namespace komorebi
