#pragma once

#include <vector>

#include "core/filter.h"

namespace komorebi {

/// Owns the table that a FilterView reads.
///
/// Cycles inverts its table of 1024 entries with linear interpolation and leaves the last entry at
/// zero, which puts 1/1023 of the samples somewhere between one end and the other. This table has
/// the filter's own distribution; the two differ by that thousandth.
class FilterTable {
 public:
  /// `width` in pixels; std::invalid_argument unless 0.01 ≤ width ≤ 100 (ignored for the box).
  FilterTable(PixelFilter filter, float width);

  /// Valid while the table lives.
  FilterView view() const;

 private:
  float radius_;
  std::vector<float> cdf_, density_;
};

}  // namespace komorebi
