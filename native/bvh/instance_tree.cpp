#include "bvh/instance_tree.h"

#include <cmath>

#include "bvh/wide_tree.h"
#include "core/local_ray.h"

namespace komorebi {
namespace {

bool is_finite(double x) {
  return x >= -double(kFloatMax) && x <= double(kFloatMax);
}

}  // namespace

TreeView InstanceTree::view() const {
  return TreeView{nodes.data(), static_cast<std::uint32_t>(nodes.size()), depth};
}

std::size_t InstanceTree::byte_count() const {
  return nodes.byte_count() + leaf2instance.byte_count();
}

Aabb instance_bounds(const InstanceView& instance, const Aabb& local_bounds) {
  if (local_bounds.is_empty()) return Aabb{};
  const Mat3d world_from_local = glm::inverse(Mat3d(instance.local_from_world));
  // Centre and half extent through the inverse: |M|·extent is the extent of the image.
  const Vec3d lo(local_bounds.lo), hi(local_bounds.hi);
  const Vec3d middle = 0.5 * (lo + hi), extent = 0.5 * (hi - lo);
  Aabb world;
  for (int axis = 0; axis < 3; ++axis) {
    double at = double(instance.position[axis]), reach = 0.0;
    for (int k = 0; k < 3; ++k) {
      at += world_from_local[k][axis] * middle[k];
      reach += std::abs(world_from_local[k][axis]) * extent[k];
    }
    if (!is_finite(at - reach) || !is_finite(at + reach)) return Aabb{};
    world.lo[axis] = static_cast<float>(at - reach);
    world.hi[axis] = static_cast<float>(at + reach);
  }
  return padded(world, max_abs(world) * kPadding);
}

void place_instance(InstanceView& instance, const Aabb& local_bounds) {
  instance.world_bounds = instance_bounds(instance, local_bounds);
}

InstanceTree build_instance_tree(std::span<const Aabb> world_boxes, Builder builder,
                                 ThreadPool& pool, const Cancel& cancel) {
  const Items items{{}, {}, world_boxes, {1, kNone}};
  WideTree wide = build_wide_tree(items, builder, pool, cancel);
  InstanceTree tree;
  tree.nodes = std::move(wide.nodes);
  tree.leaf2instance = std::move(wide.leaves);
  tree.depth = wide.depth;
  tree.bounds = wide.bounds;
  return tree;
}

}  // namespace komorebi
