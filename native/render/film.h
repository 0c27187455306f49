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
#include "render/settings.h"
#include "render/zeroed_array.h"

namespace komorebi {

/// How the samples of a pixel become its value in a pass.
enum class PassRule : std::uint32_t {
  kMean,         ///< sum of the samples over their number
  kFirstSample,  ///< what the sample with the lowest index saw (depth, as Cycles)
  kCount,        ///< the number of samples over the largest, `samples` (as Cycles)
};

struct PassDesc {
  const char* name;
  std::uint32_t channels;
  PassRule rule;
};

/// The passes that a film can keep, by Blender's names.
std::span<const PassDesc> known_passes();

/// What one camera sample adds to its pixel.
struct PixelSample {
  Vec3 radiance{0.0f};  ///< premultiplied, scene linear
  float alpha = 0.0f;
  float depth = 1e10f;  ///< along the camera's axis; Blender's background
  Vec3 normal{0.0f};    ///< world space
};

/// Sums of some cells' pixels, made by one thread and merged into the film as a whole. A film that
/// was not asked for a pass leaves its array empty.
struct TileSums {
  std::vector<std::int64_t> combined;  ///< [pixels][4]: radiance, alpha
  std::vector<std::int64_t> normal;    ///< [pixels][3]
  std::vector<float> depth;            ///< [pixels], of the film's first sample
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
  /// `max_radiance`: bound of the world's radiance; samples beyond 32 times that are clamped and
  /// counted, which only a defect elsewhere can cause. Throws std::invalid_argument for a pass
  /// that is not known.
  Film(const Rect& region, const Settings& settings, float max_radiance);

  const Rect& region() const { return region_; }

  /// Empties `sums` and makes room for this many pixels.
  void reset(TileSums& sums, std::size_t pixels) const;
  /// Quantises one sample into a tile's sums; pixel is an index into them.
  void add(TileSums& tile, std::size_t pixel, std::uint32_t sample_index,
           const PixelSample& sample) const;
  /// Adds the sums of these cells, each of them as cells_of(region()) has it. Any thread.
  void merge(Cells cells, const TileSums& sums);

  /// Writes a pass of a rectangle (full-frame pixels) as [height][width][channels] floats.
  /// Pixels without samples are zero. Safe while others merge.
  void read(const std::string& pass, const Rect& rect, float* out) const;
  /// The same, on the pool's threads when it has them to spare.
  void read(const std::string& pass, const Rect& rect, float* out, ThreadPool& pool) const;
  static const PassDesc& pass(const std::string& name);  ///< throws std::invalid_argument

  /// Mean radiance and alpha of a cell's pixels so far, as [pixels][4]; one of cells_of(region()).
  void cell_means(const Rect& cell, float* out) const;

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
  std::size_t band(std::uint32_t y) const { return y / kCellSize - region_.y_min / kCellSize; }
  std::size_t cell(std::uint32_t x, std::uint32_t y) const {
    return band(y) * cells_across_ + (x / kCellSize - region_.x_min / kCellSize);
  }
  std::int64_t quantise(float value, double scale, std::uint64_t& clamped) const;
  void read_band(const PassDesc& desc, const Rect& rect, float* out) const;

  Rect region_;
  std::uint32_t first_sample_, samples_;
  bool keeps_normal_, keeps_depth_;
  double radiance_scale_;  // integer units a unit of radiance: a power of two
  double unit_scale_;      // the same for alpha and normals
  double limit_;           // largest sample, so that a sum of all cannot overflow
  std::uint32_t cells_across_;
  std::vector<Band> bands_;
  ZeroedArray<std::int64_t> combined_, normal_;
  ZeroedArray<float> depth_;
  std::vector<std::uint32_t> counts_;  // samples of each cell
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
                      const PixelSample& s) const {
  std::int64_t* combined = &tile.combined[4 * pixel];
  for (int c = 0; c < 3; ++c) {
    combined[c] += quantise(s.radiance[c], radiance_scale_, tile.clamped);
  }
  combined[3] += quantise(s.alpha, unit_scale_, tile.clamped);
  if (keeps_normal_) {
    std::int64_t* normal = &tile.normal[3 * pixel];
    for (int c = 0; c < 3; ++c) normal[c] += quantise(s.normal[c], unit_scale_, tile.clamped);
  }
  if (sample_index == first_sample_ && keeps_depth_) {
    tile.depth[pixel] = s.depth;
    tile.has_first = true;
  }
}

}  // namespace komorebi
