#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace komorebi {

/// An image of any channels in memory: linear floats, interleaved, row 0 at the bottom.
struct Image {
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> channels;                          ///< names, in the order of the data
  std::vector<float> pixels;                                  ///< [height][width][channels.size()]
  std::vector<std::pair<std::string, std::string>> metadata;  ///< text attributes (read back only)
};

/// What a file's numbers mean: light itself, or values to be decoded by the sRGB curve.
enum class ColorSpace { kLinear, kSrgb };

/// Reads level 0 of the first image of a file (HDR, EXR, PNG, JPEG, TIFF, …) as three channels
/// R, G, B of linear Rec. 709; grey files give three equal channels, alpha is dropped. Integer
/// files map to [0, 1]. std::runtime_error with one sentence that names the file when it is
/// missing, not a readable image, or absurdly large.
Image read_image(const std::string& path, ColorSpace color_space = ColorSpace::kLinear);

/// Reads every channel of a file as it is, with its text attributes; errors as read_image.
Image read_channels(const std::string& path);

/// Writes an OpenEXR file of 32-bit floats with the image's channel names and metadata;
/// std::runtime_error naming the file when it cannot, std::invalid_argument when sizes do not fit.
void write_exr(const std::string& path, const Image& image);

/// The sRGB curve (IEC 61966-2-1) from encoded to linear light, continued evenly below 0 and as it
/// is above 1. Relative error ≤ 1e-6; the same bits on every machine.
float linear_from_srgb(float encoded);

}  // namespace komorebi
