#include "render/filter.h"

#include <stdexcept>
#include <string>

namespace komorebi {
namespace {

// Density is linear within a cell: its error is below 1e-5 of the peak with this many.
constexpr std::uint32_t kCells = 512;

// The four-term Blackman–Harris window (Harris 1978) over |x| ≤ radius.
double blackman_harris(double x, double radius) {
  const double turns = 0.5 * (x / radius) + 0.5;
  return 0.35875 - 0.48829 * sin_cos_turns(turns).cos + 0.14128 * sin_cos_turns(2.0 * turns).cos -
         0.01168 * sin_cos_turns(3.0 * turns).cos;
}

// exp(−8x²/w²) with the radius 1.5w.
double gaussian(double x, double radius) {
  const double q = x / (radius / 1.5);
  return exp_double(-8.0 * q * q);
}

}  // namespace

FilterTable::FilterTable(PixelFilter filter, float width) : radius_(0.5f) {
  if (filter == PixelFilter::kBox) return;
  if (!(width >= 0.01f && width <= 100.0f)) {
    throw std::invalid_argument(
        "pixel filter: the width must lie between 0.01 and 100 pixels, not " +
        std::to_string(width));
  }
  const bool is_gaussian = filter == PixelFilter::kGaussian;
  radius_ = is_gaussian ? 1.5f * width : width;

  const double radius = radius_;
  const double step = radius / kCells;
  std::vector<double> value(kCells + 1), sum(kCells + 1, 0.0);
  for (std::uint32_t i = 0; i <= kCells; ++i) {
    value[i] = is_gaussian ? gaussian(step * i, radius) : blackman_harris(step * i, radius);
    if (i > 0) sum[i] = sum[i - 1] + 0.5 * (value[i - 1] + value[i]) * step;
  }
  cdf_.resize(kCells + 1);
  density_.resize(kCells + 1);
  for (std::uint32_t i = 0; i <= kCells; ++i) {
    cdf_[i] = static_cast<float>(sum[i] / sum[kCells]);
    density_[i] = static_cast<float>(value[i] / sum[kCells]);
  }
}

FilterView FilterTable::view() const {
  FilterView view;
  view.radius = radius_;
  if (!cdf_.empty()) {
    view.cells = kCells;
    view.cdf = cdf_.data();
    view.density = density_.data();
  }
  return view;
}

}  // namespace komorebi
