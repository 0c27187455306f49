#pragma once

#include <algorithm>
#include <vector>

#include "core/ray_bundles.h"
#include "render/light_kernel.h"

namespace komorebi {

/// Owns what a LightBlock draws: the light rays of up to capacity() points. They stay in the first
/// caches, and the tracer sorts as many at a time.
class LightBlockBuffer {
 public:
  explicit LightBlockBuffer(std::uint32_t rays_per_point)
      : rays_(rays_per_point),
        capacity_(std::max(kRays / rays_per_point / LightBlock::kLanes, 1u) * LightBlock::kLanes),
        drawn_(std::size_t{6} * capacity_ * rays_),
        t_max_(std::size_t{capacity_} * rays_) {}

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

  /// Where the entries of a point's ray stand, in RayBundles' words.
  std::uint32_t place(std::uint32_t point, std::uint32_t ray) const {
    return ray * capacity_ + point;
  }
  /// A coordinate of all directions from a place on.
  Columns directions(std::uint32_t place) const {
    const float* at = drawn_.data() + place;
    return {at, at + t_max_.size(), at + 2 * t_max_.size()};
  }
  Vec3 direction(std::uint32_t place) const { return entry(0, place); }
  Vec3 contribution(std::uint32_t place) const { return entry(3, place); }

  std::size_t size() const { return t_max_.size(); }  ///< places
  void set_contribution(std::uint32_t place, const Vec3& contribution) {
    for (std::size_t c = 0; c < 3; ++c) {
      drawn_[(3 + c) * t_max_.size() + place] = contribution[static_cast<int>(c)];
    }
  }

  /// Lends `bundles` the rays, all of them as long as `t_max`.
  void lend(RayBundles& bundles, float t_max) {
    if (t_max_.front() != t_max) std::fill(t_max_.begin(), t_max_.end(), t_max);
    const std::size_t column = t_max_.size();
    bundles.direction_x = drawn_.data();
    bundles.direction_y = drawn_.data() + column;
    bundles.direction_z = drawn_.data() + 2 * column;
    bundles.t_max = t_max_.data();
  }

 private:
  static constexpr std::uint32_t kRays = 1024;

  Vec3 entry(std::size_t first, std::uint32_t place) const {
    const std::size_t column = t_max_.size();
    const float* at = &drawn_[first * column + place];
    return Vec3(at[0], at[column], at[2 * column]);
  }

  std::uint32_t rays_, capacity_;
  std::vector<float> drawn_;  // [6][rays][capacity]: direction, contribution
  std::vector<float> t_max_;  // [rays][capacity]
};

}  // namespace komorebi
