#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "render/cells.h"
#include "render/settings.h"

namespace komorebi {

/// How the samples of a pixel become its value in a pass.
enum class PassRule : std::uint32_t {
  kMean,         ///< sum of the samples over their number
  kFirstSample,  ///< what the sample with the lowest index saw (depth, as Cycles)
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

/// Sums of some cells' pixels, made by one thread and merged into the film as a whole.
struct TileSums {
  std::vector<std::int64_t> mean;  ///< [pixels][8]: radiance 3, alpha, normal 3, unused
  std::vector<float> depth;        ///< [pixels], of the film's first sample
  bool has_first = false;
  std::uint32_t samples = 0;
  std::uint64_t clamped = 0;

  void reset(std::size_t pixels);
};

/// The whole frame's sums. They are 64-bit integers in units of a power of two that depends on the
/// scene and the range of sample indices alone, so adding is exact and associative: no order of
/// threads, tiles or sample ranges can show in the picture.
class Film {
 public:
  /// `max_radiance`: bound of the world's radiance; samples beyond 32 times that are clamped and
  /// counted, which only a defect elsewhere can cause. Throws std::invalid_argument for a pass
  /// that is not known.
  Film(const Rect& region, const Settings& settings, float max_radiance);

  const Rect& region() const { return region_; }
  /// Quantises one sample into a tile's sums; pixel is an index into them.
  void add(TileSums& tile, std::size_t pixel, std::uint32_t sample_index,
           const PixelSample& sample) const;
  /// Adds the sums of these cells' pixels. Safe from any thread.
  void merge(Cells cells, const TileSums& sums);

  /// Writes a pass of a rectangle (full-frame pixels) as [height][width][channels] floats.
  /// Pixels without samples are zero. Safe while others merge.
  void read(const std::string& pass, const Rect& rect, float* out) const;
  static const PassDesc& pass(const std::string& name);  ///< throws std::invalid_argument

  std::uint64_t clamped_samples() const;
  std::size_t byte_count() const;

 private:
  static constexpr std::size_t kChannels = 8;
  std::size_t index(std::uint32_t x, std::uint32_t y) const {
    return static_cast<std::size_t>(y - region_.y_min) * region_.width() + (x - region_.x_min);
  }
  std::int64_t quantise(float value, double scale, std::uint64_t& clamped) const;

  Rect region_;
  std::uint32_t first_sample_;
  double radiance_scale_;  // integer units a unit of radiance: a power of two
  double unit_scale_;      // the same for alpha and normals
  std::int64_t limit_;     // largest sample, so that a sum of all cannot overflow
  mutable std::mutex mutex_;
  std::vector<std::int64_t> sums_;
  std::vector<float> depth_;
  std::vector<std::uint32_t> counts_;
  std::uint64_t clamped_ = 0;
};

}  // namespace komorebi
