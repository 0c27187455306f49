#include "texture/texture_bounds.h"

#include <algorithm>

#include "core/srgb.h"
#include "parallel/thread_pool.h"
#include "texture/interpolate.h"
#include "texture/texel_reader.h"

namespace komorebi {
namespace {

constexpr std::int32_t kFirstShift = 3;  // of the finest blocks' side

// What weights that do not quite add up to 1, and roundings of sums, may do to a value between
// texels; a spline's sixteen terms are within 4e-6.
constexpr float kInterpolationError = 7.6e-6f;
constexpr float kCurveError = 4e-6f;  // of srgb_to_linear, either way

template <class F>
auto with_finest(const Texture& texture, F f) {
  return with_reader(texture.type(), texture.channels(), texture.finest_texels().data(),
                     texture.width(), texture.height(), f);
}

}  // namespace

void TextureBounds::Block::include(const Block& other) {
  lo = glm::min(lo, other.lo);
  hi = glm::max(hi, other.hi);
}

TextureBounds::TextureBounds(const Texture& texture, ThreadPool& pool)
    : texture_(texture),
      width_(static_cast<std::int32_t>(texture.width())),
      height_(static_cast<std::int32_t>(texture.height())) {
  if (width_ == 0) return;
  const auto halved = [](std::int32_t side) { return (side + 1) / 2; };
  constexpr std::int32_t kSide = 1 << kFirstShift;
  Level level{(width_ + kSide - 1) / kSide, (height_ + kSide - 1) / kSide, {}};
  level.blocks.resize(static_cast<std::size_t>(level.width) *
                      static_cast<std::size_t>(level.height));
  pool.for_each_chunk(static_cast<std::size_t>(level.height), 4, [&](std::size_t a, std::size_t b) {
    for (auto y = static_cast<std::int32_t>(a); y < static_cast<std::int32_t>(b); ++y) {
      for (std::int32_t x = 0; x < level.width; ++x) {
        level.blocks[static_cast<std::size_t>(y * level.width + x)] =
            extremes({x * kSide, std::min((x + 1) * kSide, width_) - 1},
                     {y * kSide, std::min((y + 1) * kSide, height_) - 1});
      }
    }
  });
  levels_.push_back(std::move(level));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& finer = levels_.back();
    Level next{halved(finer.width), halved(finer.height), {}};
    for (std::int32_t y = 0; y < next.height; ++y) {
      for (std::int32_t x = 0; x < next.width; ++x) {
        const auto at = [&](std::int32_t dx, std::int32_t dy) {
          const std::int32_t column = std::min(2 * x + dx, finer.width - 1);
          const std::int32_t row = std::min(2 * y + dy, finer.height - 1);
          return finer.blocks[static_cast<std::size_t>(row * finer.width + column)];
        };
        Block block = at(0, 0);
        block.include(at(1, 0));
        block.include(at(0, 1));
        block.include(at(1, 1));
        next.blocks.push_back(block);
      }
    }
    levels_.push_back(std::move(next));
  }
}

/// Texels that a look-up anywhere between two places along a side may read.
TextureBounds::Ranges TextureBounds::covered(const TextureSampling& how, const FloatRange& place,
                                             std::int32_t count) {
  const auto size = static_cast<float>(count);
  Range range{};
  if (how.interpolation == Interpolation::kClosest) {
    range = {texel_place(place.lo * size).texel, texel_place(place.hi * size).texel};
  } else {
    range = {texel_place(place.lo * size - 0.5f).texel,
             texel_place(place.hi * size - 0.5f).texel + 1};
    if (how.interpolation != Interpolation::kLinear) --range.first, ++range.last;
  }
  Ranges found;
  const auto add = [&](std::int32_t first, std::int32_t last) {
    found.part[found.count++] = {first, last};
  };
  switch (how.extension) {
    case Extension::kExtend:
    case Extension::kClip:
      found.outside = how.extension == Extension::kClip && (range.first < 0 || range.last >= count);
      add(std::clamp(range.first, 0, count - 1), std::clamp(range.last, 0, count - 1));
      break;
    case Extension::kRepeat: {
      const std::int32_t first = extended(how.extension, range.first, count);
      if (range.last - range.first >= count - 1) {
        add(0, count - 1);
      } else if (const std::int32_t last = first + (range.last - range.first); last < count) {
        add(first, last);
      } else {
        add(first, count - 1);
        add(0, last - count);
      }
      break;
    }
    default: {
      const std::int32_t first = extended(how.extension, range.first, count);
      const std::int32_t last = extended(how.extension, range.last, count);
      const auto period = [&](std::int32_t x) {
        return x >= 0 ? x / count : -((-x - 1) / count) - 1;
      };
      if (period(range.first) != period(range.last)) {
        add(0, count - 1);
      } else {
        add(std::min(first, last), std::max(first, last));
      }
    }
  }
  return found;
}

