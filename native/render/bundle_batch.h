#pragma once

#include <vector>

#include "core/ray_bundles.h"

namespace komorebi {

/// Owns the arrays behind RayBundles; grows once and is then reused from batch to batch. Rays that
/// are pushed leave the point begun last; a point may stay without rays.
class BundleBatch {
 public:
  void clear() { point_count_ = ray_count_ = 0; }
  std::uint32_t ray_count() const { return ray_count_; }
  std::uint32_t point_count() const { return point_count_; }

  void begin_point(const Vec3& origin, float time, const Hit& self) {
    if (point_count_ == self_[0].size()) {
      const std::size_t size = grown(point_count_);
      for (auto& column : origins_) column.resize(size);
      for (auto& column : self_) column.resize(size);
      first_ray_.resize(size + 1);
    }
    const float f[4] = {origin.x, origin.y, origin.z, time};
    for (std::size_t c = 0; c < 4; ++c) origins_[c][point_count_] = f[c];
    self_[0][point_count_] = self.instance;
    self_[1][point_count_] = self.primitive;
    first_ray_[point_count_++] = ray_count_;
  }

  void push_ray(const Vec3& direction, float t_max, std::uint32_t path_key = 0) {
    if (ray_count_ == rays_[0].size()) {
      path_keys_.resize(grown(ray_count_));
      for (auto& column : rays_) column.resize(grown(ray_count_));
    }
    const float f[4] = {direction.x, direction.y, direction.z, t_max};
    for (std::size_t c = 0; c < 4; ++c) rays_[c][ray_count_] = f[c];
    path_keys_[ray_count_++] = path_key;
  }

  std::uint32_t first_ray(std::uint32_t point) const { return first_ray_[point]; }

  /// Valid until the next change.
  RayBundles bundles(std::uint32_t mask) {
    if (point_count_ > 0) first_ray_[point_count_] = ray_count_;
    RayBundles b{};
    b.origin_x = origins_[0].data();
    b.origin_y = origins_[1].data();
    b.origin_z = origins_[2].data();
    b.time = origins_[3].data();
    b.self_instance = self_[0].data();
    b.self_primitive = self_[1].data();
    b.first_ray = first_ray_.data();
    b.point_count = point_count_;
    b.mask = mask;
    b.direction_x = rays_[0].data();
    b.direction_y = rays_[1].data();
    b.direction_z = rays_[2].data();
    b.t_max = rays_[3].data();
    b.path_key = path_keys_.data();
    return b;
  }

 private:
  static std::size_t grown(std::size_t count) { return count < 64 ? 64 : 2 * count; }

  std::vector<float> origins_[4], rays_[4];  // xyz and time; xyz and t_max
  std::vector<std::uint32_t> self_[2], first_ray_, path_keys_;
  std::uint32_t point_count_ = 0, ray_count_ = 0;
};

}  // namespace komorebi
