#include "render/ray_order.h"

#include <algorithm>
#include <utility>

#include "core/morton.h"

namespace komorebi {
namespace {

std::uint32_t octant(const RaySpan& rays, std::uint32_t i) {
  return (rays.direction_x[i] < 0.0f ? 1u : 0u) | (rays.direction_y[i] < 0.0f ? 2u : 0u) |
         (rays.direction_z[i] < 0.0f ? 4u : 0u);
}

/// Cells of a grid of 128 along an axis, over all that the rays leave.
struct Axis {
  const float* at;
  float low, per_length;

  Axis(const float* column, std::uint32_t count) : at(column) {
    constexpr std::uint32_t kLanes = 16;  // found in vectors, each lane its own ends
    float least[kLanes], most[kLanes];
    std::fill_n(least, kLanes, column[0]);
    std::fill_n(most, kLanes, column[0]);
    std::uint32_t i = 0;
    for (; i + kLanes <= count; i += kLanes) {
      for (std::uint32_t l = 0; l < kLanes; ++l) {
        const float x = column[i + l];
        least[l] = x < least[l] ? x : least[l];
        most[l] = x > most[l] ? x : most[l];
      }
    }
    for (; i < count; ++i) {
      least[0] = std::min(least[0], column[i]);
      most[0] = std::max(most[0], column[i]);
    }
    low = *std::min_element(least, least + kLanes);
    const float high = *std::max_element(most, most + kLanes);
    per_length = high > low ? 128.0f / (high - low) : 0.0f;
  }
  std::uint32_t cell(std::uint32_t i) const {
    const float place = (at[i] - low) * per_length;
    return place < 127.0f ? static_cast<std::uint32_t>(place) : 127u;
  }
};

constexpr std::uint32_t kDigitBits = 8, kDigits = 3;  ///< of a key: 3 + 21 bits
constexpr std::uint32_t kValues = 1u << kDigitBits;

std::uint32_t digit(std::uint64_t key, std::uint32_t d) {
  return static_cast<std::uint32_t>(key >> (32 + d * kDigitBits)) % kValues;
}

}  // namespace

/// By the lowest digit first, each time keeping the order of equal ones (radix sort).
const std::vector<std::uint32_t>& RayOrder::sort(const RaySpan& rays) {
  order_.resize(rays.count);
  keys_.resize(rays.count);
  sorted_.resize(rays.count);
  if (rays.count == 0) return order_;
  const Axis x(rays.origin_x, rays.count), y(rays.origin_y, rays.count),
      z(rays.origin_z, rays.count);
  std::uint32_t next[kDigits][kValues] = {};  // how many there are, then where the next one goes
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    const std::uint32_t place = morton_30(x.cell(i), y.cell(i), z.cell(i));  // 21 bits
    keys_[i] = std::uint64_t{octant(rays, i) << 21 | place} << 32 | i;
    for (std::uint32_t d = 0; d < kDigits; ++d) ++next[d][digit(keys_[i], d)];
  }
  for (auto& of_digit : next) {
    std::uint32_t first = 0;
    for (std::uint32_t& at : of_digit) first += std::exchange(at, first);
  }
  for (const std::uint64_t key : keys_) sorted_[next[0][digit(key, 0)]++] = key;
  for (const std::uint64_t key : sorted_) keys_[next[1][digit(key, 1)]++] = key;
  for (const std::uint64_t key : keys_) {
    order_[next[2][digit(key, 2)]++] = static_cast<std::uint32_t>(key);
  }
  return order_;
}

}  // namespace komorebi
