#include "bvh/quantise.h"

#include <algorithm>
#include <cmath>

namespace komorebi {
namespace {

constexpr int kLast = 255;  ///< of the grid's planes

/// The grid of one axis; `at` is the traversal's own arithmetic (WideNode::plane).
struct Grid {
  float origin, step;
  float at(int q) const { return origin + static_cast<float>(q) * step; }
  float place(float x) const {
    return std::clamp((x - origin) * (1.0f / step), 0.0f, static_cast<float>(kLast));
  }

  /// A plane that is not above x, or not below: the closest one, or where rounding moved its place
  /// the next one. The first is not above anything, and the last not below.
  int below(float x) const {
    int q = static_cast<int>(std::floor(place(x)));
    while (at(q) > x) --q;
    return q;
  }
  int above(float x) const {
    int q = static_cast<int>(std::ceil(place(x)));
    while (at(q) < x) ++q;
    return q;
  }
};

}  // namespace

void quantise(const Aabb* boxes, int count, WideNode& node) {
  Aabb all;
  for (int i = 0; i < count; ++i) all = united(all, boxes[i]);
  for (int axis = 0; axis < 3; ++axis) {
    node.origin[axis] = all.lo[axis];
    node.exponent[axis] = choose_grid_exponent(all.lo[axis], all.hi[axis]);
    const Grid grid{node.origin[axis], node.step(axis)};
    for (int i = 0; i < kWidth; ++i) {
      const bool used = i < count;
      node.q[axis][0][i] = static_cast<std::uint8_t>(used ? grid.below(boxes[i].lo[axis]) : kLast);
      node.q[axis][1][i] = static_cast<std::uint8_t>(used ? grid.above(boxes[i].hi[axis]) : 0);
    }
  }
}

}  // namespace komorebi
