#pragma once

#include <cstdint>

#include "shader/perlin_rows.h"

namespace komorebi {

/// How octaves of noise are put together (Musgrave; Ebert et al., "Texturing and Modeling").
enum class FractalType : std::uint32_t {
  kMultifractal,
  kRidged,
  kHybrid,
  kFbm,
  kHeteroTerrain,
};

struct FractalKind {
  std::uint32_t dimensions = 3;
  FractalType type = FractalType::kFbm;
  bool normalize = false;     ///< fBm to [0, 1]
  bool counts_first = false;  ///< detail 1 is one octave, as in the Musgrave node; else it is two
  NoiseRepeat repeat = NoiseRepeat::kEvery100000;
};

/// Columns of what may differ from point to point.
struct FractalRows {
  const float* p[4];  ///< coordinates
  const float *detail, *roughness, *lacunarity, *offset, *gain;
};

/// Fractal noise at `count` points, at most Program::kLanes. Detail is clamped to [0, 15]
/// and roughness to ≥ 0.
/// @param out  [count]
void fractal_noise(const FractalKind& kind, const FractalRows& rows, std::uint32_t count,
                   float* out);

}  // namespace komorebi
