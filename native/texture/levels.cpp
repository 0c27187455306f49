#include "texture/levels.h"

#include <type_traits>

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

/// Light times alpha, and alpha.
Vec4 decoded(Vec4 stored, const LevelShape& shape) {
  if (!shape.srgb) return stored;
  const float alpha = stored.w;
  const bool divide = shape.weighed && alpha > 0.0f && alpha != 1.0f;
  for (int c = 0; c < 3; ++c) {
    stored[c] = divide ? srgb_to_linear(stored[c] / alpha) * alpha : srgb_to_linear(stored[c]);
  }
  return stored;
}
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
  for (std::uint32_t r = first; r < last; ++r) {
    const Cover rows = cover(r, height);
    for (std::uint32_t c = 0; c < columns; ++c, out += kChannels) {
      const Cover across = cover(c, width);
      Vec4 sum(0.0f);
      for (std::uint32_t y = 0; y < rows.count; ++y) {
        for (std::uint32_t x = 0; x < across.count; ++x) {
          const Vec4 stored = texel(static_cast<std::int32_t>(across.first + x),
                                    static_cast<std::int32_t>(rows.first + y));
          sum += rows.weight[y] * across.weight[x] * decoded(stored, shape);
        }
      }
      sum = encoded(sum, shape);
      for (unsigned k = 0; k < kChannels; ++k) out[k] = store<T>(sum[static_cast<int>(k)]);
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
