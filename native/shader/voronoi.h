#pragma once

#include <cstdint>

#include "shader/program.h"

namespace komorebi {

enum class VoronoiMetric : std::uint32_t { kEuclidean, kManhattan, kChebychev, kMinkowski };
enum class VoronoiFeature : std::uint32_t { kF1, kF2, kSmoothF1 };

struct VoronoiKind {
  std::uint32_t dimensions = 3;
  VoronoiFeature feature = VoronoiFeature::kF1;
  VoronoiMetric metric = VoronoiMetric::kEuclidean;
  bool normalize = false;
  bool pcg = false;         ///< cells are hashed as since Blender 5.0
  bool wants_color = true;  ///< else it is black where it costs much
  /// What is not nearer than this is not found; only Minkowski's distances come so far.
  float far = 3.402823466e38f;
};

/// Columns of what may differ from point to point.
struct VoronoiRows {
  const float* p[4];  ///< coordinates, scaled
  const float *scale, *detail, *roughness, *lacunarity, *smoothness, *exponent, *randomness;
};

using VoronoiRow = float[Program::kLanes];

/// What is found at points, or in one octave of it.
struct VoronoiFound {
  VoronoiRow distance, color[3];
  VoronoiRow position[4];  ///< one for each dimension
};

/// Nearest or second nearest of the points of a grid's cells, one in each (Worley), or the smooth
/// minimum over them; octaves of that as in Cycles.
void voronoi(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
             VoronoiFound& found);

/// The distance to the nearest border between cells. Feature and metric do not matter.
void voronoi_edge(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
                  float* distance);

/// The radius of the largest sphere around the nearest point that meets no other's. As above.
void voronoi_radius(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
                    float* radius);

}  // namespace komorebi
