#pragma once

#include <limits>

namespace komorebi {

/// All floats from lo to hi. Where an end is not finite nothing is known: it may be no number
/// either. Sums and products of floats round monotonically, so those of the ends bound all others
/// to the bit.
struct FloatRange {
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  float lo = -kInfinity, hi = kInfinity;

  FloatRange() = default;
  FloatRange(float lowest, float highest) : lo(lowest), hi(highest) {
    // After an overflow, or where nothing was known before: false for a NaN, too.
    if (!(lo > -kInfinity && hi < kInfinity && lo <= hi)) lo = -kInfinity, hi = kInfinity;
  }
  static FloatRange of(float value) { return {value, value}; }

  bool known() const { return hi < kInfinity; }
  float largest() const {  ///< absolute value
    const float below = -lo;
    return below > hi ? below : hi;
  }
};

inline FloatRange operator+(const FloatRange& a, const FloatRange& b) {
  return {a.lo + b.lo, a.hi + b.hi};
}
inline FloatRange operator-(const FloatRange& a, const FloatRange& b) {
  return {a.lo - b.hi, a.hi - b.lo};
}
inline FloatRange operator*(const FloatRange& a, const FloatRange& b) {
  if (!a.known() || !b.known()) return {};
  const float p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  const float low = p < q ? p : q, lower = r < s ? r : s;
  const float high = p > q ? p : q, higher = r > s ? r : s;
  return {low < lower ? low : lower, high > higher ? high : higher};
}

/// Both.
inline FloatRange joined(const FloatRange& a, const FloatRange& b) {
  return {a.lo < b.lo ? a.lo : b.lo, a.hi > b.hi ? a.hi : b.hi};
}

/// With as much to either side.
inline FloatRange widened(const FloatRange& a, float by) {
  return {a.lo - by, a.hi + by};
}

}  // namespace komorebi
