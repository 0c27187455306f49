#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/vector.h"
#include "io/texels.h"
#include "parallel/array.h"
#include "parallel/cancel.h"
#include "texture/sampling.h"

namespace komorebi {

class ThreadPool;

/// What a picture's numbers mean.
struct TextureColor {
  bool srgb = false;  ///< decoded by the sRGB curve, after interpolation as in Cycles
  bool data = false;  ///< no colours: never divided by alpha (nor are packed channels)
  /// Another space's primaries: linear Rec. 709 from it, row by row, applied when the texture is
  /// made (as Cycles does, which then keeps bytes and shorts as halves); with the curve, after it.
  bool has_matrix = false;
  std::array<float, 9> matrix{};
};

/// Which levels of a picture are kept.
struct TextureLevels {
  std::uint32_t skip = 0;  ///< how many of the finest are left out, to save memory
  bool coarser = true;     ///< whether there is more than one
};

/// A picture, or the tiles of one (UDIM), with coarser levels; immutable, to be shared and counted.
/// What a look-up gives depends on the picture alone, to the bit. Safe from any thread.
class Texture {
 public:
  /// Numbers that are not finite become 0, and are counted with their texel.
  /// @throws std::invalid_argument naming the texture when it has no texels or too many
  ///         Cancelled
  Texture(std::string name, Texels texels, const TextureColor& color, ThreadPool& pool,
          const TextureLevels& kept = {}, const Cancel& cancel = Cancel::never());

  /// Tiles by their UDIM numbers: 1001 + column + 10 · row. Where there is no tile, magenta.
  /// @throws std::invalid_argument
  using Tile = std::pair<std::uint32_t, std::shared_ptr<const Texture>>;
  Texture(std::string name, std::vector<Tile> tiles);

  /// One texel of Cycles' magenta, for a picture that is missing.
  static std::shared_ptr<const Texture> missing(std::string name);

  /// Colour (linear Rec. 709) and alpha at a place of the picture, (0, 0) to (1, 1), bottom left to
  /// top right.
  /// @param footprint  width of what may be averaged, in the same units; 0: nothing, as in Cycles.
  ///                   Of the level with the largest texels that are no wider, the texel there is
  ///                   taken: interpolated as stored, neighbours would not have their mean in
  ///                   light.
  Vec4 lookup(const TextureSampling& how, float u, float v, float footprint = 0.0f) const;

  const std::string& name() const { return name_; }
  std::uint32_t width() const { return levels_.empty() ? 0 : levels_[0].width; }  ///< 0: tiles
  std::uint32_t height() const { return levels_.empty() ? 0 : levels_[0].height; }
  std::uint32_t channels() const { return channels_; }
  TexelType type() const { return type_; }
  bool is_srgb() const { return srgb_; }
  bool is_data() const { return data_; }
  const std::vector<Tile>& tiles() const { return tiles_; }
  /// Of the finest level that is kept, [height][width][channels].
  std::span<const std::byte> finest_texels() const {
    const std::size_t texels = std::size_t{width()} * height();
    return {levels_.at(0).data, texels * channels_ * texel_bytes(type_)};
  }
  std::size_t level_count() const { return levels_.size(); }
  std::size_t byte_count() const;
  std::uint64_t nonfinite_texels() const;

  /// Bytes of a picture's levels.
  static std::size_t byte_count(const Texels& header, const TextureColor& color,
                                const TextureLevels& kept = {});

 private:
  struct Level {
    const std::byte* data;
    std::uint32_t width, height;
  };

  void add_levels(ThreadPool& pool, std::uint32_t skip, const Cancel& cancel);
  void keep_first_level();

  std::string name_;
  bool srgb_ = false, data_ = false;
  std::uint32_t channels_ = 4;
  TexelType type_ = TexelType::kByte;
  std::uint64_t nonfinite_ = 0;
  std::unique_ptr<std::byte[]> finest_;  ///< null when it is skipped
  Array<std::byte> coarser_;
  std::vector<Level> levels_;
  std::vector<Tile> tiles_;  ///< by number
};

}  // namespace komorebi
