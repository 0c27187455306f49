#pragma once

#include "core/ray_bundles.h"
#include "support/ray_list.h"

namespace komorebi::testing {

/// Rays that leave common points, as the arrays that RayBundles points into.
class BundleList {
 public:
  explicit BundleList(std::uint32_t mask = kMaskAll) : mask_(mask) {}

  /// The rays added after this leave the origin of `ray`, with its time and its own primitive.
  void add_point(const Ray& ray) {
    for (int axis = 0; axis < 3; ++axis) origin_[axis].push_back(ray.origin[axis]);
    time_.push_back(ray.time);
    self_instance_.push_back(ray.self_instance);
    self_primitive_.push_back(ray.self_primitive);
    first_ray_.push_back(first_ray_.back());
  }
  void add_ray(const Vec3& direction, float t_max, std::uint32_t path_key = 0) {
    for (int axis = 0; axis < 3; ++axis) direction_[axis].push_back(direction[axis]);
    t_max_.push_back(t_max);
    path_key_.push_back(path_key);
    ++first_ray_.back();
  }

  RayBundles view() const {
    RayBundles b{};
    b.origin_x = origin_[0].data(), b.origin_y = origin_[1].data(), b.origin_z = origin_[2].data();
    b.time = time_.data();
    b.self_instance = self_instance_.data(), b.self_primitive = self_primitive_.data();
    b.first_ray = first_ray_.data();
    b.point_count = static_cast<std::uint32_t>(time_.size());
    b.mask = mask_;
    b.direction_x = direction_[0].data(), b.direction_y = direction_[1].data();
    b.direction_z = direction_[2].data();
    b.t_max = t_max_.data();
    b.path_key = path_key_.data();
    return b;
  }

 private:
  std::uint32_t mask_;
  std::vector<float> origin_[3], time_, direction_[3], t_max_;
  std::vector<std::uint32_t> self_instance_, self_primitive_, path_key_, first_ray_{0};
};

}  // namespace komorebi::testing
