// From the film's sums to floats.

#include <algorithm>
#include <stdexcept>

#include "render/film.h"

namespace komorebi {
namespace {

/// `count` sums, of which channel k of `channels` counts `scale[k]`, as means.
template <std::size_t kChannels>
void write_means(const std::int64_t* sums, std::size_t count, const double (&scale)[kChannels],
                 float* out) {
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < kChannels; ++k) {
      out[kChannels * i + k] =
          static_cast<float>(static_cast<double>(sums[kChannels * i + k]) * scale[k]);
    }
  }
}

}  // namespace

void Film::read_band(const PassDesc& desc, const Rect& rect, float* out) const {
  const std::lock_guard lock(bands_[band(rect.y_min)].mutex);
  for (std::uint32_t y = rect.y_min; y < rect.y_max; ++y) {
    for (std::uint32_t x = rect.x_min; x < rect.x_max;) {
      const std::uint32_t end = std::min((x / kCellSize + 1) * kCellSize, rect.x_max);
      const std::size_t i = index(x, y), count = end - x;
      const double n = counts_[cell(x, y)];
      const double unit = 1.0 / (unit_scale_ * std::max(n, 1.0));
      const double radiance = 1.0 / (radiance_scale_ * std::max(n, 1.0));
      if (desc.rule == PassRule::kCount) {
        std::fill_n(out, count, static_cast<float>(n / samples_));
      } else if (desc.rule == PassRule::kFirstSample) {
        std::copy_n(&depth_[i], count, out);
      } else if (desc.channels == 4) {
        write_means<4>(&combined_[4 * i], count, {radiance, radiance, radiance, unit}, out);
      } else {
        write_means<3>(&normal_[3 * i], count, {unit, unit, unit}, out);
      }
      out += count * desc.channels;
      x = end;
    }
  }
}

void Film::read(const std::string& name, const Rect& rect, float* out) const {
  ThreadPool alone(1);
  read(name, rect, out, alone);
}

void Film::read(const std::string& name, const Rect& rect, float* out, ThreadPool& pool) const {
  const PassDesc& desc = pass(name);
  if (rect.x_min < region_.x_min || rect.y_min < region_.y_min || rect.x_max > region_.x_max ||
      rect.y_max > region_.y_max || rect.x_min > rect.x_max || rect.y_min > rect.y_max) {
    throw std::invalid_argument("the rectangle to read lies outside the film");
  }
  if ((desc.rule == PassRule::kFirstSample && !keeps_depth_) ||
      (desc.rule == PassRule::kMean && desc.channels == 3 && !keeps_normal_)) {
    throw std::invalid_argument("the pass \"" + name + "\" is not among the settings' passes");
  }
  if (rect.area() == 0) return;
  const std::size_t bands = band(rect.y_max - 1) - band(rect.y_min) + 1;
  constexpr std::size_t kBandsAtOnce = 8;  // a few hundred kilobytes: less is not worth a thread
  pool.for_each_chunk(bands, kBandsAtOnce, [&](std::size_t begin, std::size_t end) {
    const std::uint32_t first = rect.y_min / kCellSize * kCellSize;
    for (std::size_t b = begin; b < end; ++b) {
      const auto lo = std::max(rect.y_min, first + static_cast<std::uint32_t>(b) * kCellSize);
      const auto hi = std::min(rect.y_max, first + static_cast<std::uint32_t>(b + 1) * kCellSize);
      read_band(desc, {rect.x_min, lo, rect.x_max, hi},
                out + std::size_t{lo - rect.y_min} * rect.width() * desc.channels);
    }
  });
}

}  // namespace komorebi
