#pragma once

#include <cstdint>
#include <span>

namespace komorebi {

/// cdf[i] = the sum of the weights before i over their total, in units of 2^-31, for i = 0…size;
/// all 0 when the total is. Each positive weight has one unit for certain and its share of the
/// rest. Returns the total.
inline double quantize_cdf(std::span<const double> weight, std::uint32_t* cdf) {
  double total = 0.0;
  std::uint32_t positive = 0;
  for (const double w : weight) {
    total += w;
    positive += w > 0.0;
  }
  const std::uint32_t shared_units = (1u << 31) - positive;
  const double scale = total > 0.0 ? 1.0 / total : 0.0;
  double sum = 0.0;
  std::uint32_t certain = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double share = sum * scale;  // may round to a little above 1
    cdf[i] = certain + static_cast<std::uint32_t>((share < 1.0 ? share : 1.0) * shared_units);
    sum += weight[i];
    certain += weight[i] > 0.0;
  }
  cdf[weight.size()] = total > 0.0 ? 1u << 31 : 0;
  return total;
}

}  // namespace komorebi
