#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "parallel/thread_pool.h"
#include "render/cells.h"
#include "render/matte.h"
#include "render/passes.h"
#include "render/settings.h"
#include "render/zeroed_array.h"

namespace komorebi {

/// What one camera sample adds to the picture; what it adds to other passes is a row of floats
/// (PassLayout).
struct PixelSample {
  Vec3 radiance{0.0f};  ///< premultiplied, scene linear
  float alpha = 0.0f;
};

/// Sums of some cells' pixels, made by one thread and merged into the film as a whole. What a film
/// was not asked for leaves its array empty.
struct TileSums {
  std::vector<std::int64_t> combined;  ///< [pixels][4]: radiance, alpha
  std::vector<std::int64_t> means;     ///< [pixels][PassLayout::means]
  std::vector<float> firsts;           ///< [pixels][PassLayout::firsts], of the first sample
  std::vector<std::uint64_t> squares;  ///< [pixels][9]: Film::add_squares
  MatteSums mattes[kMattes];           ///< of as many as the layout has
  bool has_first = false;
  std::uint32_t samples = 0;
  std::uint64_t clamped = 0;
};

/// The whole frame's sums. They are 64-bit integers in units of a power of two that depends on the
/// scene and the range of sample indices alone, so adding is exact and associative: no order of
/// threads, tiles or sample ranges can show in the picture.
///
/// All pixels of a cell have the same number of samples, so that is kept once a cell.
class Film {
 public:
  /// `max_radiance`: bound of the world's radiance; samples beyond 32 times that (and what the
  /// settings' bounces may add) are clamped and counted, which only a defect elsewhere can cause.
  /// Throws std::invalid_argument for a pass that is not known. With `catchers` the picture is
  /// composed of what is no shadow catcher over the shadows on those that are. `max_value`: bound
  /// of the materials' values (SceneTables).
  Film(const Rect& region, const Settings& settings, float max_radiance, bool catchers = false,
       float max_value = 1.0f);

  const Rect& region() const { return region_; }
  const PassLayout& layout() const { return layout_; }

  /// Empties `sums` and makes room for this many pixels.
  void reset(TileSums& sums, std::size_t pixels) const;
  /// Quantises one sample into a tile's sums; `pixel` is an index into them, `row` has what
  /// layout() keeps.
  void add(TileSums& tile, std::size_t pixel, std::uint32_t sample_index, const PixelSample& sample,
           const float* row) const;
  /// Adds the sums of these cells, each of them as cells_of(region()) has it. Any thread.
  void merge(Cells cells, const TileSums& sums);

  /// Writes a pass of a rectangle (full-frame pixels) as [height][width][channels] floats.
  /// Pixels without samples are zero. Safe while others merge.
  void read(const std::string& pass, const Rect& rect, float* out) const;
  /// The same, on the pool's threads when it has them to spare.
  void read(const std::string& pass, const Rect& rect, float* out, ThreadPool& pool) const;

  /// Mean radiance and alpha of a cell's pixels so far, as [pixels][4]; one of cells_of(region()).
  void cell_means(const Rect& cell, float* out) const;

  /// Of a film with these passes, about: Cryptomattes take what they find.
  static std::size_t bytes_per_pixel(const std::vector<std::string>& passes);

  std::uint64_t clamped_samples() const;
  std::size_t byte_count() const;

 private:
  /// The rows of cells, each with a lock of its own: who reads does not hold up who merges.
  struct Band {
    mutable std::mutex mutex;
    std::uint64_t clamped = 0;
  };

