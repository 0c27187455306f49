#include "texture/levels.h"

#include <algorithm>
#include <type_traits>
#include <vector>

#include "core/srgb.h"
#include "texture/texel_reader.h"

namespace komorebi {
namespace {

/// Which texels of a side of n one of m = max(1, n / 2) covers, and by how much: two by halves, or
/// three of an odd number.
struct Cover {
  std::uint32_t first, count;
  float weight[3];
};
Cover cover(std::uint32_t i, std::uint32_t n) {
  if (n == 1) return {0, 1, {1.0f, 0.0f, 0.0f}};
  if (n % 2 == 0) return {2 * i, 2, {0.5f, 0.5f, 0.0f}};
  const std::uint32_t m = n / 2;
  const auto whole = static_cast<float>(n);
  return {2 * i,
          3,
          {static_cast<float>(m - i) / whole, static_cast<float>(m) / whole,
           static_cast<float>(i + 1) / whole}};
}

/// The sRGB curve from 0 to 1 and back, nearest of many values. Decoded light is within 3e-4, a
/// seventh of a byte's step, and errors of a texel's points cancel out; encoded are bytes.
struct QuickCurve {
  static constexpr int kSteps = 4080;  // of 255: what bytes hold is exact
  static constexpr int kLightSteps = 1 << 14;
  float light[kSteps + 1];
  std::uint8_t stored[kLightSteps + 1];

  QuickCurve() {
    for (int i = 0; i <= kSteps; ++i) light[i] = srgb_to_linear(static_cast<float>(i) / kSteps);
    for (int i = 0; i <= kLightSteps; ++i) {
      stored[i] = store<std::uint8_t>(linear_to_srgb(static_cast<float>(i) / kLightSteps));
    }
  }
  /// Of 0 to 1.
  float decoded(float encoded) const { return light[nearest(encoded * kSteps)]; }
  std::uint8_t encoded(float linear) const {
    return linear < 1.0f ? stored[nearest(linear * kLightSteps)] : 255;
  }
  static std::int32_t nearest(float x) {
    const float up = x + 0.5f;
    return static_cast<std::int32_t>(up);
  }
};

const QuickCurve& quick_curve() {
  static const QuickCurve kCurve;
  return kCurve;
}

bool is_divided(float alpha, const LevelShape& shape) {
  return shape.weighed && alpha > 0.0f && alpha != 1.0f;
}

/// Light times alpha, and alpha.
Vec4 decoded(Vec4 stored, const LevelShape& shape) {
  const float alpha = stored.w;
  const bool divide = is_divided(alpha, shape);
  for (int c = 0; c < 3; ++c) {
    stored[c] = divide ? srgb_to_linear(stored[c] / alpha) * alpha : srgb_to_linear(stored[c]);
  }
  return stored;
}
Vec4 encoded(Vec4 light, const LevelShape& shape) {
  const float alpha = light.w;
  const bool divide = is_divided(alpha, shape);
  for (int c = 0; c < 3; ++c) {
    light[c] = divide ? linear_to_srgb(light[c] / alpha) * alpha : linear_to_srgb(light[c]);
  }
  return light;
}

/// The light of a picture's texels, row by row.
template <class T, unsigned kChannels>
class LightRows {
 public:
  LightRows(const LevelShape& shape, const TexelReader<T, kChannels>& texel)
      : shape_(shape), texel_(texel), width_(static_cast<std::size_t>(texel.width)) {
    for (auto& row : rows_) row.resize(kChannels * width_);
    light_.resize(width_);
  }

  const Vec4* row(std::uint32_t row) {
    const auto y = static_cast<std::int32_t>(row);
    if (shape_.srgb && shape_.finest) {
      fill_between(y);
    } else {
      for (std::size_t x = 0; x < width_; ++x) {
        const Vec4 stored = texel_(static_cast<std::int32_t>(x), y);
        light_[x] = !shape_.srgb    ? stored
                    : quick(stored) ? quickly(stored)
                                    : decoded(stored, shape_);
      }
    }
    return light_.data();
  }

 private:
  static constexpr bool kBytes = std::is_same_v<T, std::uint8_t>;
  static constexpr float kOther = 0.21132487f;  // (1 − 1/√3) / 2

  bool quick(const Vec4& stored) const { return kBytes && !is_divided(stored.w, shape_); }
  static Vec4 quickly(const Vec4& stored) {
    const QuickCurve& curve = quick_curve();
    const float x = curve.decoded(stored.x);
    if constexpr (kChannels == 1) return Vec4(x, x, x, 1.0f);
    return Vec4(x, curve.decoded(stored.y), curve.decoded(stored.z), stored.w);
  }

