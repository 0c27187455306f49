// From the film's sums to floats.

#include <algorithm>
#include <cmath>
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

double clamped_to_unit(double x) {
  return std::clamp(x, 0.0, 1.0);
}

}  // namespace

Vec3d Film::mean(Quantity q, std::size_t i, double samples) const {
  const auto at = static_cast<std::size_t>(layout_.place[static_cast<std::size_t>(q)]);
  const std::int64_t* sums = &means_[layout_.means * i + at];
  Vec3d result(0.0);
  for (int c = 0; c < 3; ++c) {
    result[c] =
        static_cast<double>(sums[c]) / (mean_scale_[at + static_cast<std::size_t>(c)] * samples);
  }
  return result;
}

// As Cycles has it (intern/cycles/kernel/film/read.h, film_calculate_shadow_catcher): the light on
// the catchers by what it would be without other things, over white where the film is transparent.
Vec3d Film::catcher_shadow(std::size_t i, double samples) const {
  const Vec3d alone = mean(Quantity::kCatcherLight, i, samples);
  const Vec3d matte = mean(Quantity::kMatte, i, samples);
  const std::int64_t* combined = &combined_[4 * i];
  const double alpha = clamped_to_unit(static_cast<double>(combined[3]) / (unit_scale_ * samples));
  Vec3d shadow(1.0);
  for (int c = 0; c < 3; ++c) {
    const double all = static_cast<double>(combined[c]) / (radiance_scale_ * samples);
    if (alone[c] != 0.0) shadow[c] = (1.0 - alpha) + alpha * (all - matte[c]) / alone[c];
  }
  return shadow;
}

void Film::read_composed(std::size_t i, std::size_t count, double samples, float* out) const {
  const auto at =
      static_cast<std::size_t>(layout_.place[static_cast<std::size_t>(Quantity::kMatte)]);
  for (std::size_t end = i + count; i < end; ++i, out += 4) {
    Vec3d color = mean(Quantity::kMatte, i, samples);
    const std::int64_t coverage = means_[layout_.means * i + at + 3];
    double alpha = clamped_to_unit(static_cast<double>(coverage) / (mean_scale_[at + 3] * samples));
    if (shows_shadow_) {
      const Vec3d shadow = catcher_shadow(i, samples);
      const double darkness = 1.0 - clamped_to_unit((shadow.x + shadow.y + shadow.z) / 3.0);
      alpha += (1.0 - alpha) * darkness;
      if (!transparent_) {
        color += (1.0 - alpha) * mean(Quantity::kEnvironment, i, samples);
        alpha = 1.0;
      }
    }
    for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(color[c]);
    out[3] = static_cast<float>(alpha);
  }
}

void Film::read_variance(std::size_t i, std::size_t count, double samples, float* out) const {
  const double unit = std::ldexp(1.0, half_bits_);
  for (std::size_t end = i + count; i < end; ++i) {
    for (std::size_t c = 0; c < 3; ++c, ++out) {
      const std::uint64_t* s = &squares_[9 * i + 3 * c];
      const double squares =
          (static_cast<double>(s[0]) * unit + 2.0 * static_cast<double>(s[1])) * unit +
          static_cast<double>(s[2]);
      const auto sum = static_cast<double>(combined_[4 * i + c]);
      const double deviation = squares - sum * sum / samples;
      const double scale = radiance_scale_ * radiance_scale_ * std::max(samples - 1.0, 1.0);
      *out = static_cast<float>(std::max(deviation, 0.0) / scale);
    }
  }
}

void Film::read_mean_of_hits(const PassDesc& desc, std::size_t i, std::size_t count,
                             float* out) const {
  const auto place = [&](Quantity q) {
    return static_cast<std::size_t>(layout_.place[static_cast<std::size_t>(q)]);
  };
  const std::size_t at = place(desc.quantity), weight_at = place(Quantity::kVectorWeight);
  for (std::size_t end = i + count; i < end; ++i) {
    const std::int64_t* sums = &means_[layout_.means * i];
    const double hits = static_cast<double>(sums[weight_at]) / mean_scale_[weight_at];
    for (std::size_t c = at; c < at + desc.channels; ++c) {
      *out++ = static_cast<float>(
          hits > 0.0 ? static_cast<double>(sums[c]) / (mean_scale_[c] * hits) : 0.0);
    }
  }
}

