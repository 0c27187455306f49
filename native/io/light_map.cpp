#include "io/light_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace komorebi {
namespace {

constexpr std::uint32_t kBlack = kLeastRgbeExponent << 24;
constexpr std::uint32_t kBandRows = 32;  ///< put in at a time

}  // namespace

LightMap::LightMap(std::string name, std::uint32_t width, std::uint32_t height)
    : name_(std::move(name)), width_(width), height_(height) {
  if (width == 0 || height == 0 || width > 1u << 20 || height > 1u << 20) {
    throw std::invalid_argument("environment \"" + name_ + "\": cannot be " +
                                std::to_string(width) + " × " + std::to_string(height) + " pixels");
  }
}

LightMap make_light_map(std::string name, std::uint32_t width, std::uint32_t height,
                        std::span<const float> texels, const Cancel& cancel) {
  LightMap map(std::move(name), width, height);
  if (texels.size() != 3 * map.texel_count()) {
    throw std::invalid_argument("environment \"" + map.name() +
                                "\": " + std::to_string(3 * map.texel_count()) +
                                " values expected, " + std::to_string(texels.size()) + " given");
  }
  std::vector<float> band;
  for (std::uint32_t row = 0; row < height; row += kBandRows) {
    cancel.check();
    const std::uint32_t rows = std::min(kBandRows, height - row);
    const auto part = texels.subspan(std::size_t{3} * width * row, std::size_t{3} * width * rows);
    band.assign(part.begin(), part.end());
    map.put(row, rows, band.data());
  }
  return map;
}

void LightMap::put(std::uint32_t first, std::uint32_t count, float* rgb) {
  const std::size_t texels = std::size_t{count} * width_;
  clean(rgb, texels);
  if (words_ == nullptr && floats_ == nullptr) begin(texels, rgb);
  while (!store(std::uint64_t{first} * width_, texels, rgb)) widen();
}

// A large map takes no room that its first texels show to be too narrow.
void LightMap::begin(std::size_t texels, const float* rgb) {
  std::uint32_t word = 0;
  bool rgbe = true, half = true;
  for (std::size_t i = 0; i < texels && rgbe; ++i) rgbe = exact_rgbe(rgb + 3 * i, &word);
  for (std::size_t i = 0; i < 3 * texels && !rgbe && half; ++i) {
    half = float_from_half(half_from_float(rgb[i])) == rgb[i];
  }
  const std::uint64_t count = texel_count();
  if (rgbe) {
    words_.reset(new std::uint32_t[count]);
    std::fill_n(words_.get(), count, kBlack);
  } else if (half) {
    storage_ = LightStorage::kHalf;
    words_.reset(new std::uint32_t[(3 * count + 1) / 2]());
  } else {
    storage_ = LightStorage::kFloat;
    floats_.reset(new float[3 * count]());
  }
}

void LightMap::clean(float* p, std::size_t texels) {
  for (const float* end = p + 3 * texels; p < end; p += 3) {
    if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))) {
      p[0] = p[1] = p[2] = 0.0f;
      ++nonfinite_;
    } else {
      if (p[0] < 0.0f || p[1] < 0.0f || p[2] < 0.0f) ++negative_;
      // −0 too: lanes read numbers without their sign.
      for (int c = 0; c < 3; ++c) p[c] = p[c] > 0.0f ? p[c] : 0.0f;
    }
    for (int c = 0; c < 3; ++c) max_radiance_ = p[c] > max_radiance_ ? p[c] : max_radiance_;
  }
}

bool LightMap::store(std::uint64_t first, std::size_t texels, const float* rgb) {
  switch (storage_) {
    case LightStorage::kRgbe:
      for (std::size_t i = 0; i < texels; ++i) {
        if (!exact_rgbe(rgb + 3 * i, &words_[first + i])) return false;
      }
      return true;
    case LightStorage::kHalf:
      for (std::size_t i = 0; i < 3 * texels; ++i) {
        const std::uint16_t half = half_from_float(rgb[i]);
        if (float_from_half(half) != rgb[i]) return false;
        const std::uint64_t at = 3 * first + i;
        const unsigned shift = 16u * (at & 1u);
        words_[at >> 1] = (words_[at >> 1] & ~(0xffffu << shift)) | std::uint32_t{half} << shift;
      }
      return true;
    default:
      std::copy_n(rgb, 3 * texels, floats_.get() + 3 * first);
      return true;
  }
}

// What was put in stays; a band that has failed half way is put in again.
void LightMap::widen() {
  const std::uint64_t count = texel_count();
  LightMap wider(name_, width_, height_);
  if (storage_ == LightStorage::kRgbe) {
    wider.storage_ = LightStorage::kHalf;
    wider.words_.reset(new std::uint32_t[(3 * count + 1) / 2]());
    bool exact = true;
    for (std::uint64_t i = 0; i < count && exact; ++i) {
      const Vec3 value = texel(i);
      exact = wider.store(i, 1, &value.x);
    }
    if (!exact) wider.storage_ = LightStorage::kFloat;
  } else {
    wider.storage_ = LightStorage::kFloat;
  }
  if (wider.storage_ == LightStorage::kFloat) {
    wider.words_.reset();
    wider.floats_.reset(new float[3 * count]);
    for (std::uint64_t i = 0; i < count; ++i) {
      const Vec3 value = texel(i);
      std::copy_n(&value.x, 3, wider.floats_.get() + 3 * i);
    }
  }
  storage_ = wider.storage_;
  words_ = std::move(wider.words_);
  floats_ = std::move(wider.floats_);
}

Vec3 LightMap::texel(std::uint64_t i) const {
  switch (storage_) {
    case LightStorage::kRgbe:
      return rgbe_texel(words_[i]);
    case LightStorage::kHalf:
      return Vec3(packed_half(words_.get(), 3 * i), packed_half(words_.get(), 3 * i + 1),
                  packed_half(words_.get(), 3 * i + 2));
    default:
      return Vec3(floats_[3 * i], floats_[3 * i + 1], floats_[3 * i + 2]);
  }
}

std::size_t LightMap::byte_count() const {
  const std::uint64_t count = texel_count();
  if (storage_ == LightStorage::kFloat) return 12 * count;
  return storage_ == LightStorage::kRgbe ? 4 * count : (3 * count + 1) / 2 * 4;
}

}  // namespace komorebi
