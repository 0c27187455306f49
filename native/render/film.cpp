#include "render/film.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "core/motion_vector.h"

namespace komorebi {
namespace {

/// Bits that the number of samples may take of a sum's 62. Two fixed sizes, so that parts of one
/// render (sample ranges) nearly always share a scale and can be added exactly.
int sample_bits(const Settings& s) {
  return s.sample_offset + s.samples <= kManySamples ? 16 : 24;
}

/// The largest power of two that keeps 32 · bound · scale within `bits` bits.
double power_of_two_scale(double bound, int bits) {
  int exponent = 0;
  std::frexp(std::max(bound, 1e-30), &exponent);  // bound < 2^exponent
  return std::ldexp(1.0, bits - 5 - exponent);
}

/// A thirty-second of what a channel of a quantity may come to.
double bound_of(Quantity q, std::uint32_t channel, double radiance, double value) {
  switch (q) {
    case Quantity::kEnvironment:
    case Quantity::kEmission:
    case Quantity::kCatcherLight:
      return radiance;
    case Quantity::kMatte:
      return channel < 3 ? radiance : 1.0;
    case Quantity::kMaterialValue:
      return value;
    case Quantity::kUv:
      return 2047.0;
    case Quantity::kVector:
      return kMaxMotionVector / 32.0;
    case Quantity::kDenoisingDepth:
      return 2097151.0;  // 67,000 km, to a thousandth of a millimetre
    default:
      return 1.0;
  }
}

}  // namespace

Film::Film(const Rect& region, const Settings& settings, float max_radiance, bool catchers,
           float max_value)
    : region_(region),
      first_sample_(settings.sample_offset),
      samples_(settings.samples),
      layout_(make_pass_layout(settings.passes, catchers, settings.film_transparent)),
      catchers_(catchers),
      transparent_(settings.film_transparent),
      shows_shadow_(std::find(settings.passes.begin(), settings.passes.end(), "Shadow Catcher") ==
                    settings.passes.end()),
      cells_across_((region.x_max - 1) / kCellSize - region.x_min / kCellSize + 1),
      bands_((region.y_max - 1) / kCellSize - region.y_min / kCellSize + 1),
      combined_(4 * region.area()),
      means_(layout_.means * region.area()),
      firsts_(layout_.firsts * region.area()),
      squares_(layout_.keeps_variance ? 9 * region.area() : 0),
      counts_(bands_.size() * cells_across_, 0) {
  const int bits = 62 - sample_bits(settings);
  // Ambient occlusion is radiance under a sky of 1, whatever the world behind it.
  const double radiance = std::max(1.0, double{max_radiance}) * bounce_gain(settings);
  radiance_scale_ = power_of_two_scale(radiance, bits);
  unit_scale_ = power_of_two_scale(1.0, bits);
  limit_ = std::ldexp(1.0, bits);
  half_bits_ = bits / 2;
  mean_scale_.resize(layout_.means);
  for (std::size_t q = 0; q < kQuantities; ++q) {
    const auto quantity = static_cast<Quantity>(q);
    const std::int16_t place = layout_.place[q];
    if (place == PassLayout::kNone || place >= layout_.means) continue;
    for (std::uint32_t c = 0; c < layout_.channels_of(quantity); ++c) {
      mean_scale_[static_cast<std::size_t>(place) + c] =
          power_of_two_scale(bound_of(quantity, c, radiance, double{max_value}), bits);
    }
  }
  for (std::size_t k = 0; k < layout_.ids; ++k) mattes_[k].resize(counts_.size());
}

void Film::reset(TileSums& sums, std::size_t pixels) const {
  sums.combined.assign(4 * pixels, 0);
  sums.means.assign(layout_.means * pixels, 0);
  sums.firsts.assign(layout_.firsts * pixels, 0.0f);
  sums.squares.assign(layout_.keeps_variance ? 9 * pixels : 0, 0);
  for (std::size_t k = 0; k < layout_.ids; ++k) sums.mattes[k].reset(pixels);
  sums.has_first = false;
  sums.samples = 0;
  sums.clamped = 0;
}

void Film::add_squares(const std::int64_t* quantised, std::uint64_t* sums) const {
  const std::uint64_t low_bits = (std::uint64_t{1} << half_bits_) - 1;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto q = static_cast<std::uint64_t>(std::abs(quantised[c]));
    const std::uint64_t a = q >> half_bits_, b = q & low_bits;
    sums[3 * c] += a * a;
    sums[3 * c + 1] += a * b;
    sums[3 * c + 2] += b * b;
  }
}