void Film::read_run(const PassDesc& desc, std::uint32_t part, std::size_t i, std::uint32_t x,
                    std::uint32_t y, std::size_t count, float* out) const {
  const std::size_t this_cell = cell(x, y);
  const double seen = counts_[this_cell], n = std::max(seen, 1.0);
  const std::int16_t place = desc.quantity == Quantity::kCount
                                 ? std::int16_t{0}
                                 : layout_.place[static_cast<std::size_t>(desc.quantity)];
  const auto at =
      static_cast<std::size_t>(place) + (desc.quantity == Quantity::kMaterialValue ? part : 0);
  switch (desc.rule) {
    case PassRule::kCount:
      std::fill_n(out, count, static_cast<float>(seen / samples_));
      return;
    case PassRule::kVariance:
      read_variance(i, count, n, out);
      return;
    case PassRule::kFirstSample:
      for (std::size_t p = 0; p < count; ++p) {
        const float* from = &firsts_[layout_.firsts * (i + p) + at - layout_.means];
        std::copy_n(from, desc.channels, out + desc.channels * p);
      }
      return;
    case PassRule::kCatcher:
      for (std::size_t p = 0; p < count; ++p) {
        const Vec3d shadow = catchers_ ? catcher_shadow(i + p, n) : Vec3d(1.0);
        for (int c = 0; c < 3; ++c) *out++ = static_cast<float>(shadow[c]);
      }
      return;
    case PassRule::kMatte: {
      const auto& cells = mattes_[at - layout_.means - layout_.firsts];
      for (std::uint32_t p = 0; p < count; ++p) {
        cells[this_cell].read(pixel_in_cell(x + p, y), part, n, out + std::size_t{4} * p);
      }
      return;
    }
    case PassRule::kDirection:
      for (std::size_t p = 0; p < count; ++p) {
        const Vec3d sum = mean(desc.quantity, i + p, n);
        const double length = std::sqrt(glm::dot(sum, sum));
        for (int c = 0; c < 3; ++c)
          *out++ = static_cast<float>(length > 0.0 ? sum[c] / length : 0.0);
      }
      return;
    case PassRule::kMeanOfHits:
      read_mean_of_hits(desc, i, count, out);
      return;
    case PassRule::kMean:
      break;
  }
  if (desc.quantity == Quantity::kCount) {
    const double radiance = 1.0 / (radiance_scale_ * n), unit = 1.0 / (unit_scale_ * n);
    if (catchers_) return read_composed(i, count, n, out);
    return write_means<4>(&combined_[4 * i], count, {radiance, radiance, radiance, unit}, out);
  }
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t c = 0; c < desc.channels; ++c) {
      const auto sum = static_cast<double>(means_[layout_.means * (i + p) + at + c]);
      *out++ = static_cast<float>(sum * (1.0 / (mean_scale_[at + c] * n)));
    }
  }
}

void Film::read_band(const PassDesc& desc, std::uint32_t part, const Rect& rect, float* out) const {
  const std::lock_guard lock(bands_[band(rect.y_min)].mutex);
  for (std::uint32_t y = rect.y_min; y < rect.y_max; ++y) {
    for (std::uint32_t x = rect.x_min; x < rect.x_max;) {
      const std::uint32_t end = std::min((x / kCellSize + 1) * kCellSize, rect.x_max);
      read_run(desc, part, index(x, y), x, y, end - x, out);
      out += std::size_t{end - x} * desc.channels;
      x = end;
    }
  }
}

bool Film::holds(const PassDesc& desc) const {
  if (desc.rule == PassRule::kVariance) return layout_.keeps_variance;
  return desc.quantity == Quantity::kCount || layout_.keeps(desc.quantity);
}

void Film::read(const std::string& name, const Rect& rect, float* out) const {
  ThreadPool alone(1);
  read(name, rect, out, alone);
}

void Film::read(const std::string& name, const Rect& rect, float* out, ThreadPool& pool) const {
  const PassDesc& desc = find_pass(name);
  const std::uint32_t part = desc.rule == PassRule::kMatte               ? matte_part(name)
                             : desc.quantity == Quantity::kMaterialValue ? first_value(name)
                                                                         : 0;
  if (rect.x_min < region_.x_min || rect.y_min < region_.y_min || rect.x_max > region_.x_max ||
      rect.y_max > region_.y_max || rect.x_min > rect.x_max || rect.y_min > rect.y_max) {
    throw std::invalid_argument("the rectangle to read lies outside the film");
  }
  if (!holds(desc)) {
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
      read_band(desc, part, {rect.x_min, lo, rect.x_max, hi},
                out + std::size_t{lo - rect.y_min} * rect.width() * desc.channels);
    }
  });
}

}  // namespace komorebi
