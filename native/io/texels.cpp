#include "io/texels.h"

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "core/half.h"
#include "io/open_image.h"

namespace komorebi {
namespace {

constexpr int kRows = 64;  ///< of a band, if the file has no tiles or strips

/// The widest type that a file's channels have; what is neither a byte, a short nor a float is read
/// as bytes.
TexelType type_of(const OIIO::ImageSpec& spec) {
  bool floats = spec.format.is_floating_point();
  for (const OIIO::TypeDesc& format : spec.channelformats) floats |= format.is_floating_point();
  if (spec.format == OIIO::TypeDesc::HALF) return TexelType::kHalf;
  if (floats) return TexelType::kFloat;
  return spec.format == OIIO::TypeDesc::USHORT ? TexelType::kShort : TexelType::kByte;
}

OIIO::TypeDesc oiio_type(TexelType type) {
  switch (type) {
    case TexelType::kByte:
      return OIIO::TypeDesc::UINT8;
    case TexelType::kShort:
      return OIIO::TypeDesc::USHORT;
    case TexelType::kHalf:
      return OIIO::TypeDesc::HALF;
    default:
      return OIIO::TypeDesc::FLOAT;
  }
}

/// Whether a file holds colours that alpha does not weigh: what it says itself, but for the formats
/// of which the library does not know it.
bool is_straight(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec) {
  if (spec.get_int_attribute("oiio:UnassociatedAlpha", 0) != 0) return true;
  if (spec.alpha_channel == -1) return false;
  const std::string_view format = input.format_name();
  if (format == "targa") return spec.get_int_attribute("targa:alpha_type", -1) != 4;
  return format == "dds" || format == "psd";
}

Texels shape_of(const std::string& name, const OIIO::ImageSpec& spec) {
  check_image_size(name, spec);
  Texels texels;
  texels.width = static_cast<std::uint32_t>(spec.width);
  texels.height = static_cast<std::uint32_t>(spec.height);
  texels.channels = spec.nchannels == 1 ? 1 : 4;
  texels.type = type_of(spec);
  return texels;
}

template <class T>
constexpr T kOne = T(-1);  // the largest byte or short
template <>
constexpr float kOne<float> = 1.0f;

struct Half {
  std::uint16_t bits;
};
template <>
constexpr Half kOne<Half>{0x3c00u};

std::uint8_t times(std::uint8_t a, std::uint8_t b) {
  return static_cast<std::uint8_t>(unsigned{a} * b / 255u);
}
std::uint16_t times(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint16_t>(std::uint32_t{a} * b / 65535u);
}
float times(float a, float b) {
  return a * b;
}
Half times(Half a, Half b) {
  return {half_from_float(float_from_half(a.bits) * float_from_half(b.bits))};
}

/// Pixels [count][channels] of a file, at the end of the room for [count][4], become four channels.
template <class T>
void widen(T* texels, std::size_t count, std::size_t channels, bool associate, bool leave_out) {
  const T* from = texels + (channels < 4 ? (4 - channels) * count : 0);
  for (std::size_t i = 0; i < count; ++i, texels += 4, from += channels) {
    const T r = from[0];
    const T g = channels > 2 ? from[1] : r, b = channels > 2 ? from[2] : r;
    const T a = channels == 2 ? from[1] : channels > 3 ? from[3] : kOne<T>;
    texels[0] = associate ? times(r, a) : r;
    texels[1] = associate ? times(g, a) : g;
    texels[2] = associate ? times(b, a) : b;
    texels[3] = leave_out ? kOne<T> : a;
  }
}

/// Reads all scanlines or tiles band by band, as the library's read_image does, but in bands of
/// which each takes little time. `row` is negative, from the top one on.
bool read_bands(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                std::byte* top, OIIO::stride_t row, const Cancel& cancel) {
  const int strip = std::clamp(spec.get_int_attribute("tiff:RowsPerStrip", 1), 1, spec.height);
  const int band = spec.tile_height > 1 ? spec.tile_height : (kRows + strip - 1) / strip * strip;
  for (int done = 0; done < spec.height; done += band) {
    cancel.check();
    const int y = spec.y + done, end = y + std::min(band, spec.height - done);
    std::byte* const to = top + row * done;
    const bool fine =
        spec.tile_width > 0
            ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, end, spec.z, spec.z + 1, 0,
                               spec.nchannels, type, to, OIIO::AutoStride, row)
            : input.read_scanlines(0, 0, y, end, spec.z, 0, spec.nchannels, type, to,
                                   OIIO::AutoStride, row);
    if (!fine) return false;
  }
  return true;
}

Texels read(OIIO::ImageInput& input, const std::string& name, AlphaUse alpha,
            const Cancel& cancel) {
  const OIIO::ImageSpec spec = input.spec();
  Texels texels = shape_of(name, spec);
  if (alpha.halves && texels.type != TexelType::kFloat) texels.type = TexelType::kHalf;
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const std::size_t count = std::size_t{texels.width} * texels.height;
  const std::size_t size = texel_bytes(texels.type);
  // Left as it comes, so that a file of a few bytes that claims to be huge takes no memory.
  const std::size_t room = count * size * (channels > 4 ? channels : texels.channels);
  texels.data.reset(new std::byte[room]);
  std::byte* const pixels = texels.data.get() + (room - count * size * channels);
  const auto row = static_cast<OIIO::stride_t>(size * channels * texels.width);
  const bool fine = read_bands(input, spec, oiio_type(texels.type),
                               pixels + row * (spec.height - 1), -row, cancel);
  if (!fine || input.has_error())
    fail_image(name, "cannot be read" + in_brackets(input.geterror()));
  if (channels == 1) return texels;
  // Cycles leaves grey with alpha as it is.
  const bool associate = alpha.associate && channels == 4 && is_straight(input, spec);
  std::byte* const data = texels.data.get();
  switch (texels.type) {
    case TexelType::kByte:
      widen(reinterpret_cast<std::uint8_t*>(data), count, channels, associate, alpha.leave_out);
      break;
    case TexelType::kShort:
      widen(reinterpret_cast<std::uint16_t*>(data), count, channels, associate, alpha.leave_out);
      break;
    case TexelType::kHalf:
      widen(reinterpret_cast<Half*>(data), count, channels, associate, alpha.leave_out);
      break;
    case TexelType::kFloat:
      widen(reinterpret_cast<float*>(data), count, channels, associate, alpha.leave_out);
      break;
  }
  return texels;
}

/// Colours as the file has them, whatever its alpha is: the library would multiply 8-bit ones anew.
OIIO::ImageSpec straight_please() {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  return config;
}

std::unique_ptr<OIIO::ImageInput> open_memory(OIIO::Filesystem::IOMemReader& memory,
                                              const std::string& name) {
  OIIO::ImageSpec config = straight_please();
  OIIO::Filesystem::IOProxy* proxy = &memory;  // readers that take a config look for it there
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  auto input = OIIO::ImageInput::open(name, &config, proxy);
  if (!input) {
    fail_image(name, "is not an image that can be read" + in_brackets(OIIO::geterror()));
  }
  input->threads(1);
  return input;
}

}  // namespace

Texels read_texels(const std::string& path, AlphaUse alpha, const Cancel& cancel) {
  const OIIO::ImageSpec config = straight_please();
  const auto input = open_image(path, &config);
  return read(*input, path, alpha, cancel);
}

Texels read_texels(std::span<const std::byte> file, const std::string& name, AlphaUse alpha,
                   const Cancel& cancel) {
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(file.data()), file.size());
  return read(*open_memory(memory, name), name, alpha, cancel);
}

Texels read_texel_header(const std::string& path) {
  return shape_of(path, open_image(path)->spec());
}

Texels read_texel_header(std::span<const std::byte> file, const std::string& name) {
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(file.data()), file.size());
  return shape_of(name, open_memory(memory, name)->spec());
}

}  // namespace komorebi
