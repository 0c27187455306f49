#include "io/open_image.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

namespace komorebi {
namespace {

constexpr int kMaxSide = 1 << 17;
constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 32;  // 16 GiB of floats

}  // namespace

void fail_image(const std::string& path, const std::string& why) {
  throw std::runtime_error("image \"" + path + "\": " + why);
}

std::string in_brackets(const std::string& message) {
  const std::string line = message.substr(0, message.find_first_of("\r\n"));
  return line.empty() ? std::string() : " (" + line + ")";
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::string& path,
                                             const OIIO::ImageSpec* config) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail_image(path, "no such file");
  if (std::filesystem::is_directory(status)) fail_image(path, "is a folder, not an image");
  if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
    std::fclose(file);
  } else {
    fail_image(path, "cannot be opened for reading");
  }
  auto input = OIIO::ImageInput::open(path, config);
  if (!input) fail_image(path, "is not an image that can be read" + in_brackets(OIIO::geterror()));
  input->threads(1);
  return input;
}

void check_image_size(const std::string& path, const OIIO::ImageSpec& spec) {
  const bool sane = spec.width > 0 && spec.height > 0 && spec.nchannels > 0 &&
                    spec.width <= kMaxSide && spec.height <= kMaxSide && spec.depth <= 1 &&
                    static_cast<std::uint64_t>(spec.width) *
                            static_cast<std::uint64_t>(spec.height) *
                            static_cast<std::uint64_t>(spec.nchannels) <=
                        kMaxValues;
  if (!sane) {
    fail_image(path, "has an absurd size, " + std::to_string(spec.width) + " × " +
                         std::to_string(spec.height) + " × " + std::to_string(spec.nchannels));
  }
  if (spec.deep) fail_image(path, "is a deep image, which is not supported");
}

}  // namespace komorebi
