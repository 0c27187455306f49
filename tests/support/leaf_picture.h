#pragma once

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "parallel/thread_pool.h"
#include "texture/texture.h"

namespace komorebi::testing {

/// A picture of a leaf: alpha 1 within a lens, 0 outside, a row of halves along its rib; colours
/// that rise. Of one channel it is the alpha.
inline std::shared_ptr<const Texture> leaf_picture(std::uint32_t width, std::uint32_t height,
                                                   TexelType type, std::uint32_t channels,
                                                   const TextureColor& color, ThreadPool& pool) {
  Texels texels;
  texels.width = width;
  texels.height = height;
  texels.channels = channels;
  texels.type = type;
  texels.data.reset(new std::byte[texels.byte_count()]);
  std::size_t at = 0;
  const auto put = [&](double value) {
    if (type == TexelType::kByte) {
      texels.data[at++] = static_cast<std::byte>(static_cast<int>(value * 255.0 + 0.5));
    } else {
      const auto number = static_cast<float>(value);
      std::memcpy(&texels.data[at], &number, sizeof number);
      at += sizeof number;
    }
  };
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width, v = (y + 0.5) / height;
      const bool inside = std::abs(u - 0.5) < 1.6 * v * (1.0 - v);
      const double alpha = !inside ? 0.0 : x == width / 2 ? 0.5 : 1.0;
      for (std::uint32_t c = 0; c + 1 < channels; ++c) put(0.3 * (c + 1) * u);
      put(alpha);
    }
  }
  return std::make_shared<const Texture>("leaf", std::move(texels), color, pool);
}

}  // namespace komorebi::testing
