#pragma once

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace komorebi::testing {

/// Pearson's χ² test. `p_value`: how likely a deviation as large as this one is by chance.
struct ChiSquare {
  double statistic = 0.0;
  std::int64_t degrees = 0;
  double p_value = 0.0;
};

/// The significance for each of `count` tests so that all together fail by chance with probability
/// `alpha` (Šidák 1967).
inline double sidak(double alpha, std::int64_t count) {
  return -std::expm1(std::log1p(-alpha) / static_cast<double>(count));
}

/// Compares counts with their expectations. Cells that expect fewer than `pool_below` are pooled,
/// smallest first, until the pool is large enough. Anything in a cell that expects nothing is
/// impossible, p = 0. Expectations are taken as they are, never scaled to the number of samples: a
/// density that does not integrate to 1 fails.
inline ChiSquare chi_square(const std::vector<std::uint64_t>& observed,
                            const std::vector<double>& expected, double pool_below = 5.0) {
  if (observed.size() != expected.size()) throw std::invalid_argument("chi_square: sizes differ");
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });

  ChiSquare result;
  const auto add_cell = [&](double count, double expectation) {
    const double difference = count - expectation;
    result.statistic += difference * difference / expectation;
    ++result.degrees;
  };
  double pooled_count = 0.0, pooled_expectation = 0.0;
  for (const std::size_t i : order) {
    const auto count = static_cast<double>(observed[i]);
    if (!(expected[i] >= 0.0)) throw std::invalid_argument("chi_square: a negative expectation");
    if (expected[i] == 0.0) {
      if (count == 0.0) continue;
      result.statistic = std::numeric_limits<double>::infinity();
      return result;
    }
    if (expected[i] >= pool_below && pooled_expectation == 0.0) {
      add_cell(count, expected[i]);
      continue;
    }
    pooled_count += count;
    pooled_expectation += expected[i];
    if (pooled_expectation >= pool_below) {
      add_cell(pooled_count, pooled_expectation);
      pooled_count = pooled_expectation = 0.0;
    }
  }
  if (pooled_expectation > 0.0) add_cell(pooled_count, pooled_expectation);
  --result.degrees;  // the number of samples is given
  if (result.degrees < 1) throw std::invalid_argument("chi_square: fewer than two cells");
  result.p_value =
      boost::math::gamma_q(0.5 * static_cast<double>(result.degrees), 0.5 * result.statistic);
  return result;
}

}  // namespace komorebi::testing
