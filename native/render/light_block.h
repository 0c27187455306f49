#pragma once

#include <vector>

#include "core/surface_point.h"
#include "render/light_kernel.h"

namespace komorebi {

/// Owns the arrays behind a LightBlock of up to `capacity` points.
class LightBlockBuffer {
 public:
  explicit LightBlockBuffer(std::uint32_t rays_per_point)
      : rays_(rays_per_point),
        capacity_((kRays / rays_per_point + LightBlock::kLanes) / LightBlock::kLanes *
                  LightBlock::kLanes),
        points_(std::size_t{6} * capacity_),
        words_(std::size_t{2} * capacity_),
        drawn_(std::size_t{6} * capacity_ * rays_) {}

  void clear() { count_ = 0; }
  std::uint32_t size() const { return count_; }
  bool full() const { return count_ == capacity_; }

  void push(const SurfacePoint& point, std::uint32_t pixel_seed, std::uint32_t first_index) {
    for (std::size_t c = 0; c < 3; ++c) {
      points_[c * capacity_ + count_] = point.normal[static_cast<int>(c)];
      points_[(3 + c) * capacity_ + count_] = point.geometric_normal[static_cast<int>(c)];
    }
    words_[count_] = pixel_seed;
    words_[capacity_ + count_] = first_index;
    ++count_;
  }

  /// Draws the light rays of all points.
  void draw(const RenderContext& context) {
    LightBlock block{};
    block.point_count = count_;
    block.rays_per_point = rays_;
    block.stride = capacity_;
    block.pixel_seed = words_.data();
    block.first_index = words_.data() + capacity_;
    for (std::size_t c = 0; c < 3; ++c) {
      block.normal[c] = &points_[c * capacity_];
      block.geometric_normal[c] = &points_[(3 + c) * capacity_];
      block.direction[c] = &drawn_[c * capacity_ * rays_];
      block.contribution[c] = &drawn_[(3 + c) * capacity_ * rays_];
    }
    sample_lights(context, block);
  }

  Vec3 direction(std::uint32_t point, std::uint32_t ray) const { return entry(0, point, ray); }
  Vec3 contribution(std::uint32_t point, std::uint32_t ray) const { return entry(3, point, ray); }

 private:
  static constexpr std::uint32_t kRays = 1024;  // so that what is drawn stays in the first cache

  Vec3 entry(std::size_t first, std::uint32_t point, std::uint32_t ray) const {
    const std::size_t column = std::size_t{capacity_} * rays_;
    const float* at = &drawn_[first * column + std::size_t{ray} * capacity_ + point];
    return Vec3(at[0], at[column], at[2 * column]);
  }

  std::uint32_t rays_, capacity_, count_ = 0;
  std::vector<float> points_;         // [6][capacity]: normal, geometric normal
  std::vector<std::uint32_t> words_;  // [2][capacity]: pixel seed, first index
  std::vector<float> drawn_;          // [6][rays][capacity]: direction, contribution
};

}  // namespace komorebi