  const T* stored(std::int32_t y) const {
    return texel_.data + kChannels * (static_cast<std::size_t>(y) * width_);
  }

  /// The mean of the light within each texel of what is interpolated as stored, by Gauss's two
  /// points from centre to centre along each side.
  void fill_between(std::int32_t y) {
    const std::int32_t beside[] = {y > 0 ? y - 1 : 0, y + 1 < texel_.height ? y + 1 : y};
    const T* own = stored(y);
    for (std::size_t k = 0; k < 2; ++k) {
      const T* other = stored(beside[k]);
      float* to = rows_[k].data();
      for (std::size_t i = 0; i < kChannels * width_; ++i) {
        const float value = stored_value(own[i]);
        to[i] = value + kOther * (stored_value(other[i]) - value);
      }
    }
    for (std::size_t x = 0; x < width_; ++x) {
      const std::size_t sides[] = {x > 0 ? x - 1 : 0, x + 1 < width_ ? x + 1 : x};
      Vec4 sum(0.0f);
      for (const auto& row : rows_) {
        const Vec4 here = at(row, x);
        for (const std::size_t side : sides) {
          const Vec4 place = here + kOther * (at(row, side) - here);
          sum += quick(place) ? quickly(place) : decoded(place, shape_);
        }
      }
      light_[x] = 0.25f * sum;
    }
  }
  static Vec4 at(const std::vector<float>& row, std::size_t x) {
    const float* p = &row[kChannels * x];
    if constexpr (kChannels == 1) return Vec4(p[0], p[0], p[0], 1.0f);
    return Vec4(p[0], p[1], p[2], p[3]);
  }

  const LevelShape& shape_;
  const TexelReader<T, kChannels>& texel_;
  std::size_t width_;
  std::vector<float> rows_[2];
  std::vector<Vec4> light_;
};

template <class T, unsigned kChannels>
void store_light(const Vec4& light, const LevelShape& shape, T* out) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    if (shape.srgb && !is_divided(light.w, shape)) {
      const QuickCurve& curve = quick_curve();
      for (unsigned k = 0; k < kChannels; ++k) {
        const float value = light[static_cast<int>(k)];
        out[k] = k < 3 ? curve.encoded(value) : store<T>(value);
      }
      return;
    }
  }
  const Vec4 sum = shape.srgb ? encoded(light, shape) : light;
  for (unsigned k = 0; k < kChannels; ++k) out[k] = store<T>(sum[static_cast<int>(k)]);
}

template <class T, unsigned kChannels>
void make_rows(const LevelShape& shape, const TexelReader<T, kChannels>& texel, std::byte* to,
               std::uint32_t first, std::uint32_t last) {
  const auto width = static_cast<std::uint32_t>(texel.width);
  const auto height = static_cast<std::uint32_t>(texel.height);
  const std::uint32_t columns = coarser_side(width);
  T* out = reinterpret_cast<T*>(to) + std::size_t{first} * columns * kChannels;
  LightRows light(shape, texel);
  std::vector<Vec4> sums(columns);
  for (std::uint32_t r = first; r < last; ++r) {
    const Cover rows = cover(r, height);
    std::fill(sums.begin(), sums.end(), Vec4(0.0f));
    for (std::uint32_t y = 0; y < rows.count; ++y) {
      const Vec4* row = light.row(rows.first + y);
      for (std::uint32_t c = 0; c < columns; ++c) {
        const Cover across = cover(c, width);
        for (std::uint32_t x = 0; x < across.count; ++x) {
          sums[c] += rows.weight[y] * across.weight[x] * row[across.first + x];
        }
      }
    }
    for (const Vec4& light_sum : sums) {
      store_light<T, kChannels>(light_sum, shape, out);
      out += kChannels;
    }
  }
}

}  // namespace

void make_coarser(const LevelShape& shape, const std::byte* from, std::uint32_t width,
                  std::uint32_t height, std::byte* to, ThreadPool& pool, const Cancel& cancel) {
  with_reader(shape.type, shape.channels, from, width, height, [&](const auto& texel) {
    const std::size_t grain = 1 + (std::size_t{1} << 14) / width;
    pool.for_each_chunk(coarser_side(height), grain, [&](std::size_t first, std::size_t last) {
      if (cancel.raised()) return;
      make_rows(shape, texel, to, static_cast<std::uint32_t>(first),
                static_cast<std::uint32_t>(last));
    });
  });
}

}  // namespace komorebi
