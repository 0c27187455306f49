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

/// The sRGB curve from 0 to 1, nearest of many values: within 3e-4, a seventh of a byte's step, and
/// errors of a texel's points cancel out.
class QuickCurve {
 public:
  QuickCurve() {
    for (int i = 0; i <= kSteps; ++i) at_[i] = srgb_to_linear(static_cast<float>(i) / kSteps);
  }
  float operator()(float encoded) const {
    if (!(encoded >= 0.0f && encoded <= 1.0f)) return srgb_to_linear(encoded);
    return at_[static_cast<std::int32_t>(encoded * kSteps + 0.5f)];
  }

 private:
  static constexpr int kSteps = 4080;  // of 255: what bytes hold is exact
  float at_[kSteps + 1];
};

/// Light times alpha, and alpha.
template <class Curve>
Vec4 decoded(Vec4 stored, const LevelShape& shape, const Curve& linear) {
  const float alpha = stored.w;
  const bool divide = shape.weighed && alpha > 0.0f && alpha != 1.0f;
  for (int c = 0; c < 3; ++c) {
    stored[c] = divide ? linear(stored[c] / alpha) * alpha : linear(stored[c]);
  }
  return stored;
}

/// The light of a picture's texels, row by row.
template <class Reader>
class LightRows {
 public:
  LightRows(const LevelShape& shape, const Reader& texel) : shape_(shape), texel_(texel) {
    for (auto& row : rows_) row.resize(static_cast<std::size_t>(texel.width));
    light_.resize(rows_[0].size());
  }

  const Vec4* row(std::uint32_t y) {
    static const QuickCurve kQuick;
    const bool quick = shape_.type == TexelType::kByte;
    quick ? fill(static_cast<std::int32_t>(y), kQuick)
          : fill(static_cast<std::int32_t>(y), srgb_to_linear);
    return light_.data();
  }

 private:
  static constexpr float kOther = 0.21132487f;  // (1 − 1/√3) / 2

  template <class Curve>
  void fill(std::int32_t y, const Curve& linear) {
    const std::int32_t width = texel_.width;
    if (!shape_.srgb || !shape_.finest) {
      for (std::int32_t x = 0; x < width; ++x) {
        const Vec4 stored = texel_(x, y);
        light_[static_cast<std::size_t>(x)] =
            shape_.srgb ? decoded(stored, shape_, linear) : stored;
      }
      return;
    }
    // The mean of the light within each texel of what is interpolated as stored, by Gauss's two
    // points from centre to centre along each side.
    const std::int32_t beside[] = {y > 0 ? y - 1 : 0, y + 1 < texel_.height ? y + 1 : y};
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::int32_t x = 0; x < width; ++x) {
        const Vec4 own = texel_(x, y);
        rows_[k][static_cast<std::size_t>(x)] = own + kOther * (texel_(x, beside[k]) - own);
      }
    }
    for (std::size_t x = 0; x < light_.size(); ++x) {
      const std::size_t left = x > 0 ? x - 1 : 0, right = x + 1 < light_.size() ? x + 1 : x;
      Vec4 sum(0.0f);
      for (const auto& row : rows_) {
        sum += decoded(row[x] + kOther * (row[left] - row[x]), shape_, linear);
        sum += decoded(row[x] + kOther * (row[right] - row[x]), shape_, linear);
      }
      light_[x] = 0.25f * sum;
    }
  }

  const LevelShape& shape_;
  const Reader& texel_;
  std::vector<Vec4> rows_[2], light_;
};

Vec4 encoded(Vec4 light, const LevelShape& shape) {
  if (!shape.srgb) return light;
  const float alpha = light.w;
  const bool divide = shape.weighed && alpha > 0.0f && alpha != 1.0f;
  for (int c = 0; c < 3; ++c) {
    light[c] = divide ? linear_to_srgb(light[c] / alpha) * alpha : linear_to_srgb(light[c]);
  }
  return light;
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
      const Vec4 sum = encoded(light_sum, shape);
      for (unsigned k = 0; k < kChannels; ++k) *out++ = store<T>(sum[static_cast<int>(k)]);
    }
  }
}

}  // namespace

void make_coarser(const LevelShape& shape, const std::byte* from, std::uint32_t width,
                  std::uint32_t height, std::byte* to, ThreadPool& pool) {
  with_reader(shape.type, shape.channels, from, width, height, [&](const auto& texel) {
    const std::size_t grain = 1 + (std::size_t{1} << 14) / width;
    pool.for_each_chunk(coarser_side(height), grain, [&](std::size_t first, std::size_t last) {
      make_rows(shape, texel, to, static_cast<std::uint32_t>(first),
                static_cast<std::uint32_t>(last));
    });
  });
}

}  // namespace komorebi
