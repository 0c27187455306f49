#pragma once

#include <span>
#include <vector>

#include "bvh/topology.h"
#include "bvh/wide_node.h"
#include "core/scene_view.h"
#include "parallel/late_array.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// The tree over a scene's instances; leaves are entries of leaf2instance.
struct InstanceTree {
  LateArray<WideNode> nodes;
  LateArray<std::uint32_t> leaf2instance;
  std::uint32_t depth = 0;
  Aabb bounds;

  TreeView view() const;
  std::size_t byte_count() const;
};

/// The world box of an instance: contains every point that a ray, taken into local space by
/// `local_from_world` and `position` as they are in float, can hit inside `local_bounds`. Computed
/// from the inverse of local_from_world in double, so world_from_local need not be its inverse.
/// Empty if `local_bounds` is, or if local_from_world is singular or not finite: such an instance
/// is never hit.
Aabb instance_bounds(const InstanceView& instance, const Aabb& local_bounds);

/// Stores the instance's world_bounds. To be called once everything else in the
/// instance is known and before the tree over the instances is built.
void place_instance(InstanceView& instance, const Aabb& local_bounds);

/// @param world_boxes  InstanceView::world_bounds of every instance; those with an empty box keep
///                     their index and are in no leaf.
/// @throws Cancelled; std::invalid_argument for too many instances
InstanceTree build_instance_tree(std::span<const Aabb> world_boxes, Builder builder,
                                 ThreadPool& pool, const Cancel& cancel);

}  // namespace komorebi
