#include "render/ray_order.h"

#include <algorithm>

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
    const auto [least, most] = std::minmax_element(column, column + count);
    low = *least;
    per_length = *most > low ? 128.0f / (*most - low) : 0.0f;
  }
  std::uint32_t cell(std::uint32_t i) const {
    const float place = (at[i] - low) * per_length;
    return place < 127.0f ? static_cast<std::uint32_t>(place) : 127u;
  }
};

}  // namespace

const std::vector<std::uint32_t>& RayOrder::sort(const RaySpan& rays) {
  order_.resize(rays.count);
  keys_.resize(rays.count);
  if (rays.count == 0) return order_;
  const Axis x(rays.origin_x, rays.count), y(rays.origin_y, rays.count),
      z(rays.origin_z, rays.count);
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    const std::uint32_t place = morton_30(x.cell(i), y.cell(i), z.cell(i));  // 21 bits
    keys_[i] = std::uint64_t{octant(rays, i) << 21 | place} << 32 | i;
  }
  std::sort(keys_.begin(), keys_.end());
  for (std::uint32_t i = 0; i < rays.count; ++i) order_[i] = static_cast<std::uint32_t>(keys_[i]);
  return order_;
}

}  // namespace komorebi
