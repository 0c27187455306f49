#include "io/image.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "io/open_image.h"

// The host may use the same library: nothing global is touched here. No image cache, no global
// attribute, no thread pool, and error messages are always collected (the library would print what
// is left at exit).
namespace komorebi {
namespace {

void flip_rows(Image& image) {
  const std::size_t row = std::size_t{image.width} * image.channels.size();
  for (std::size_t a = 0, b = image.height - 1; a < b; ++a, --b) {
    std::swap_ranges(image.pixels.begin() + static_cast<std::ptrdiff_t>(a * row),
                     image.pixels.begin() + static_cast<std::ptrdiff_t>((a + 1) * row),
                     image.pixels.begin() + static_cast<std::ptrdiff_t>(b * row));
  }
}

// The fifth root of x in [1, 32) by Newton's iteration from above, to double precision.
double fifth_root(double x) {
  double y = 1.0 + 0.2 * (x - 1.0);
  for (int i = 0; i < 24; ++i) {
    const double y2 = y * y;
    y = 0.8 * y + 0.2 * (x / (y2 * y2));
  }
  return y;
}

}  // namespace

Image read_channels(const std::string& path) {
  const auto input = open_image(path);
  const OIIO::ImageSpec spec = input->spec();
  check_image_size(path, spec);
  Image image;
  image.width = static_cast<std::uint32_t>(spec.width);
  image.height = static_cast<std::uint32_t>(spec.height);
  image.channels = spec.channelnames;
  image.channels.resize(static_cast<std::size_t>(spec.nchannels));
  image.pixels.resize(std::size_t{image.width} * image.height * image.channels.size());
  const bool read =
      input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data());
  if (!read || input->has_error())
    fail_image(path, "cannot be read" + in_brackets(input->geterror()));
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    if (value.type() == OIIO::TypeDesc::STRING) {
      image.metadata.emplace_back(value.name().string(), value.get_string());
    }
  }
  input->close();
  flip_rows(image);
  return image;
}

Image read_image(const std::string& path, ColorSpace color_space) {
  Image file = read_channels(path);
  const std::size_t channels = file.channels.size();
  const std::size_t count = std::size_t{file.width} * file.height;
  // One or two channels are grey (and alpha); from three on they begin with R, G, B.
  const std::size_t green = channels < 3 ? 0 : 1;
  const std::size_t blue = channels < 3 ? 0 : 2;
  std::vector<float> rgb(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* p = &file.pixels[i * channels];
    rgb[3 * i] = p[0];
    rgb[3 * i + 1] = p[green];
    rgb[3 * i + 2] = p[blue];
  }
  if (color_space == ColorSpace::kSrgb) {
    for (float& value : rgb) value = linear_from_srgb(value);
  }
  file.channels = {"R", "G", "B"};
  file.pixels = std::move(rgb);
  return file;
}

void write_exr(const std::string& path, const Image& image) {
  const std::size_t channels = image.channels.size();
  if (channels == 0 || image.width == 0 || image.height == 0 ||
      image.pixels.size() != std::size_t{image.width} * image.height * channels) {
    throw std::invalid_argument("image \"" + path + "\": pixels and channels do not fit its size");
  }
  auto output = OIIO::ImageOutput::create("exr");
  if (!output)
    fail_image(path, "OpenEXR files cannot be written here" + in_brackets(OIIO::geterror()));
  output->threads(1);
  OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height),
                       static_cast<int>(channels), OIIO::TypeDesc::FLOAT);
  spec.channelnames = image.channels;
  for (const auto& [key, value] : image.metadata) spec.attribute(key, value);
  spec.attribute("compression", "zip");

  Image top_down{image.width, image.height, image.channels, image.pixels, {}};
  flip_rows(top_down);
  const bool written = output->open(path, spec) &&
                       output->write_image(OIIO::TypeDesc::FLOAT, top_down.pixels.data()) &&
                       output->close();
  if (!written) {
    const std::string why = output->geterror();
    output.reset();
    fail_image(path, "cannot be written" + in_brackets(why));
  }
}

float linear_from_srgb(float encoded) {
  const double x = encoded;
  if (x <= 0.04045) return static_cast<float>(x / 12.92);
  if (!std::isfinite(x)) return encoded;
  // a^2.4 = a² · (a²)^(1/5), with the power of 2^5 taken out so that the root starts near
  const double a = (x + 0.055) / 1.055;
  double scaled = a * a, scale = 1.0;
  while (scaled < 1.0) scaled *= 32.0, scale *= 0.5;
  while (scaled >= 32.0) scaled /= 32.0, scale *= 2.0;
  return static_cast<float>(a * a * (fifth_root(scaled) * scale));
}

}  // namespace komorebi
