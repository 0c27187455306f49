#pragma once

#include <span>
#include <vector>

#include "core/scene_view.h"

namespace komorebi {

/// What moves a scene's instances, and the leaves of the tree over instances that stand for them.
///
/// Keys. The core interpolates matrices linearly: of two rotations that is a chord, so keys are set
/// until no corner of the mesh's box is off Cycles' way (core/motion.h) by more than 1e-4 of the
/// box's size. A corner that moves on a straight line from key to key stays in the union of its
/// boxes at both; that box, of the segment alone, is what a ray of its time is tested by.
///
/// Leaves. One leaf stands for all of an instance's segments as long as that makes its box no
/// larger: rays of all times then enter it together and walk through its mesh in bundles, each in
/// the space of its own time; a leaf a segment would tear them apart (a fast propeller has two
/// hundred segments in one place). Where an instance crosses the scene, halves of its time are
/// leaves of their own, as soon as their boxes are smaller together than the whole.
struct MotionTable {
  std::vector<InstanceMotion> motions;
  std::vector<MotionKey> keys;
  std::vector<MotionGroup> groups;
  std::vector<Aabb> group_boxes;

  /// Sets motion and world_bounds of an instance that is otherwise ready, as it is at rest.
  /// @param poses  world from object at even times, at least two
  /// @param mesh_origin, local_bounds  of its mesh, in object space and relative to that origin
  void add(std::uint32_t index, InstanceView& instance, std::span<const Mat4d> poses,
           const Vec3d& mesh_origin, const Aabb& local_bounds, const Vec3d& scene_origin);
  std::size_t byte_count() const;

 private:
  void cut(std::uint32_t index, const MotionKey* key, std::uint32_t begin, std::uint32_t end,
           int depth);
};

}  // namespace komorebi
