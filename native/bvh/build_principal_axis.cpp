#include <algorithm>
#include <numeric>

#include "bvh/topology.h"

namespace komorebi {
namespace {

/// From this depth on nodes are split in the middle, which adds at most 32 levels. A million
/// triangles of a scan are some 25 deep.
constexpr std::uint32_t kMedianDepth = 40;
static_assert(kMedianDepth + 32 <= kMaxDepth);
constexpr int kPowerIterations = 16;

/// Rows of a symmetric 3×3 matrix, in double.
struct Covariance {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3d times(const Vec3d& v) const {
    return Vec3d(xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                 xz * v.x + yz * v.y + zz * v.z);
  }
};

double dot(const Vec3d& a, const Vec3d& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The direction in which the centres spread most: the covariance's first eigenvector by power
/// iteration, started from the axis with the largest variance. It need not have converged: any
/// direction gives a right tree.
Vec3d principal_axis(const Covariance& c) {
  Vec3d axis(1, 0, 0);
  if (c.yy > c.xx && c.yy >= c.zz) axis = Vec3d(0, 1, 0);
  if (c.zz > c.xx && c.zz > c.yy) axis = Vec3d(0, 0, 1);
  for (int i = 0; i < kPowerIterations; ++i) {
    const Vec3d next = c.times(axis);
    const double largest = std::max({next.x, -next.x, next.y, -next.y, next.z, -next.z});
    if (!(largest > 0)) break;
    axis = next / largest;
  }
  return axis;
}

/// The classic top-down build: cut across the axis along which the centres spread most, at their
/// mean; left and right child per node. Readable before fast, and one thread.
class TopDown {
 public:
  TopDown(std::span<const Aabb> boxes, const Cancel& cancel) : boxes_(boxes), cancel_(cancel) {
    topology_.order.resize(boxes.size());
    std::iota(topology_.order.begin(), topology_.order.end(), 0u);
  }

  Topology build() {
    const auto count = static_cast<std::uint32_t>(boxes_.size());
    if (count > 0) topology_.root = add(0, count - 1, 0);
    return std::move(topology_);
  }

 private:
  /// Adds what covers positions [first, last]; returns the child that stands for it.
  std::uint32_t add(std::uint32_t first, std::uint32_t last, std::uint32_t level) {
    if (first == last) return kLeafBit | first;
    check(cancel_);
    const auto node = static_cast<std::uint32_t>(topology_.left.size());
    topology_.left.push_back(kNone);
    topology_.right.push_back(kNone);
    topology_.first.push_back(first);
    topology_.last.push_back(last);
    topology_.bounds.emplace_back();
    topology_.depth = std::max(topology_.depth, level + 1);
    const std::uint32_t middle = split(first, last, level);
    const std::uint32_t left = add(first, middle - 1, level + 1);
    const std::uint32_t right = add(middle, last, level + 1);
    topology_.left[node] = left;
    topology_.right[node] = right;
    topology_.bounds[node] = united(box(left), box(right));
    return node;
  }

  const Aabb& box(std::uint32_t node) const {
    return node & kLeafBit ? boxes_[topology_.order[node & ~kLeafBit]] : topology_.bounds[node];
  }

  Vec3d item_centre(std::uint32_t item) const { return Vec3d(centre(boxes_[item])); }

  /// Parts the range; returns the first position of the right part (first < result <= last).
  std::uint32_t split(std::uint32_t first, std::uint32_t last, std::uint32_t level) {
    const auto begin = topology_.order.begin() + first;
    const auto end = topology_.order.begin() + last + 1;
    Vec3d mean(0.0);
    for (auto i = begin; i != end; ++i) mean += item_centre(*i);
    mean /= static_cast<double>(end - begin);
    Covariance c;
    for (auto i = begin; i != end; ++i) {
      const Vec3d d = item_centre(*i) - mean;
      c.xx += d.x * d.x, c.xy += d.x * d.y, c.xz += d.x * d.z;
      c.yy += d.y * d.y, c.yz += d.y * d.z, c.zz += d.z * d.z;
    }
    const Vec3d axis = principal_axis(c);
    const auto along = [&](std::uint32_t item) { return dot(item_centre(item) - mean, axis); };
    if (level < kMedianDepth) {
      const auto middle =
          std::partition(begin, end, [&](std::uint32_t item) { return along(item) < 0; });
      if (middle != begin && middle != end) {
        return first + static_cast<std::uint32_t>(middle - begin);
      }
    }
    // All centres in one place, or too deep: halves by (distance along the axis, index).
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
      const double along_a = along(a), along_b = along(b);
      return along_a != along_b ? along_a < along_b : a < b;
    });
    return first + static_cast<std::uint32_t>(middle - begin);
  }

  std::span<const Aabb> boxes_;
  const Cancel& cancel_;
  Topology topology_;
};

}  // namespace

Topology build_principal_axis(std::span<const Aabb> boxes, const Cancel& cancel) {
  return TopDown(boxes, cancel).build();
}

}  // namespace komorebi