  std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return static_cast<std::size_t>(y - region_.y_min) * region_.width() + (x - region_.x_min);
  }
  static std::uint32_t pixel_in_cell(std::uint32_t x, std::uint32_t y) {
    return y % kCellSize * kCellSize + x % kCellSize;
  }
  std::size_t band(std::uint32_t y) const { return y / kCellSize - region_.y_min / kCellSize; }
  std::size_t cell(std::uint32_t x, std::uint32_t y) const {
    return band(y) * cells_across_ + (x / kCellSize - region_.x_min / kCellSize);
  }
  std::int64_t quantise(float value, double scale, std::uint64_t& clamped) const;
  /// Adds the squares of three quantised channels: of the halves a and b of their bits a², ab, b².
  void add_squares(const std::int64_t* quantised, std::uint64_t* sums) const;
  bool holds(const PassDesc& desc) const;
  /// A pass of pixels `i` to `i + count`, of one row of one cell.
  void read_run(const PassDesc& desc, std::uint32_t part, std::size_t i, std::uint32_t x,
                std::uint32_t y, std::size_t count, float* out) const;
  void read_variance(std::size_t i, std::size_t count, double samples, float* out) const;
  void read_mean_of_hits(const PassDesc& desc, std::size_t i, std::size_t count, float* out) const;
  /// The picture of a scene with shadow catchers.
  void read_composed(std::size_t i, std::size_t count, double samples, float* out) const;
  /// A quantity's mean in one pixel.
  Vec3d mean(Quantity q, std::size_t i, double samples) const;
  Vec3d catcher_shadow(std::size_t i, double samples) const;
  void read_band(const PassDesc& desc, std::uint32_t part, const Rect& rect, float* out) const;

  Rect region_;
  std::uint32_t first_sample_, samples_;
  PassLayout layout_;
  bool catchers_, transparent_;
  bool shows_shadow_;               // in the picture: not when the shadow is asked for as a pass
  double radiance_scale_;           // integer units a unit of radiance: a power of two
  double unit_scale_;               // the same for alpha
  std::vector<double> mean_scale_;  // of each channel of the means
  double limit_;                    // largest sample, so that a sum of all cannot overflow
  int half_bits_;                   // of a quantised sample
  std::uint32_t cells_across_;
  std::vector<Band> bands_;
  ZeroedArray<std::int64_t> combined_, means_;
  ZeroedArray<float> firsts_;
  ZeroedArray<std::uint64_t> squares_;
  std::vector<MatteCell> mattes_[kMattes];  // of each cell
  std::vector<std::uint32_t> counts_;       // samples of each cell
};

/// To the nearest integer, ties to even, for |scaled| < 2^51: adding 1.5 · 2^52 leaves the integer
/// in the low bits of the sum. A few operations that compilers vectorise, where nearbyint() is a
/// call on machines of the oldest kind that we support.
inline std::int64_t round_to_integer(double scaled) {
  constexpr double kMagic = 6755399441055744.0;
  return std::bit_cast<std::int64_t>(scaled + kMagic) - std::bit_cast<std::int64_t>(kMagic);
}

inline std::int64_t Film::quantise(float value, double scale, std::uint64_t& clamped) const {
  double scaled = double{value} * scale;           // exact: a power of two
  if (!(scaled >= -limit_ && scaled <= limit_)) {  // NaN comes here too
    ++clamped;
    scaled = scaled > limit_ ? limit_ : scaled < -limit_ ? -limit_ : 0.0;
  }
  return round_to_integer(scaled);
}

inline void Film::add(TileSums& tile, std::size_t pixel, std::uint32_t sample_index,
                      const PixelSample& s, const float* row) const {
  std::int64_t* combined = &tile.combined[4 * pixel];
  std::int64_t quantised[3];
  for (int c = 0; c < 3; ++c) {
    quantised[c] = quantise(s.radiance[c], radiance_scale_, tile.clamped);
    combined[c] += quantised[c];
  }
  combined[3] += quantise(s.alpha, unit_scale_, tile.clamped);
  if (layout_.keeps_variance) add_squares(quantised, &tile.squares[9 * pixel]);
  for (std::size_t k = 0; k < layout_.means; ++k) {
    tile.means[layout_.means * pixel + k] += quantise(row[k], mean_scale_[k], tile.clamped);
  }
  row += layout_.means;
  if (sample_index == first_sample_ && layout_.firsts > 0) {
    for (std::size_t k = 0; k < layout_.firsts; ++k) {
      tile.firsts[layout_.firsts * pixel + k] = row[k];
    }
    tile.has_first = true;
  }
  row += layout_.firsts;
  for (std::size_t k = 0; k < layout_.ids; ++k) {
    tile.mattes[k].add(pixel, std::bit_cast<std::uint32_t>(row[k]));
  }
}

}  // namespace komorebi
