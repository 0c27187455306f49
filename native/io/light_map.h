#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/light_texels.h"
#include "io/image.h"
#include "parallel/cancel.h"

namespace komorebi {

/// The texels of an environment map, put in by rows in any order. They are held exactly, in the
/// least memory that can: 4 bytes a texel where all have what a Radiance file can tell, 6 where
/// they are halves, else 12.
class LightMap {
 public:
  /// std::invalid_argument naming the map when it cannot have this size. All texels are black.
  LightMap(std::string name, std::uint32_t width, std::uint32_t height);

  /// Rows [first, first + count) from [count][width][3], linear Rec. 709, row 0 at the bottom. A
  /// texel with a channel that is not finite becomes black, as in Cycles; a negative channel 0;
  /// both are counted. Changes `rgb`.
  void put(std::uint32_t first, std::uint32_t count, float* rgb);

  const std::string& name() const { return name_; }
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  LightStorage storage() const { return storage_; }
  const float* floats() const { return floats_.get(); }        ///< null unless kFloat
  const std::uint32_t* words() const { return words_.get(); }  ///< null if kFloat
  Vec3 texel(std::uint64_t index) const;
  std::uint64_t texel_count() const { return std::uint64_t{width_} * height_; }
  float max_radiance() const { return max_radiance_; }  ///< of any channel of any texel
  std::uint64_t nonfinite_texels() const { return nonfinite_; }
  std::uint64_t negative_texels() const { return negative_; }
  std::size_t byte_count() const;

 private:
  void begin(std::size_t texels, const float* rgb);
  void clean(float* rgb, std::size_t texels);
  bool store(std::uint64_t first, std::size_t texels, const float* rgb);
  void widen();

  std::string name_;
  std::uint32_t width_, height_;
  LightStorage storage_ = LightStorage::kRgbe;
  std::unique_ptr<float[]> floats_;
  std::unique_ptr<std::uint32_t[]> words_;
  float max_radiance_ = 0.0f;
  std::uint64_t nonfinite_ = 0, negative_ = 0;
};

/// Reads a map band by band, so that no more than its texels is ever in memory; as read_image.
/// Throws Cancelled, too.
LightMap read_light_map(const std::string& path, ColorSpace color_space,
                        const Cancel& cancel = Cancel::never());

/// The map of `texels` [height][width][3], as LightMap::put takes them. Throws Cancelled.
LightMap make_light_map(std::string name, std::uint32_t width, std::uint32_t height,
                        std::span<const float> texels, const Cancel& cancel = Cancel::never());

}  // namespace komorebi
