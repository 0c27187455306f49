#pragma once

#include <cstddef>
#include <cstdint>

#include "io/texels.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// Half as many texels along each side, rounded down, at least one.
inline std::uint32_t coarser_side(std::uint32_t side) {
  return side > 1 ? side / 2 : 1;
}

/// Writes the level above a picture's: each texel the mean of what it covers, of light (decoded by
/// the sRGB curve where `srgb`), colours weighed by alpha where they are straight ones once divided
/// by it. Cancelled, it leaves it half done.
struct LevelShape {
  TexelType type;
  std::uint32_t channels;
  bool srgb, weighed;
  /// Of the finest level the light between its texels counts, which look-ups interpolate as stored:
  /// where neighbours differ it is darker than their mean.
  bool finest = false;
};
void make_coarser(const LevelShape& shape, const std::byte* from, std::uint32_t width,
                  std::uint32_t height, std::byte* to, ThreadPool& pool,
                  const Cancel& cancel = Cancel::never());

}  // namespace komorebi
