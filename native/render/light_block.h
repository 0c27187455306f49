#pragma once

#include <vector>

#include "render/light_kernel.h"

namespace komorebi {

/// Owns what a LightBlock draws: the light rays of up to capacity() points, which stay in the first
/// cache.
class LightBlockBuffer {
 public:
  explicit LightBlockBuffer(std::uint32_t rays_per_point)
      : rays_(rays_per_point),
        capacity_((kRays / rays_per_point + LightBlock::kLanes) / LightBlock::kLanes *
                  LightBlock::kLanes),
        drawn_(std::size_t{6} * capacity_ * rays_) {}

  std::uint32_t capacity() const { return capacity_; }

  /// Draws the light rays of the points of `block`, of which the caller has set what is read.
  void draw(const RenderContext& context, LightBlock block) {
    block.rays_per_point = rays_;
    block.stride = capacity_;
    for (std::size_t c = 0; c < 3; ++c) {
      block.direction[c] = &drawn_[c * capacity_ * rays_];
      block.contribution[c] = &drawn_[(3 + c) * capacity_ * rays_];
    }
    sample_lights(context, block);
  }

  Vec3 direction(std::uint32_t point, std::uint32_t ray) const { return entry(0, point, ray); }
  Vec3 contribution(std::uint32_t point, std::uint32_t ray) const { return entry(3, point, ray); }

 private:
  static constexpr std::uint32_t kRays = 1024;

  Vec3 entry(std::size_t first, std::uint32_t point, std::uint32_t ray) const {
    const std::size_t column = std::size_t{capacity_} * rays_;
    const float* at = &drawn_[first * column + std::size_t{ray} * capacity_ + point];
    return Vec3(at[0], at[column], at[2 * column]);
  }

  std::uint32_t rays_, capacity_;
  std::vector<float> drawn_;  // [6][rays][capacity]: direction, contribution
};

}  // namespace komorebi
