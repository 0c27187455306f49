#include "texture/convert.h"

#include <atomic>
#include <bit>
#include <utility>

#include "core/srgb.h"
#include "texture/texel_reader.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 16;  // texels

bool not_finite(StoredHalf value) {
  return (value.bits & 0x7c00u) == 0x7c00u;
}
bool not_finite(float value) {
  return (std::bit_cast<std::uint32_t>(value) & 0x7f800000u) == 0x7f800000u;
}

template <class T>
std::uint64_t clean(T* texels, std::size_t count, std::uint32_t channels, ThreadPool& pool,
                    const Cancel& cancel) {
  std::atomic<std::uint64_t> found = 0;
  pool.for_each_chunk(count, kGrain, [&](std::size_t first, std::size_t last) {
    if (cancel.raised()) return;
    std::uint64_t bad = 0;
    for (T* p = texels + first * channels; p < texels + last * channels; p += channels) {
      bool any = false;
      for (std::uint32_t c = 0; c < channels; ++c) any |= not_finite(p[c]);
      if (!any) continue;
      for (std::uint32_t c = 0; c < channels; ++c) p[c] = T{};
      ++bad;
    }
    found += bad;
  });
  return found;
}

Vec4 converted(Vec4 stored, const TextureColor& color) {
  const float alpha = stored.w;
  const bool divide = !color.data && alpha > 0.0f && alpha != 1.0f;
  for (int c = 0; c < 3; ++c) {
    if (divide) stored[c] /= alpha;
    if (color.srgb) stored[c] = srgb_to_linear(stored[c]);
  }
  const float* m = color.matrix.data();
  Vec4 out(0.0f, 0.0f, 0.0f, alpha);
  for (int r = 0; r < 3; ++r, m += 3) {
    out[r] = m[0] * stored.x + m[1] * stored.y + m[2] * stored.z;
    if (divide) out[r] *= alpha;
  }
  return out;
}

template <class Reader, class T>
void convert(const Reader& texel, T* out, std::uint32_t channels, const TextureColor& color,
             ThreadPool& pool, const Cancel& cancel) {
  const auto width = static_cast<std::size_t>(texel.width);
  const auto rows = static_cast<std::size_t>(texel.height);
  pool.for_each_chunk(rows, 1 + kGrain / width, [&](std::size_t first, std::size_t last) {
    if (cancel.raised()) return;
    T* p = out + first * width * channels;
    for (std::size_t y = first; y < last; ++y) {
      for (std::size_t x = 0; x < width; ++x, p += channels) {
        const Vec4 value =
            converted(texel(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)), color);
        if (channels == 1) {
          p[0] = store<T>((value.x + value.y + value.z) * (1.0f / 3.0f));
        } else {
          for (int c = 0; c < 4; ++c) p[c] = store<T>(value[c]);
        }
      }
    }
  });
}

}  // namespace

std::uint64_t clean_texels(Texels& texels, ThreadPool& pool, const Cancel& cancel) {
  const std::size_t count = std::size_t{texels.width} * texels.height;
  if (texels.type == TexelType::kHalf) {
    return clean(reinterpret_cast<StoredHalf*>(texels.data.get()), count, texels.channels, pool,
                 cancel);
  }
  if (texels.type == TexelType::kFloat) {
    return clean(reinterpret_cast<float*>(texels.data.get()), count, texels.channels, pool, cancel);
  }
  return 0;
}

Texels convert_texels(Texels texels, const TextureColor& color, ThreadPool& pool,
                      const Cancel& cancel) {
  Texels out;
  out.width = texels.width;
  out.height = texels.height;
  out.channels = texels.channels;
  out.type = converted_type(texels.type);
  out.data.reset(new std::byte[out.byte_count()]);
  with_reader(texels.type, texels.channels, texels.data.get(), texels.width, texels.height,
              [&](const auto& texel) {
                if (out.type == TexelType::kFloat) {
                  convert(texel, reinterpret_cast<float*>(out.data.get()), out.channels, color,
                          pool, cancel);
                } else {
                  convert(texel, reinterpret_cast<StoredHalf*>(out.data.get()), out.channels, color,
                          pool, cancel);
                }
              });
  return out;
}

}  // namespace komorebi
