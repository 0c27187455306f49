#pragma once

#include "core/sobol.h"

namespace komorebi {

/// The dimensions of a sample; a fixed table, so that a new use never moves an old one.
/// 2-D uses take the pair that starts at an even number.
enum Dimension : std::uint32_t {
  kDimensionPixel = 0,   ///< 0–1: where in the pixel filter
  kDimensionLens = 2,    ///< 2–3: where on the lens
  kDimensionTime = 4,    ///< when in the shutter; 5–7 reserved
  kDimensionVertex = 8,  ///< from here a block for each vertex of the path
};
inline constexpr std::uint32_t kDimensionsPerVertex = 16;

/// Within a vertex's block.
enum VertexDimension : std::uint32_t {
  kVertexLightDirection = 0,  ///< 0–1: direction of a light ray
  kVertexRoulette = 2,        ///< whether the path goes on from here; 3 reserved
  kVertexScatter = 4,         ///< 4–5: direction of the next bounce
  kVertexAmbient = 6,         ///< 6–7: direction of a ray for ambient occlusion beside light rays
  kVertexLobe = 8,            ///< which part of a surface's light; 9 reserved
  kVertexLamp = 10,  ///< 10–11: which lamp a ray goes to, and where on it; 12–15 reserved
};

/// The dimension of use `use` at path vertex `vertex` (0: where the camera ray hits). Light ray j
/// of n of camera sample i takes index i·n + j in these dimensions; where a path goes on, i.
inline std::uint32_t vertex_dimension(std::uint32_t vertex, VertexDimension use) {
  return kDimensionVertex + vertex * kDimensionsPerVertex + use;
}

/// A hash of 32 bits, every output bit of which depends on every input bit (constants: Wellons,
/// "Prospecting for Hash Functions", 2018).
inline std::uint32_t hash_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x21f0aaadu;
  x ^= x >> 15;
  x *= 0xd35a2d97u;
  return x ^ (x >> 15);
}

inline std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b) {
  return hash_bits(a ^ (hash_bits(b + 0x9e3779b9u) + (a << 6) + (a >> 2)));
}

/// 32 random bits as a float in [0, 1): 24 bits are kept, so 1 is never reached.
inline float to_unit_float(std::uint32_t bits) {
  return static_cast<float>(bits >> 8) * 5.9604644775390625e-8f;  // 2^-24
}

/// Two coordinates in [0, 1) as multiples of 2^-32: where 24 bits would be too few.
struct Bits2 {
  std::uint32_t x, y;
};

/// Owen-scrambled Sobol' points (Burley 2020), counter based: a value depends on (seed, full-frame
/// pixel, sample index, dimension) alone, so no order of work changes a picture.
///
/// Every pair of dimensions is the same (0,2)-sequence, its order shuffled by an Owen scramble of
/// the index and its coordinates Owen-scrambled, each by a seed of its own. So in each pixel and
/// pair every aligned run of 2^k samples is a (0,k,2)-net: one point in each of the 2^k boxes, for
/// every way of cutting the square into 2^i × 2^(k−i); pairs and pixels are independent.
struct Sampler {
  std::uint32_t pixel_seed;

  explicit Sampler(std::uint32_t of_pixel) : pixel_seed(of_pixel) {}
  Sampler(std::uint32_t seed, std::uint32_t x, std::uint32_t y)
      : pixel_seed(hash_combine(hash_combine(hash_bits(seed), x), y)) {}

  Bits2 bits_2d(std::uint32_t dimension, std::uint32_t index) const {
    const std::uint32_t seed = hash_combine(pixel_seed, dimension);
    const std::uint32_t i = shuffle(index, seed);
    return {reverse_bits(owen_scramble_reversed(sobol_0_reversed(i), hash_bits(seed + 1))),
            reverse_bits(owen_scramble_reversed(sobol_1_reversed(i), hash_bits(seed + 2)))};
  }

  std::uint32_t bits_1d(std::uint32_t dimension, std::uint32_t index) const {
    const std::uint32_t seed = hash_combine(pixel_seed, dimension);
    const std::uint32_t i = shuffle(index, seed);
    return reverse_bits(owen_scramble_reversed(sobol_0_reversed(i), hash_bits(seed + 1)));
  }

  Vec2 sample_2d(std::uint32_t dimension, std::uint32_t index) const {
    const Bits2 bits = bits_2d(dimension, index);
    return Vec2(to_unit_float(bits.x), to_unit_float(bits.y));
  }

  float sample_1d(std::uint32_t dimension, std::uint32_t index) const {
    return to_unit_float(bits_1d(dimension, index));
  }

 private:
  static std::uint32_t shuffle(std::uint32_t index, std::uint32_t seed) {
    return reverse_bits(owen_scramble_reversed(reverse_bits(index), seed));
  }
};

}  // namespace komorebi