TextureBounds::Block TextureBounds::extremes(Range x, Range y) const {
  std::int32_t shift = 0;
  const std::int32_t side = std::max(x.last - x.first, y.last - y.first);
  if (side >= 16 && !levels_.empty()) {
    shift = kFirstShift;
    while (side >> shift > 8) ++shift;
    shift = std::min(shift, kFirstShift + static_cast<std::int32_t>(levels_.size()) - 1);
    x = {x.first >> shift, x.last >> shift};
    y = {y.first >> shift, y.last >> shift};
  }
  const auto over = [&](const auto& block_at) {
    Block all = block_at(x.first, y.first);
    for (std::int32_t row = y.first; row <= y.last; ++row) {
      for (std::int32_t column = x.first; column <= x.last; ++column) {
        all.include(block_at(column, row));
      }
    }
    return all;
  };
  if (shift > 0) {
    const Level& level = levels_[static_cast<std::size_t>(shift - kFirstShift)];
    return over([&](std::int32_t column, std::int32_t row) {
      return level.blocks[static_cast<std::size_t>(row * level.width + column)];
    });
  }
  return with_finest(texture_, [&](const auto& texel) {
    return over([&](std::int32_t column, std::int32_t row) {
      const Vec4 value = texel(column, row);
      return Block{value, value};
    });
  });
}

void TextureBounds::lookup(const TextureSampling& how, const FloatRange& u, const FloatRange& v,
                           FloatRange (&out)[4]) const {
  for (FloatRange& o : out) o = {};
  if (width_ == 0 || !u.known() || !v.known() || u.largest() > 1e3f || v.largest() > 1e3f) return;
  const Ranges x = covered(how, u, width_), y = covered(how, v, height_);
  Block all = extremes(x.part[0], y.part[0]);
  for (int i = 0; i < x.count; ++i) {
    for (int j = 0; j < y.count; ++j) all.include(extremes(x.part[i], y.part[j]));
  }
  if (x.outside || y.outside) {
    const Vec4 nothing(0.0f, 0.0f, 0.0f, texture_.channels() == 1 ? 1.0f : 0.0f);
    all.include({nothing, nothing});
  }
  for (int c = 0; c < 4; ++c) {
    FloatRange& value = out[c];
    value = {all.lo[c], all.hi[c]};
    if (how.interpolation != Interpolation::kClosest) {
      value = widened(value, kInterpolationError * value.largest());
    }
  }
  if (texture_.channels() == 1) out[3] = FloatRange::of(1.0f);
  const bool divided = how.straight && !texture_.is_data() && texture_.channels() != 1;
  for (int c = 0; c < 3; ++c) {
    FloatRange& value = out[c];
    if (divided && !(out[3].lo == 1.0f && out[3].hi == 1.0f)) value = {};
    if (!texture_.is_srgb() || !value.known()) continue;
    if (value.largest() > 1e9f) {
      value = {};
      continue;
    }
    const float low = srgb_to_linear(value.lo), high = srgb_to_linear(value.hi);
    value = {low - kCurveError * low, high + kCurveError * high};
  }
}

}  // namespace komorebi
