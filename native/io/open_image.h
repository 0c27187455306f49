#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

namespace komorebi {

/// std::runtime_error: `image "PATH": WHY`
[[noreturn]] void fail_image(const std::string& path, const std::string& why);

/// The library's own words in brackets, cut to their first line.
std::string in_brackets(const std::string& message);

/// Opens a file for reading; fails with a sentence when it is missing or no image.
std::unique_ptr<OIIO::ImageInput> open_image(const std::string& path,
                                             const OIIO::ImageSpec* config = nullptr);

/// Fails when an image is deep or absurdly large.
void check_image_size(const std::string& path, const OIIO::ImageSpec& spec);

}  // namespace komorebi
