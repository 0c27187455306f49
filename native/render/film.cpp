#include "render/film.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace komorebi {
namespace {

constexpr PassDesc kPasses[] = {
    {"Combined", 4, PassRule::kMean},
    {"Depth", 1, PassRule::kFirstSample},
    {"Normal", 3, PassRule::kMean},
};

/// Bits that the number of samples may take of a sum's 62. Two fixed sizes, so that parts of one
/// render (sample ranges) nearly always share a scale and can be added exactly.
int sample_bits(const Settings& s) {
  return s.sample_offset + s.samples <= (1u << 16) ? 16 : 24;
}

/// The largest power of two that keeps 32 · bound · scale within `bits` bits.
double power_of_two_scale(double bound, int bits) {
  int exponent = 0;
  std::frexp(std::max(bound, 1e-30), &exponent);  // bound < 2^exponent
  return std::ldexp(1.0, bits - 5 - exponent);
}

}  // namespace

std::span<const PassDesc> known_passes() {
  return kPasses;
}

void TileSums::reset(std::size_t pixels) {
  mean.assign(8 * pixels, 0);
  depth.assign(pixels, 0.0f);
  has_first = false;
  samples = 0;
  clamped = 0;
}

Film::Film(const Rect& region, const Settings& settings, float max_radiance)
    : region_(region), first_sample_(settings.sample_offset) {
  for (const std::string& name : settings.passes) pass(name);
  const int bits = 62 - sample_bits(settings);
  // Ambient occlusion is radiance under a sky of 1, whatever the world behind it.
  radiance_scale_ = power_of_two_scale(std::max(1.0, double{max_radiance}), bits);
  unit_scale_ = power_of_two_scale(1.0, bits);
  limit_ = std::int64_t{1} << bits;
  sums_.assign(kChannels * region.area(), 0);
  depth_.assign(region.area(), 0.0f);
  counts_.assign(region.area(), 0);
}

const PassDesc& Film::pass(const std::string& name) {
  for (const PassDesc& p : kPasses) {
    if (name == p.name) return p;
  }
  throw std::invalid_argument("there is no pass \"" + name + "\"");
}

std::int64_t Film::quantise(float value, double scale, std::uint64_t& clamped) const {
  const double scaled = double{value} * scale;  // exact: a power of two
  const auto limit = static_cast<double>(limit_);
  if (!(scaled >= -limit && scaled <= limit)) {  // NaN comes here too
    ++clamped;
    return scaled > limit ? limit_ : scaled < -limit ? -limit_ : 0;
  }
  return static_cast<std::int64_t>(std::nearbyint(scaled));
}

void Film::add(TileSums& tile, std::size_t pixel, std::uint32_t sample_index,
               const PixelSample& s) const {
  std::int64_t* sum = &tile.mean[kChannels * pixel];
  for (int c = 0; c < 3; ++c) {
    sum[c] += quantise(s.radiance[c], radiance_scale_, tile.clamped);
    sum[4 + c] += quantise(s.normal[c], unit_scale_, tile.clamped);
  }
  sum[3] += quantise(s.alpha, unit_scale_, tile.clamped);
  if (sample_index == first_sample_) {
    tile.depth[pixel] = s.depth;
    tile.has_first = true;
  }
}

void Film::merge(Cells cells, const TileSums& sums) {
  const std::lock_guard lock(mutex_);
  std::size_t from = 0;
  for (const Rect& cell : cells) {
    for (std::uint32_t y = cell.y_min; y < cell.y_max; ++y) {
      for (std::uint32_t x = cell.x_min; x < cell.x_max; ++x, ++from) {
        const std::size_t to = index(x, y);
        for (std::size_t c = 0; c < kChannels; ++c) {
          sums_[kChannels * to + c] += sums.mean[kChannels * from + c];
        }
        if (sums.has_first) depth_[to] = sums.depth[from];
        counts_[to] += sums.samples;
      }
    }
  }
  clamped_ += sums.clamped;
}

void Film::read(const std::string& name, const Rect& rect, float* out) const {
  const PassDesc& desc = pass(name);
  if (rect.x_min < region_.x_min || rect.y_min < region_.y_min || rect.x_max > region_.x_max ||
      rect.y_max > region_.y_max || rect.x_min > rect.x_max || rect.y_min > rect.y_max) {
    throw std::invalid_argument("the rectangle to read lies outside the film");
  }
  const std::size_t first_channel = desc.name == std::string("Normal") ? 4 : 0;
  const std::lock_guard lock(mutex_);
  for (std::uint32_t y = rect.y_min; y < rect.y_max; ++y) {
    for (std::uint32_t x = rect.x_min; x < rect.x_max; ++x) {
      const std::size_t i = index(x, y);
      if (desc.rule == PassRule::kFirstSample) {
        *out++ = depth_[i];
        continue;
      }
      for (std::size_t c = 0; c < desc.channels; ++c) {
        const std::size_t channel = first_channel + c;
        const double scale = channel < 3 ? radiance_scale_ : unit_scale_;
        const double n = std::max<std::uint32_t>(counts_[i], 1);
        *out++ =
            static_cast<float>(static_cast<double>(sums_[kChannels * i + channel]) / scale / n);
      }
    }
  }
}

std::uint64_t Film::clamped_samples() const {
  const std::lock_guard lock(mutex_);
  return clamped_;
}

std::size_t Film::byte_count() const {
  return sums_.capacity() * sizeof(std::int64_t) + depth_.capacity() * sizeof(float) +
         counts_.capacity() * sizeof(std::uint32_t);
}

}  // namespace komorebi
