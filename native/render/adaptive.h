#pragma once

#include <cstdint>

#include "render/settings.h"

namespace komorebi {

/// Decides which cells have been sampled enough.
///
/// The error of a pixel is that of Dammertz et al. ("A Hierarchical Automatic Stopping Condition
/// for Monte Carlo Global Illumination", WSCG 2010, §2.1) with the normalisation of Cycles: the
/// difference between the mean of all samples and that of half of them, over the square root of
/// the pixel's brightness. A cell has converged when the root mean square of its pixels' errors is
/// below the threshold.
///
/// It decides at powers of two, and the halves are the first and the second half of the samples:
/// each is then a net of the Owen-scrambled Sobol' sequence, as the whole is, and their difference
/// tells its error to 1.1–1.3 times; every other sample would make halves that are no nets, and
/// 1.4–2.3 times. Since it looks at nothing but the exact sums of one cell at fixed numbers of
/// samples, the picture does not depend on anything else.
class AdaptiveRule {
 public:
  AdaptiveRule() = default;  ///< never stops
  /// As in Cycles an automatic threshold is 1 / samples (at least 0.001), where each of the light
  /// rays of a camera sample counts as a sample. But after n samples it is √(n / samples) of that:
  /// an early stop must be worth more, since the more samples are left, the more each of them
  /// brings (docs/performance.md has the figures). With a time limit the last sample is not known,
  /// so the threshold is the same all along.
  ///
  /// Cycles' automatic minimum of 16 / threshold^0.3 samples makes up for estimates from single
  /// pixels; with an automatic threshold, that margin and a cell's 64 pixels allow 8 to 16.
  AdaptiveRule(const Settings& settings, std::uint32_t light_samples);

  bool in_use() const { return in_use_; }
  float threshold() const { return threshold_; }
  std::uint32_t min_samples() const { return min_samples_; }

  /// Whether cells may stop after n samples.
  bool decides_at(std::uint32_t n) const;
  /// Whether a cell's means after n samples are needed later, as one half of 2n.
  bool remembers_at(std::uint32_t n) const { return decides_at(2 * n); }

  /// `now`, `before`: mean radiance and alpha of `pixels` pixels, [pixels][4], after n and n / 2
  /// samples.
  bool converged(const float* now, const float* before, std::size_t pixels, std::uint32_t n) const;

 private:
  bool in_use_ = false;
  bool eases_ = false;  // the threshold grows with the root of n
  float threshold_ = 0.0f;
  std::uint32_t min_samples_ = 0, samples_ = 0;
};

}  // namespace komorebi
