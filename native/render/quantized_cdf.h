#pragma once

#include <cstdint>
#include <span>
#include <utility>

namespace komorebi {

/// cdf[i] = the sum of the weights before i over their total, in units of 2^-31, for i = 0…size;
/// all 0 when the total is. Each positive weight has one unit for certain and its share of the
/// rest. Returns the total; the weights become the sums.
inline double quantize_cdf(std::span<double> weight, std::uint32_t* cdf) {
  double total = 0.0;
  std::uint32_t positive = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double w = std::exchange(weight[i], total);
    cdf[i] = positive;
    total += w;
    positive += w > 0.0;
  }
  const double shared_units = (1u << 31) - positive;
  const double scale = total > 0.0 ? 1.0 / total : 0.0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double share = weight[i] * scale;  // may round to a little above 1
    const double units = (share < 1.0 ? share : 1.0) * shared_units;  // below 2^31
    cdf[i] += static_cast<std::uint32_t>(static_cast<std::int32_t>(units));
  }
  cdf[weight.size()] = total > 0.0 ? 1u << 31 : 0;
  return total;
}

}  // namespace komorebi
