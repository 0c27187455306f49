#pragma once

#include <memory>
#include <vector>

#include "core/float_range.h"
#include "texture/texture.h"

namespace komorebi {

/// Between which numbers the look-ups of a texture lie over some of its area: the least and largest
/// texels in blocks, and in blocks of blocks. About half a byte a texel.
class TextureBounds {
 public:
  /// @param texture  outlives this
  TextureBounds(const Texture& texture, ThreadPool& pool);

  /// Bounds of Texture::lookup(how, u, v) without a footprint: linear red, green, blue, and alpha.
  /// Nothing is known of tiles.
  void lookup(const TextureSampling& how, const FloatRange& u, const FloatRange& v,
              FloatRange (&out)[4]) const;

 private:
  struct Range {  // of texels, or of blocks; both ends are in it
    std::int32_t first, last;
  };
  struct Ranges {
    Range part[2];
    int count = 0;
    bool outside = false;  // of the picture, where CLIP has nothing
  };
  struct Block {
    Vec4 lo, hi;
    void include(const Block& other);
  };
  struct Level {
    std::int32_t width, height;
    std::vector<Block> blocks;
  };

  static Ranges covered(const TextureSampling& how, const FloatRange& place, std::int32_t count);
  Block extremes(Range x, Range y) const;

  const Texture& texture_;
  std::int32_t width_, height_;
  std::vector<Level> levels_;  // blocks of 8 texels a side, 16, …
};

}  // namespace komorebi
