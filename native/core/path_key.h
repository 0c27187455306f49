#pragma once

#include "core/sampler.h"

namespace komorebi {

/// A ray's number among all rays of a picture (Ray::path_key), as hit filters draw lots by: of its
/// pixel, the dimension that it was drawn by and its index there. So it is the same in any batch.
/// @param dimension  kDimensionPixel of a camera ray, else that of the direction: vertex_dimension
/// @param index      of the camera sample, or of the light ray (sample · light_samples + j)
inline std::uint32_t path_key(std::uint32_t pixel_seed, std::uint32_t dimension,
                              std::uint32_t index) {
  return hash_combine(hash_combine(pixel_seed, dimension), index);
}

}  // namespace komorebi
