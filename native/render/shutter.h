#pragma once

#include <vector>

#include "core/shutter.h"

namespace komorebi {

/// How a camera's shutter opens and closes.
struct ShutterDesc {
  std::vector<float> curve;       ///< weights at even times from 0 to 1; empty: uniform
  bool rolling = false;           ///< rows are exposed one after the other, the top one first
  double rolling_duration = 0.1;  ///< of each row, in shutter times; 0 to 1
  /// It stays shut: the picture is that of the rest poses, and poses in time are for the Vector
  /// pass, which compares the first and the last with the rest.
  bool still = false;
};

/// Owns the table that a ShutterView reads.
///
/// Cycles samples the curve at 256 times, takes it for a staircase and inverts that with linear
/// interpolation; this table has the curve's own distribution. They differ by about a 256th of the
/// shutter time.
class ShutterTable {
 public:
  ShutterTable() = default;
  /// Throws std::invalid_argument with a sentence when weights are not finite, negative, all null
  /// or a single one, the rolling shutter's duration is not 0 to 1, or one that stays shut has any
  /// of these.
  /// @param height  of the full frame in pixels
  ShutterTable(const ShutterDesc& desc, std::uint32_t height);

  /// Valid while the table lives.
  ShutterView view() const;

 private:
  std::vector<float> cdf_, density_;  // empty: uniform
  float rolling_height_ = 0.0f, rolling_duration_ = 0.0f;
  bool still_ = false;
};

}  // namespace komorebi
