#pragma once

#include "core/sampler.h"

namespace komorebi {

/// What a ray looks for: the lowest bits of its path_key.
enum class PathKind : std::uint32_t { kCamera = 0, kLight = 1, kScatter = 2 };

inline PathKind path_kind(std::uint32_t path_key) {
  return static_cast<PathKind>(path_key & 3u);
}

/// A ray's number among all rays of a picture (Ray::path_key), as hit filters draw lots by: of its
/// pixel, the dimension that it was drawn by and its index there. So it is the same in any batch.
/// @param dimension  kDimensionPixel of a camera ray, else that of the direction: vertex_dimension
/// @param index      of the camera sample, or of the light ray (sample · light_samples + j)
inline std::uint32_t path_key(std::uint32_t pixel_seed, std::uint32_t dimension,
                              std::uint32_t index) {
  PathKind kind = PathKind::kLight;
  if (dimension == kDimensionPixel) {
    kind = PathKind::kCamera;
  } else if ((dimension - kDimensionVertex) % kDimensionsPerVertex == kVertexScatter) {
    kind = PathKind::kScatter;
  }
  const std::uint32_t hash = hash_combine(hash_combine(pixel_seed, dimension), index);
  return (hash & ~3u) | static_cast<std::uint32_t>(kind);
}

}  // namespace komorebi
