#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace komorebi::testing {

/// The slope of log(root mean square error) over log(samples), fitted by least squares to 2^first …
/// 2^last samples. `error(pixel, count)` is one estimate's error; `pixels` of them are averaged.
inline double convergence_slope(int first, int last, std::uint32_t pixels,
                                const std::function<double(std::uint32_t, std::uint32_t)>& error) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  const int count = last - first + 1;
  for (int k = first; k <= last; ++k) {
    double square = 0.0;
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
      const double e = error(pixel, 1u << k);
      square += e * e;
    }
    const double x = k, y = 0.5 * std::log2(square / pixels);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

}  // namespace komorebi::testing
