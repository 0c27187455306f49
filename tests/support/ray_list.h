#pragma once

#include <cstdint>
#include <vector>

#include "core/ray.h"

namespace komorebi::testing {

/// Rays as the arrays that a RaySpan points into.
class RayList {
 public:
  void push_back(const Ray& ray) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      origin_[axis].push_back(ray.origin[static_cast<int>(axis)]);
      direction_[axis].push_back(ray.direction[static_cast<int>(axis)]);
    }
    t_min_.push_back(ray.t_min);
    t_max_.push_back(ray.t_max);
    time_.push_back(ray.time);
    mask_.push_back(ray.mask);
    self_instance_.push_back(ray.self_instance);
    self_primitive_.push_back(ray.self_primitive);
    path_key_.push_back(ray.path_key);
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(t_min_.size()); }
  Ray operator[](std::uint32_t i) const { return span()[i]; }

  /// The rays [first, first + count).
  RaySpan span(std::uint32_t first, std::uint32_t count) const {
    return RaySpan{origin_[0].data() + first,
                   origin_[1].data() + first,
                   origin_[2].data() + first,
                   direction_[0].data() + first,
                   direction_[1].data() + first,
                   direction_[2].data() + first,
                   t_min_.data() + first,
                   t_max_.data() + first,
                   time_.data() + first,
                   mask_.data() + first,
                   self_instance_.data() + first,
                   self_primitive_.data() + first,
                   count,
                   path_key_.data() + first};
  }
  RaySpan span() const { return span(0, size()); }

 private:
  std::vector<float> origin_[3], direction_[3], t_min_, t_max_, time_;
  std::vector<std::uint32_t> mask_, self_instance_, self_primitive_, path_key_;
};

}  // namespace komorebi::testing
