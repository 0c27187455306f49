#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "parallel/cancel.h"

namespace komorebi {

/// How a texel's numbers are stored; bytes and shorts stand for 0 to 1.
enum class TexelType : std::uint8_t { kByte, kShort, kHalf, kFloat };

constexpr std::size_t texel_bytes(TexelType type) {
  return type == TexelType::kByte ? 1 : type == TexelType::kFloat ? 4 : 2;
}

/// A picture in its file's own type of number, row 0 at the bottom: one channel (grey) or four.
struct Texels {
  std::uint32_t width = 0, height = 0, channels = 0;
  TexelType type = TexelType::kByte;
  std::unique_ptr<std::byte[]> data;  ///< [height][width][channels]

  std::size_t byte_count() const {
    return std::size_t{width} * height * channels * texel_bytes(type);
  }
};

/// What alpha is to colours, as Blender's Image.alpha_mode says it and Cycles takes it.
struct AlphaUse {
  /// Colours that a file holds without alpha are multiplied by it, in the file's type of number.
  /// Not for data, channels that are packed, and where alpha is left out.
  bool associate = true;
  bool leave_out = false;  ///< alpha is 1
  /// Bytes and shorts are read as halves: for colours that are to be converted, as in Cycles.
  bool halves = false;
};

/// Reads the first picture of a file in the type of number that it has, as Cycles does: one channel
/// stays grey, two are grey and alpha, of more than four the first four are taken.
/// std::runtime_error with one sentence that names the file when it is missing, not a readable
/// image, broken or absurdly large; Cancelled.
Texels read_texels(const std::string& path, AlphaUse alpha, const Cancel& cancel = Cancel::never());

/// The same of a file in memory; `name` (for messages) may end like a file's name, which tells its
/// format.
Texels read_texels(std::span<const std::byte> file, const std::string& name, AlphaUse alpha,
                   const Cancel& cancel = Cancel::never());

/// What reading a file would give, without its data.
Texels read_texel_header(const std::string& path);
Texels read_texel_header(std::span<const std::byte> file, const std::string& name);

}  // namespace komorebi
