#include "texture/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/srgb.h"
#include "texture/convert.h"
#include "texture/interpolate.h"
#include "texture/levels.h"
#include "texture/texel_reader.h"

namespace komorebi {
namespace {

const Vec4 kMagenta(1.0f, 0.0f, 1.0f, 1.0f);

constexpr std::uint32_t kMaxSide = 1u << 17;

std::uint32_t side_at(std::uint32_t side, std::uint32_t level) {
  for (std::uint32_t i = 0; i < level; ++i) side = coarser_side(side);
  return side;
}

/// How often a side of `texels` may be halved for texels no larger than `width` of 1.
std::uint32_t level_of(float width, std::uint32_t texels) {
  const float size = width * static_cast<float>(texels);
  if (!(size >= 2.0f)) return 0;  // a NaN too
  return (std::bit_cast<std::uint32_t>(size) >> 23) - 127u;
}

}  // namespace

Texture::Texture(std::string name, Texels texels, const TextureColor& color, ThreadPool& pool,
                 const TextureLevels& kept, const Cancel& cancel)
    : name_(std::move(name)), srgb_(color.srgb && !color.has_matrix), data_(color.data) {
  const bool fits = texels.width > 0 && texels.height > 0 && texels.width <= kMaxSide &&
                    texels.height <= kMaxSide && (texels.channels == 1 || texels.channels == 4) &&
                    texels.data != nullptr;
  if (!fits) {
    throw std::invalid_argument("texture \"" + name_ + "\": cannot be " +
                                std::to_string(texels.width) + " × " +
                                std::to_string(texels.height) + " texels");
  }
  nonfinite_ = clean_texels(texels, pool, cancel);
  cancel.check();
  if (color.has_matrix) texels = convert_texels(std::move(texels), color, pool, cancel);
  cancel.check();
  channels_ = texels.channels;
  type_ = texels.type;
  levels_.push_back({texels.data.get(), texels.width, texels.height});
  finest_ = std::move(texels.data);
  if (kept.coarser || kept.skip > 0) add_levels(pool, kept.skip, cancel);
  if (!kept.coarser) keep_first_level();
}

Texture::Texture(std::string name, std::vector<Tile> tiles)
    : name_(std::move(name)), tiles_(std::move(tiles)) {
  if (tiles_.empty()) throw std::invalid_argument("texture \"" + name_ + "\": has no tiles");
  for (const auto& [number, tile] : tiles_) {
    if (!tile || !tile->tiles_.empty()) {
      throw std::invalid_argument("texture \"" + name_ + "\": tile " + std::to_string(number) +
                                  " is no picture");
    }
  }
  std::stable_sort(tiles_.begin(), tiles_.end(),
                   [](const Tile& a, const Tile& b) { return a.first < b.first; });
}

std::shared_ptr<const Texture> Texture::missing(std::string name) {
  Texels texels;
  texels.width = texels.height = 1;
  texels.channels = 4;
  texels.data.reset(new std::byte[4]{std::byte{255}, {}, std::byte{255}, std::byte{255}});
  ThreadPool pool(1);
  return std::make_shared<const Texture>(std::move(name), std::move(texels), TextureColor(), pool);
}

void Texture::add_levels(ThreadPool& pool, std::uint32_t skip, const Cancel& cancel) {
  const std::size_t texel = channels_ * texel_bytes(type_);
  std::vector<std::size_t> offset;
  std::size_t room = 0;
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level level = {nullptr, coarser_side(levels_.back().width),
                         coarser_side(levels_.back().height)};
    levels_.push_back(level);
    offset.push_back(room);
    room += (texel * level.width * level.height + 15) / 16 * 16;
  }
  skip = std::min(skip, static_cast<std::uint32_t>(levels_.size() - 1));
  coarser_.resize(room);
  LevelShape shape = {type_, channels_, srgb_, !data_, true};
  for (std::size_t i = 1; i < levels_.size(); ++i) {
    std::byte* to = coarser_.data() + offset[i - 1];
    make_coarser(shape, levels_[i - 1].data, levels_[i - 1].width, levels_[i - 1].height, to, pool,
                 cancel);
    cancel.check();
    shape.finest = false;
    levels_[i].data = to;
  }
  if (skip == 0) return;
  finest_.reset();
  levels_.erase(levels_.begin(), levels_.begin() + skip);
  const std::size_t first = offset[skip - 1];
  Array<std::byte> kept(room - first);
  std::copy(coarser_.begin() + static_cast<std::ptrdiff_t>(first), coarser_.end(), kept.begin());
  coarser_ = std::move(kept);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    levels_[i].data = coarser_.data() + (offset[skip - 1 + i] - first);
  }
}

