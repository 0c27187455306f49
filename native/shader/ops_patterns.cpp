#include "shader/gabor.h"
#include "shader/op_numbers.h"
#include "shader/op_table.h"
#include "shader/patterns.h"

namespace komorebi {
namespace {

// in: angle; numbers: WaveProfile
void wave_profile(const OpCall& c) {
  const auto profile = static_cast<WaveProfile>(choice(c.numbers[0], 2));
  map1(c, [profile](float angle) { return wave(profile, angle); });
}

// in: place, scale, distortion; out: colour; numbers: depth
void magic_color(const OpCall& c) {
  const std::uint32_t depth = choice(c.numbers[0], 10);
  for (std::uint32_t i = 0; i < c.count; ++i) {
    float color[3];
    magic({c.in[0][i], c.in[1][i], c.in[2][i]}, c.in[3][i], c.in[4][i], depth, color);
    for (int k = 0; k < 3; ++k) c.out[k][i] = color[k];
  }
}

// in: place; numbers: GradientType
void gradient_value(const OpCall& c) {
  const auto type = static_cast<GradientType>(choice(c.numbers[0], 6));
  map3(c, [type](float x, float y, float z) { return gradient_texture(type, x, y, z); });
}

// in: x, y, mortar size, mortar smooth, bias, brick width, row height; out: tint, mortar
// numbers: offset, its frequency, squash, its frequency
void brick_parts(const OpCall& c) {
  BrickKind kind;
  kind.offset = c.numbers[0];
  kind.offset_frequency = static_cast<std::int32_t>(choice(c.numbers[1], 99));
  kind.squash = c.numbers[2];
  kind.squash_frequency = static_cast<std::int32_t>(choice(c.numbers[3], 99));
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const BrickSize size{c.in[2][i], c.in[3][i], c.in[4][i], c.in[5][i], c.in[6][i]};
    const Brick found = brick(kind, size, c.in[0][i], c.in[1][i]);
    c.out[0][i] = found.tint;
    c.out[1][i] = found.mortar;
  }
}

// in: place, frequency, anisotropy, orientation in 2D, orientation in 3D (a vector)
// out: value, phase, intensity; numbers: whether it is 3D
void gabor(const OpCall& c) {
  const bool is_3d = c.numbers[0] != 0.0f;
  // Six standard deviations of the sum of waves, as far as it goes in practice.
  const float extent = 6.0f * std::sqrt(is_3d ? 8.0f * 0.5f / (4.0f * 1.41421356237f) : 1.0f);
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const float frequency = larger(c.in[3][i], 0.001f);
    const float isotropy = 1.0f - clamp01(c.in[4][i]);
    Phasor sum;
    if (is_3d) {
      const float x = c.in[6][i], y = c.in[7][i], z = c.in[8][i];
      const float length = std::sqrt(x * x + y * y + z * z);
      sum = gabor_3d({c.in[0][i], c.in[1][i], c.in[2][i]}, frequency, isotropy,
                     {x / length, y / length, z / length});
    } else {
      sum = gabor_2d({c.in[0][i], c.in[1][i]}, frequency, isotropy, c.in[5][i]);
    }
    c.out[0][i] = sum.im / extent * 0.5f + 0.5f;
    c.out[1][i] = (fn::atan2(sum.im, sum.re) + kPiFloat) / kTwoPi;
    c.out[2][i] = std::sqrt(sum.re * sum.re + sum.im * sum.im) / extent;
  }
}

constexpr OpInfo kOps[] = {
    {"wave", &wave_profile, 1, 1, 1},
    {"magic", &magic_color, 5, 3, 1},
    {"gradient", &gradient_value, 3, 1, 1},
    {"checker", [](const OpCall& c) { map3(c, &checker); }, 3, 1},
    {"brick", &brick_parts, 7, 2, 4},
    {"gabor", &gabor, 9, 3, 1},
};

}  // namespace

std::span<const OpInfo> pattern_ops() {
  return kOps;
}

}  // namespace komorebi
