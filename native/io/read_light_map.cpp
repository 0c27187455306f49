#include <algorithm>
#include <array>
#include <cmath>

#include "io/light_map.h"
#include "io/open_image.h"

namespace komorebi {
namespace {

constexpr int kRows = 32;  ///< of a band, if the file has no tiles

/// Decoding of many equal numbers: those of 8-bit files are looked up.
class SrgbDecoder {
 public:
  explicit SrgbDecoder(bool bytes) : bytes_(bytes) {
    for (int i = 0; bytes && i < 256; ++i) {
      const auto at = static_cast<std::size_t>(i);
      value_[at] = static_cast<float>(i) * (1.0f / 255.0f);
      linear_[at] = linear_from_srgb(value_[at]);
    }
  }
  float operator()(float x) const {
    if (bytes_ && x >= 0.0f && x <= 1.0f) {
      const auto i = static_cast<std::size_t>(std::lround(x * 255.0f));
      if (value_[i] == x) return linear_[i];
    }
    return linear_from_srgb(x);
  }

 private:
  bool bytes_;
  std::array<float, 256> value_{}, linear_{};
};

}  // namespace

LightMap read_light_map(const std::string& path, ColorSpace color_space, const Cancel& cancel) {
  const auto input = open_image(path);
  const OIIO::ImageSpec spec = input->spec();
  check_image_size(path, spec);
  LightMap map(path, static_cast<std::uint32_t>(spec.width),
               static_cast<std::uint32_t>(spec.height));
  // One or two channels are grey (and alpha); from three on they begin with R, G, B.
  const int channels = spec.nchannels < 3 ? 1 : 3;
  const int band = spec.tile_height > 1 ? spec.tile_height : kRows;
  const auto width = static_cast<std::size_t>(spec.width);
  const SrgbDecoder decode(spec.format == OIIO::TypeDesc::UINT8);
  std::vector<float> read(width * static_cast<std::size_t>(band * channels));
  std::vector<float> rgb(width * static_cast<std::size_t>(band * 3));
  for (int top = 0; top < spec.height; top += band) {
    cancel.check();
    const int rows = std::min(band, spec.height - top);
    const int y = spec.y + top;
    const bool fine =
        spec.tile_width > 0
            ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, y, y + rows, spec.z, spec.z + 1,
                                0, channels, OIIO::TypeDesc::FLOAT, read.data())
            : input->read_scanlines(0, 0, y, y + rows, spec.z, 0, channels, OIIO::TypeDesc::FLOAT,
                                    read.data());
    if (!fine || input->has_error()) {
      fail_image(path, "cannot be read" + in_brackets(input->geterror()));
    }
    for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) {
      const float* from = &read[r * width * static_cast<std::size_t>(channels)];
      float* to = &rgb[(static_cast<std::size_t>(rows) - 1 - r) * width * 3];
      for (std::size_t x = 0; x < width; ++x) {
        for (std::size_t c = 0; c < 3; ++c) *to++ = channels == 1 ? from[x] : from[3 * x + c];
      }
    }
    if (color_space == ColorSpace::kSrgb) {
      for (float& value : rgb) value = decode(value);
    }
    map.put(static_cast<std::uint32_t>(spec.height - top - rows), static_cast<std::uint32_t>(rows),
            rgb.data());
  }
  return map;
}

}  // namespace komorebi