void Texture::keep_first_level() {
  levels_.resize(1);
  if (finest_) return;
  const Level& first = levels_[0];
  Array<std::byte> kept(std::size_t{first.width} * first.height * channels_ * texel_bytes(type_));
  std::copy_n(coarser_.begin(), kept.size(), kept.begin());
  coarser_ = std::move(kept);
  levels_[0].data = coarser_.data();
}

Vec4 Texture::lookup(const TextureSampling& how, float u, float v, float footprint) const {
  if (!tiles_.empty()) {
    // Truncated, so that what is a little below 0 belongs to the first tile: as in Cycles.
    if (!(u > -1.0f && u < 10.0f && v > -1.0f && v < 900.0f)) return kMagenta;
    const auto column = static_cast<std::int32_t>(u), row = static_cast<std::int32_t>(v);
    const auto number = static_cast<std::uint32_t>(1001 + 10 * row + column);
    const auto at =
        std::lower_bound(tiles_.begin(), tiles_.end(), number,
                         [](const Tile& tile, std::uint32_t n) { return tile.first < n; });
    if (at == tiles_.end() || at->first != number) return kMagenta;
    return at->second->lookup(how, u - static_cast<float>(column), v - static_cast<float>(row),
                              footprint);
  }
  const std::uint32_t wanted =
      footprint > 0.0f ? level_of(footprint, std::min(levels_[0].width, levels_[0].height)) : 0;
  const Level& level = levels_[std::min<std::size_t>(wanted, levels_.size() - 1)];
  TextureSampling taken = how;
  if (wanted > 0) taken.interpolation = Interpolation::kClosest;
  Vec4 value = with_reader(type_, channels_, level.data, level.width, level.height,
                           [&](const auto& texel) { return look_up(texel, taken, u, v); });
  if (channels_ == 1) value.w = 1.0f;
  const float alpha = value.w;
  if (how.straight && !data_ && alpha != 1.0f && alpha != 0.0f) {
    value = Vec4(value.x / alpha, value.y / alpha, value.z / alpha, alpha);
  }
  if (srgb_) {
    value = Vec4(srgb_to_linear(value.x), srgb_to_linear(value.y), srgb_to_linear(value.z), alpha);
  }
  return value;
}

std::size_t Texture::byte_count() const {
  std::size_t sum = coarser_.size();
  if (finest_) {
    sum += std::size_t{levels_[0].width} * levels_[0].height * channels_ * texel_bytes(type_);
  }
  for (const auto& [number, tile] : tiles_) sum += tile->byte_count();
  return sum;
}

std::uint64_t Texture::nonfinite_texels() const {
  std::uint64_t sum = nonfinite_;
  for (const auto& [number, tile] : tiles_) sum += tile->nonfinite_texels();
  return sum;
}

std::size_t Texture::byte_count(const Texels& header, const TextureColor& color,
                                const TextureLevels& kept) {
  const TexelType type = color.has_matrix ? converted_type(header.type) : header.type;
  const std::size_t texel = header.channels * texel_bytes(type);
  std::size_t sum = 0;
  for (std::uint32_t level = kept.skip;; ++level) {
    const std::size_t width = side_at(header.width, level), height = side_at(header.height, level);
    sum += texel * width * height;
    if (!kept.coarser || (width == 1 && height == 1)) return sum;
  }
}

}  // namespace komorebi
