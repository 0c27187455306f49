#pragma once

#include <cstdint>

namespace komorebi {

/// Where Perlin noise begins anew, by Blender's release: far from the origin floats do not tell
/// the places in a cell apart.
enum class NoiseRepeat : std::uint32_t {
  kNever,        ///< up to 4.0
  kEvery100000,  ///< and half a cell on from a million, since 4.1
};

/// perlin.h at `count` points.
/// @param p    [dimensions] columns of coordinates; dimensions is 1 to 4
/// @param out  [count], none of p
void perlin_rows(std::uint32_t dimensions, const float* const* p, std::uint32_t count,
                 NoiseRepeat repeat, float* out);

}  // namespace komorebi
