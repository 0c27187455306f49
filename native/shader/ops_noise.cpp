#include "shader/fractal_noise.h"
#include "shader/hash.h"
#include "shader/op_numbers.h"
#include "shader/op_table.h"
#include "shader/program.h"

namespace komorebi {
namespace {

/// Noise has no seed, so a second one is the first from elsewhere: 100 to 200 cells away.
float seed_shift(std::uint32_t dimensions, std::uint32_t seed, std::uint32_t axis) {
  const auto s = static_cast<float>(seed);
  const float hash = dimensions == 1 ? hash_floats(s) : hash_floats(s, static_cast<float>(axis));
  return 100.0f + hash * 100.0f;
}

// in: up to 4 coordinates, detail, roughness, lacunarity, offset, gain
// numbers: dimensions, FractalType, normalize, counts_first, NoiseRepeat, channel of the colour
void noise(const OpCall& c) {
  FractalKind kind;
  kind.dimensions = dimension_count(c.numbers[0]);
  kind.type = static_cast<FractalType>(choice(c.numbers[1], 4));
  kind.normalize = c.numbers[2] != 0.0f;
  kind.counts_first = c.numbers[3] != 0.0f;
  kind.repeat = static_cast<NoiseRepeat>(choice(c.numbers[4], 1));
  const std::uint32_t channel = choice(c.numbers[5], 2);
  float moved[4][Program::kLanes];
  FractalRows rows{
      {c.in[0], c.in[1], c.in[2], c.in[3]}, c.in[4], c.in[5], c.in[6], c.in[7], c.in[8]};
  for (std::uint32_t d = 0; channel > 0 && d < kind.dimensions; ++d) {
    // The distortion has the seeds before that.
    const float shift = seed_shift(kind.dimensions, kind.dimensions + channel - 1, d);
    for (std::uint32_t i = 0; i < c.count; ++i) moved[d][i] = c.in[d][i] + shift;
    rows.p[d] = moved[d];
  }
  fractal_noise(kind, rows, c.count, c.out[0]);
}

// in: up to 4 coordinates, distortion; out: the coordinates, moved
// numbers: dimensions, NoiseRepeat
void noise_distort(const OpCall& c) {
  const std::uint32_t dimensions = dimension_count(c.numbers[0]);
  const auto repeat = static_cast<NoiseRepeat>(choice(c.numbers[1], 1));
  float moved[4][Program::kLanes];
  const float* const columns[4] = {moved[0], moved[1], moved[2], moved[3]};
  for (std::uint32_t axis = 0; axis < 4; ++axis) {
    float* const out = c.out[axis];
    if (axis >= dimensions) {
      for (std::uint32_t i = 0; i < c.count; ++i) out[i] = c.in[axis][i];
      continue;
    }
    for (std::uint32_t d = 0; d < dimensions; ++d) {
      const float shift = seed_shift(dimensions, axis, d);
      for (std::uint32_t i = 0; i < c.count; ++i) moved[d][i] = c.in[d][i] + shift;
    }
    perlin_rows(dimensions, columns, c.count, repeat, out);
    for (std::uint32_t i = 0; i < c.count; ++i) out[i] = c.in[axis][i] + out[i] * c.in[4][i];
  }
}

// in: up to 4 coordinates; out: a colour, of which red is the value
// numbers: dimensions
void white_noise(const OpCall& c) {
  const float *x = c.in[0], *y = c.in[1], *z = c.in[2], *w = c.in[3];
  const std::uint32_t dimensions = dimension_count(c.numbers[0]);
  for (std::uint32_t i = 0; i < c.count; ++i) {
    switch (dimensions) {
      case 1:
        c.out[0][i] = hash_floats(x[i]);
        c.out[1][i] = hash_floats(x[i], 1.0f);
        c.out[2][i] = hash_floats(x[i], 2.0f);
        break;
      case 2:
        c.out[0][i] = hash_floats(x[i], y[i]);
        c.out[1][i] = hash_floats(x[i], y[i], 1.0f);
        c.out[2][i] = hash_floats(x[i], y[i], 2.0f);
        break;
      case 3:
        c.out[0][i] = hash_floats(x[i], y[i], z[i]);
        c.out[1][i] = hash_floats(x[i], y[i], z[i], 1.0f);
        c.out[2][i] = hash_floats(x[i], y[i], z[i], 2.0f);
        break;
      default:
        c.out[0][i] = hash_floats(x[i], y[i], z[i], w[i]);
        c.out[1][i] = hash_floats(z[i], x[i], w[i], y[i]);
        c.out[2][i] = hash_floats(w[i], z[i], y[i], x[i]);
        break;
    }
  }
}

constexpr OpInfo kOps[] = {
    {"noise", &noise, 9, 1, 6},
    {"noise_distort", &noise_distort, 5, 4, 2},
    {"white_noise", &white_noise, 4, 3, 1},
};

}  // namespace

std::span<const OpInfo> noise_ops() {
  return kOps;
}

}  // namespace komorebi
