#include "render/instance_motion.h"

#include <algorithm>
#include <cmath>

#include "core/slab.h"
#include "render/motion.h"

namespace komorebi {
namespace {

constexpr double kTolerance = 1e-4;  ///< of the instance's size
constexpr std::uint32_t kMostSegments = 4096;
constexpr float kWorthTwoLeaves = 0.7f;  ///< area of the halves over that of the whole
constexpr int kMostHalvings = 5;

/// The corners of a mesh's box on their way.
class Way {
 public:
  Way(std::span<const Mat4d> poses, const Vec3d& mesh_origin, const Aabb& bounds,
      const Vec3d& scene_origin)
      : poses_(decompose_poses(poses, scene_origin)) {
    for (int k = 0; k < 8; ++k) {
      corner_[k] =
          mesh_origin + Vec3d(k & 1 ? bounds.hi.x : bounds.lo.x, k & 2 ? bounds.hi.y : bounds.lo.y,
                              k & 4 ? bounds.hi.z : bounds.lo.z);
    }
    for (std::uint32_t i = 0; i <= steps(); ++i) {
      const AffineMap map = at(double(i) / steps());
      for (int k = 0; k < 4; ++k) {
        size_ = std::max(size_, 0.5 * glm::length(map.linear * (corner_[7 - k] - corner_[k])));
      }
    }
  }

  std::uint32_t steps() const { return static_cast<std::uint32_t>(poses_.size() - 1); }
  AffineMap at(double time) const {
    return pose_at(poses_.data(), static_cast<std::uint32_t>(poses_.size()), time);
  }

  /// Whether keys at even times are close enough together.
  bool is_fine(std::uint32_t segments) const {
    for (std::uint32_t i = 0; i < segments; ++i) {
      if (!is_straight(double(i) / segments, double(i + 1) / segments)) return false;
    }
    return true;
  }

  std::uint32_t segments() const {
    if (is_fine(1)) return 1;
    std::uint32_t count = steps();
    while (2 * count <= kMostSegments && !is_fine(count)) count *= 2;
    return count;
  }

 private:
  bool is_straight(double begin, double end) const {
    const AffineMap a = at(begin), b = at(end);
    // Between steps the way is smooth, and bends most in the middle.
    const std::uint32_t parts = end - begin > 1.5 / steps() ? 2 * steps() : 2;
    for (std::uint32_t i = 1; i < parts; ++i) {
      const double t = double(i) / parts;
      const AffineMap m = at(begin + t * (end - begin));
      for (const Vec3d& corner : corner_) {
        const Vec3d from = a.linear * corner + a.translation,
                    to = b.linear * corner + b.translation;
        const Vec3d off = m.linear * corner + m.translation - ((1.0 - t) * from + t * to);
        if (!(glm::length(off) <= kTolerance * size_)) return false;
      }
    }
    return true;
  }

  std::vector<MotionPose> poses_;
  Vec3d corner_[8];
  double size_ = 0.0;
};

/// The box of local bounds at a key. The rays' way into local space is by the rounded inverse of
/// matrices in between, of which |M| |M⁻¹| bounds the error; it hardly changes from key to key.
Aabb key_box(const MotionKey& key, const Aabb& bounds) {
  const Mat3d m(key.world_from_local), inverse = glm::inverse(m);
  const Vec3d middle = 0.5 * (Vec3d(bounds.lo) + Vec3d(bounds.hi));
  const Vec3d extent = 0.5 * (Vec3d(bounds.hi) - Vec3d(bounds.lo));
  Vec3d lo(0.0), hi(0.0);
  double largest = 0.0, amplified = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    double at = 0.0, reach = 0.0, sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      at += m[k][axis] * middle[k];
      reach += std::abs(m[k][axis]) * extent[k];
      for (int j = 0; j < 3; ++j) sum += std::abs(m[k][axis] * inverse[j][k]);
    }
    lo[axis] = double(key.position[axis]) + at - reach;
    hi[axis] = double(key.position[axis]) + at + reach;
    largest = std::max(largest, std::abs(at) + reach);
    if (sum < 1e6) amplified = std::max(amplified, sum);  // else it has no size across
  }
  const Aabb box{Vec3(lo), Vec3(hi)};
  if (!(max_abs(box) <= 1e30f)) return Aabb{};
  const double error = double(kPadding) * (amplified * largest + double(max_abs(box)));
  return padded(box, static_cast<float>(error));
}

}  // namespace

void MotionTable::add(std::uint32_t index, InstanceView& instance, std::span<const Mat4d> poses,
                      const Vec3d& mesh_origin, const Aabb& local_bounds,
                      const Vec3d& scene_origin) {
  instance.world_bounds = Aabb{};
  if (local_bounds.is_empty()) return;
  const Way way(poses, mesh_origin, local_bounds, scene_origin);
  const std::uint32_t segments = way.segments();
  const auto first = static_cast<std::uint32_t>(keys.size());
  for (std::uint32_t i = 0; i <= segments; ++i) {
    const AffineMap map = way.at(double(i) / segments);
    MotionKey key;
    key.world_from_local = Mat3(map.linear);
    key.position = Vec3(map.translation + map.linear * mesh_origin);
    keys.push_back(key);
  }
  Aabb last = key_box(keys[first], local_bounds);
  for (std::uint32_t i = 0; i < segments; ++i) {
    const Aabb next = key_box(keys[first + i + 1], local_bounds);
    keys[first + i].world_bounds = united(last, next);
    instance.world_bounds = united(instance.world_bounds, keys[first + i].world_bounds);
    last = next;
  }
  instance.motion = static_cast<std::uint32_t>(motions.size()) & kNoMotion;
  motions.push_back({first, segments + 1});
  cut(index, &keys[first], 0, segments, 0);
}

void MotionTable::cut(std::uint32_t index, const MotionKey* key, std::uint32_t begin,
                      std::uint32_t end, int depth) {
  const auto box = [&](std::uint32_t from, std::uint32_t to) {
    Aabb all;
    for (std::uint32_t i = from; i < to; ++i) all = united(all, key[i].world_bounds);
    return all;
  };
  const Aabb whole = box(begin, end);
  const std::uint32_t middle = begin + (end - begin) / 2;
  if (end - begin > 1 && depth < kMostHalvings &&
      half_area(box(begin, middle)) + half_area(box(middle, end)) <
          kWorthTwoLeaves * half_area(whole)) {
    cut(index, key, begin, middle, depth + 1);
    return cut(index, key, middle, end, depth + 1);
  }
  groups.push_back({index, begin, end});
  group_boxes.push_back(whole);
}

std::size_t MotionTable::byte_count() const {
  return motions.capacity() * sizeof(InstanceMotion) + keys.capacity() * sizeof(MotionKey) +
         groups.capacity() * sizeof(MotionGroup);
}

}  // namespace komorebi
