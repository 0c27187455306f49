#pragma once

#include <cstddef>
#include <cstdint>

#include "core/half.h"
#include "core/vector.h"
#include "io/texels.h"

namespace komorebi {

/// A stored number as light or as a share.
inline float stored_value(std::uint8_t value) {
  return static_cast<float>(value) * (1.0f / 255.0f);
}
inline float stored_value(std::uint16_t value) {
  return static_cast<float>(value) * (1.0f / 65535.0f);
}
inline float stored_value(float value) {
  return value;
}

/// A half float among texels; a number of its own kind beside the shorts.
struct StoredHalf {
  std::uint16_t bits;
};
inline float stored_value(StoredHalf value) {
  return float_from_half(value.bits);
}

/// The stored number next to a value; of halves and floats the value itself.
template <class T>
T store(float value);
template <>
inline std::uint8_t store(float value) {
  const float x = value * 255.0f + 0.5f;
  return x >= 255.0f ? std::uint8_t{255} : x > 0.0f ? static_cast<std::uint8_t>(x) : std::uint8_t{};
}
template <>
inline std::uint16_t store(float value) {
  const float x = value * 65535.0f + 0.5f;
  return x >= 65535.0f ? std::uint16_t{65535}
         : x > 0.0f    ? static_cast<std::uint16_t>(x)
                       : std::uint16_t{};
}
template <>
inline StoredHalf store(float value) {
  return {half_from_float(value)};
}
template <>
inline float store(float value) {
  return value;
}

/// Texel (x, y) of an array of one channel (grey, with alpha 1) or four.
template <class T, unsigned kChannels>
struct TexelReader {
  const T* data;
  std::int32_t width, height;

  Vec4 operator()(std::int32_t x, std::int32_t y) const {
    const T* p = data + kChannels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                     static_cast<std::size_t>(x));
    if constexpr (kChannels == 1) {
      const float grey = stored_value(p[0]);
      return Vec4(grey, grey, grey, 1.0f);
    } else {
      return Vec4(stored_value(p[0]), stored_value(p[1]), stored_value(p[2]), stored_value(p[3]));
    }
  }
  /// Nothing outside.
  Vec4 clipped(std::int32_t x, std::int32_t y) const {
    // of grey, Cycles' alpha is 1 outside too
    if (x < 0 || x >= width || y < 0 || y >= height) {
      return Vec4(0.0f, 0.0f, 0.0f, kChannels == 1 ? 1.0f : 0.0f);
    }
    return (*this)(x, y);
  }
  static Vec4 nothing() { return Vec4(0.0f, 0.0f, 0.0f, kChannels == 1 ? 1.0f : 0.0f); }
};

/// Calls f with a reader of what stands at `data`.
template <class F>
auto with_reader(TexelType type, std::uint32_t channels, const std::byte* data, std::uint32_t width,
                 std::uint32_t height, F f) {
  const auto w = static_cast<std::int32_t>(width), h = static_cast<std::int32_t>(height);
  const auto of = [&](auto* texels) {
    using T = std::remove_cvref_t<decltype(*texels)>;
    return channels == 1 ? f(TexelReader<T, 1>{texels, w, h}) : f(TexelReader<T, 4>{texels, w, h});
  };
  switch (type) {
    case TexelType::kByte:
      return of(reinterpret_cast<const std::uint8_t*>(data));
    case TexelType::kShort:
      return of(reinterpret_cast<const std::uint16_t*>(data));
    case TexelType::kHalf:
      return of(reinterpret_cast<const StoredHalf*>(data));
    default:
      return of(reinterpret_cast<const float*>(data));
  }
}

}  // namespace komorebi
