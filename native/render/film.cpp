#include "render/film.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace komorebi {
namespace {

constexpr PassDesc kPasses[] = {
    {"Combined", 4, PassRule::kMean},
    {"Depth", 1, PassRule::kFirstSample},
    {"Normal", 3, PassRule::kMean},
    {"Debug Sample Count", 1, PassRule::kCount},
};

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

bool asks_for(const Settings& settings, const char* name) {
  return std::find(settings.passes.begin(), settings.passes.end(), name) != settings.passes.end();
}

}  // namespace

std::span<const PassDesc> known_passes() {
  return kPasses;
}

const PassDesc& Film::pass(const std::string& name) {
  for (const PassDesc& p : kPasses) {
    if (name == p.name) return p;
  }
  throw std::invalid_argument("there is no pass \"" + name + "\"");
}

Film::Film(const Rect& region, const Settings& settings, float max_radiance)
    : region_(region),
      first_sample_(settings.sample_offset),
      samples_(settings.samples),
      keeps_normal_(asks_for(settings, "Normal")),
      keeps_depth_(asks_for(settings, "Depth")),
      cells_across_((region.x_max - 1) / kCellSize - region.x_min / kCellSize + 1),
      bands_((region.y_max - 1) / kCellSize - region.y_min / kCellSize + 1),
      combined_(4 * region.area()),
      normal_(keeps_normal_ ? 3 * region.area() : 0),
      depth_(keeps_depth_ ? region.area() : 0),
      counts_(bands_.size() * cells_across_, 0) {
  for (const std::string& name : settings.passes) pass(name);
  const int bits = 62 - sample_bits(settings);
  // Ambient occlusion is radiance under a sky of 1, whatever the world behind it.
  radiance_scale_ = power_of_two_scale(std::max(1.0, double{max_radiance}), bits);
  unit_scale_ = power_of_two_scale(1.0, bits);
  limit_ = std::ldexp(1.0, bits);
}

void Film::reset(TileSums& sums, std::size_t pixels) const {
  sums.combined.assign(4 * pixels, 0);
  sums.normal.assign(keeps_normal_ ? 3 * pixels : 0, 0);
  sums.depth.assign(keeps_depth_ ? pixels : 0, 0.0f);
  sums.has_first = false;
  sums.samples = 0;
  sums.clamped = 0;
}

void Film::merge(Cells cells, const TileSums& sums) {
  std::size_t from = 0;
  std::uint64_t clamped = sums.clamped;
  for (const Rect& c : cells) {
    Band& b = bands_[band(c.y_min)];
    const std::lock_guard lock(b.mutex);
    b.clamped += std::exchange(clamped, 0);
    counts_[cell(c.x_min, c.y_min)] += sums.samples;
    for (std::uint32_t y = c.y_min; y < c.y_max; ++y, from += c.width()) {
      const std::size_t to = index(c.x_min, y);
      for (std::size_t i = 0; i < 4 * c.width(); ++i) {
        combined_[4 * to + i] += sums.combined[4 * from + i];
      }
      if (keeps_normal_) {
        for (std::size_t i = 0; i < 3 * c.width(); ++i) {
          normal_[3 * to + i] += sums.normal[3 * from + i];
        }
      }
      if (sums.has_first) std::copy_n(&sums.depth[from], c.width(), &depth_[to]);
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

std::size_t Film::byte_count() const {
  return (combined_.size() + normal_.size()) * sizeof(std::int64_t) +
         depth_.size() * sizeof(float) + counts_.size() * sizeof(std::uint32_t) +
         bands_.size() * sizeof(Band);
}

}  // namespace komorebi
