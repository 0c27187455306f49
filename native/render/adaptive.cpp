#include "render/adaptive.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace komorebi {
namespace {

constexpr double kCyclesFactor = 5.0;  // Cycles compares errors with 5 thresholds
constexpr float kSmallestAutomaticThreshold = 0.001f;
constexpr std::uint32_t kFewestSamples = 4;
constexpr std::uint32_t kAutomaticFewest = 8, kAutomaticFewestRays = 16;

/// The first power of two n ≥ 16 / threshold^0.3, that is, (n / 16)^10 · threshold³ ≥ 1.
std::uint32_t cycles_min_samples(double threshold) {
  std::uint32_t n = kFewestSamples;
  const auto enough = [&] {
    const double r = n / 16.0, r2 = r * r, r4 = r2 * r2;
    return r4 * r4 * r2 * threshold * threshold * threshold >= 1.0;
  };
  while (n < (1u << 24) && !enough()) n *= 2;
  return n;
}

}  // namespace

AdaptiveRule::AdaptiveRule(const Settings& s, std::uint32_t light_samples)
    : in_use_(s.use_adaptive_sampling),
      threshold_(s.adaptive_threshold),
      min_samples_(std::max(kFewestSamples, s.adaptive_min_samples)),
      samples_(s.samples) {
  if (threshold_ == 0.0f) {
    threshold_ = std::max(kSmallestAutomaticThreshold,
                          1.0f / static_cast<float>(samples_) / static_cast<float>(light_samples));
    eases_ = s.time_limit == 0.0f;
  }
  if (s.adaptive_min_samples == 0) {
    min_samples_ = eases_ ? std::max(kAutomaticFewest, kAutomaticFewestRays / light_samples)
                          : cycles_min_samples(threshold_);
  }
}

bool AdaptiveRule::decides_at(std::uint32_t n) const {
  return in_use_ && std::has_single_bit(n) && n >= min_samples_ && n < samples_;
}

bool AdaptiveRule::converged(const float* now, const float* before, std::size_t pixels,
                             std::uint32_t n) const {
  double squares = 0.0;
  for (std::size_t i = 0; i < 4 * pixels; i += 4) {
    // Cycles leaves out alpha, which is all the noise there is where black meets transparency.
    double difference = 0.0, brightness = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      difference += std::abs(double{now[i + c]} - double{before[i + c]});
      if (c < 3) brightness += double{now[i + c]};
    }
    const double scale = 0.0001 + (brightness < 1.0 ? std::sqrt(brightness) : brightness);
    squares += (difference / scale) * (difference / scale);
  }
  const double limit = kCyclesFactor * double{threshold_};
  const double margin = eases_ ? static_cast<double>(n) / samples_ : 1.0;
  return squares < limit * limit * margin * static_cast<double>(pixels);
}

}  // namespace komorebi
