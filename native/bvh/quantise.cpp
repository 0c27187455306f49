#include "bvh/quantise.h"

#include <algorithm>

namespace komorebi {
namespace {

constexpr int kLast = 255;  ///< of the grid's planes

/// The grid of one axis; `at` is the traversal's own arithmetic (WideNode::plane).
struct Grid {
  float origin, step;
  float at(int q) const { return origin + static_cast<float>(q) * step; }

  /// The last plane that is not above x, the first that is not below: the guess in double is off by
  /// what rounding in `at` does.
  int below(float x) const {
    int q = std::clamp(static_cast<int>((double(x) - double(origin)) / double(step)), 0, kLast);
    while (q < kLast && at(q + 1) <= x) ++q;
    while (q > 0 && at(q) > x) --q;
    return q;
  }
  int above(float x) const {
    int q = std::clamp(static_cast<int>((double(x) - double(origin)) / double(step)), 0, kLast);
    while (q > 0 && at(q - 1) >= x) --q;
    while (q < kLast && at(q) < x) ++q;
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