void Film::merge(Cells cells, const TileSums& sums) {
  std::size_t from = 0;
  std::uint64_t clamped = sums.clamped;
  for (const Rect& c : cells) {
    Band& b = bands_[band(c.y_min)];
    const std::lock_guard lock(b.mutex);
    b.clamped += std::exchange(clamped, 0);
    const std::size_t this_cell = cell(c.x_min, c.y_min);
    counts_[this_cell] += sums.samples;
    for (std::uint32_t y = c.y_min; y < c.y_max; ++y, from += c.width()) {
      const std::size_t to = index(c.x_min, y);
      const auto add = [&](auto& film, const auto& tile, std::size_t channels) {
        for (std::size_t i = 0; i < channels * c.width(); ++i) {
          film[channels * to + i] += tile[channels * from + i];
        }
      };
      add(combined_, sums.combined, 4);
      add(means_, sums.means, layout_.means);
      if (layout_.keeps_variance) add(squares_, sums.squares, 9);
      if (sums.has_first) {
        std::copy_n(&sums.firsts[layout_.firsts * from], layout_.firsts * c.width(),
                    &firsts_[layout_.firsts * to]);
      }
      for (std::size_t k = 0; k < layout_.ids; ++k) {
        for (std::uint32_t x = 0; x < c.width(); ++x) {
          mattes_[k][this_cell].add(pixel_in_cell(c.x_min + x, y), sums.mattes[k].of(from + x));
        }
      }
    }
  }
}

void Film::cell_means(const Rect& c, float* out) const {
  const std::lock_guard lock(bands_[band(c.y_min)].mutex);
  const double n = counts_[cell(c.x_min, c.y_min)];
  const double radiance = 1.0 / (radiance_scale_ * n), unit = 1.0 / (unit_scale_ * n);
  for (std::uint32_t y = c.y_min; y < c.y_max; ++y) {
    const std::int64_t* sum = &combined_[4 * index(c.x_min, y)];
    for (std::uint32_t i = 0; i < c.width(); ++i, sum += 4, out += 4) {
      for (int k = 0; k < 3; ++k) {
        out[k] = static_cast<float>(static_cast<double>(sum[k]) * radiance);
      }
      out[3] = static_cast<float>(static_cast<double>(sum[3]) * unit);
    }
  }
}

std::uint64_t Film::clamped_samples() const {
  std::uint64_t clamped = 0;
  for (const Band& b : bands_) {
    const std::lock_guard lock(b.mutex);
    clamped += b.clamped;
  }
  return clamped;
}

std::size_t Film::bytes_per_pixel(const std::vector<std::string>& passes) {
  constexpr std::size_t kMatteBytes = 24;  // two ids
  const PassLayout layout = make_pass_layout(passes, false, false);
  return (4 + layout.means) * sizeof(std::int64_t) + layout.firsts * sizeof(float) +
         (layout.keeps_variance ? 9 * sizeof(std::uint64_t) : 0) + layout.ids * kMatteBytes;
}

std::size_t Film::byte_count() const {
  std::size_t mattes = 0;
  for (const auto& cells : mattes_) {
    for (const MatteCell& c : cells) mattes += sizeof(MatteCell) + c.byte_count();
  }
  return (combined_.size() + means_.size()) * sizeof(std::int64_t) +
         squares_.size() * sizeof(std::uint64_t) + firsts_.size() * sizeof(float) +
         counts_.size() * sizeof(std::uint32_t) + bands_.size() * sizeof(Band) + mattes;
}

}  // namespace komorebi
