#pragma once

#include "shader/voronoi.h"

namespace komorebi {

/// One octave of each feature, in 1 to 4 dimensions, for one instruction set. Coordinates are
/// rows.p; scale, detail, roughness and lacunarity are not read.
struct VoronoiKernel {
  using Find = void (*)(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
                        VoronoiFound& found);
  using Measure = void (*)(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
                           float* out);
  Find nearest[4], second[4], smooth[4];
  Measure edge[4], radius[4];
};

const VoronoiKernel& voronoi_kernel();

/// out[i] = |a[i] − b[i]|^exponent[i], added to what is there unless `first`.
void add_powers(const float* a, const float* b, const float* exponent, std::uint32_t count,
                bool first, float* out);
/// x[i] = x[i]^(1 / exponent[i])
void take_roots(const float* exponent, std::uint32_t count, float* x);

/// The distance between opposite corners of a cube.
float voronoi_reach(VoronoiMetric metric, std::uint32_t dimensions, float side, float exponent);

}  // namespace komorebi
