#pragma once

#include <algorithm>
#include <cmath>

#include "core/vector.h"

namespace komorebi {

/// Where the origin of a scene's floats may lie, by the place that the scene is looked at from.
struct OriginGrid {
  /// Steps that an eye may move before another origin is worth a new tree over instances.
  static constexpr double kFarSteps = 2.0;

  Vec3d lo{0.0}, hi{0.0};  ///< bounds of the scene
  double step = 0.0;       ///< origins are multiples of it; 0: there is nothing that has a size

  OriginGrid() = default;
  OriginGrid(const Vec3d& low, const Vec3d& high) : lo(low), hi(high) {
    const Vec3d extent = hi - lo;
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (longest > 0.0) step = std::exp2(std::floor(std::log2(longest / 256.0)));
  }

  Vec3d nearest(const Vec3d& eye) const {
    return step * glm::round(glm::clamp(eye, lo, hi) / step);
  }

  bool is_far(const Vec3d& eye, const Vec3d& origin) const {
    if (step == 0.0) return false;
    const Vec3d away = glm::abs(nearest(eye) - origin);
    return std::max({away.x, away.y, away.z}) > kFarSteps * step;
  }
};

}  // namespace komorebi
