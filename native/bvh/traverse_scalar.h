#pragma once

#include "bvh/closest.h"
#include "bvh/moving_leaf.h"
#include "bvh/round_leaf.h"
#include "bvh/topology.h"
#include "bvh/wide_node.h"
#include "core/instance_motion.h"

namespace komorebi {

/// Places on a traversal stack: going one level down leaves at most seven siblings behind.
inline constexpr std::uint32_t kStackSize = kMaxDepth * (kWidth - 1) + 1;

/// Visits the leaves of a wide tree that the ray meets within `range` and before `limit` (which
/// shrinks as the visitor finds hits), near children first. `visit(leaf)` returns true to stop; so
/// does walk then.
template <class Visit>
bool walk(const TreeView& tree, const SlabRay& slab, Interval range, const float& limit,
          const Visit& visit) {
  struct Entry {
    float begin;
    bool is_leaf;
    std::uint32_t child;
  };
  if (tree.node_count == 0) return false;
  Entry stack[kStackSize];
  std::uint32_t size = 0;
  stack[size++] = {range.begin, false, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.begin > limit) continue;
    if (entry.is_leaf) {
      if (visit(entry.child)) return true;
      continue;
    }
    const WideNode& node = tree.nodes[entry.child];
    const std::uint32_t bottom = size;
    for (int i = 0; i < node.child_count(); ++i) {
      const Interval inside = slab_interval(slab, node.box(i), range);
      if (inside.is_empty() || inside.begin > limit) continue;
      std::uint32_t place = size++;  // sorted: the nearest on top
      for (; place > bottom && stack[place - 1].begin < inside.begin; --place) {
        stack[place] = stack[place - 1];
      }
      const bool is_leaf = i >= node.inner_count();
      stack[place] = {inside.begin, is_leaf, is_leaf ? node.child_leaf(i) : node.child_node(i)};
    }
  }
  return false;
}

/// Whether a ray meets a set of curves or points; the better hit is kept.
template <bool kAny>
bool trace_round(const MeshView& mesh, std::uint32_t instance, const LocalRay& local,
                 const Vec3& direction, const Ray& ray, const HitTest& test, Closest* closest) {
  const TimeTree tree = round_tree_at(mesh, ray.time);
  const RoundRay round = make_round_ray(local, direction, round_time(mesh, ray.time));
  const std::uint32_t self = instance == ray.self_instance ? ray.self_primitive : kNone;
  const auto visit = [&](std::uint32_t leaf) {
    const auto meet = [&](Closest* to) {
      return test_round_leaf(mesh, round, self, instance, tree.leaves[leaf], to);
    };
    const bool found = test.keep(meet, closest);
    return kAny && found;
  };
  return walk(tree.tree, local.slab, local.range, closest->limit, visit);
}

/// The same of a mesh that deforms.
template <bool kAny>
bool trace_moving(const MeshView& mesh, std::uint32_t instance, const LocalRay& local,
                  const Ray& ray, const HitTest& test, Closest* closest) {
  const TimeTree& tree = tree_at(mesh, ray.time);
  const SetPlace place = set_place(mesh.position_sets, ray.time);
  const std::uint32_t self = instance == ray.self_instance ? ray.self_primitive : kNone;
  const auto visit = [&](std::uint32_t leaf) {
    const auto meet = [&](Closest* to) {
      return test_moving_triangle(mesh, local, place, self, instance, tree.leaf2triangle[leaf], to);
    };
    const bool found = test.keep(meet, closest);
    return kAny && found;
  };
  return walk(tree.tree, local.slab, local.range, closest->limit, visit);
}

/// Closest (or any) hit of one ray through both levels of trees.
template <bool kAny>
Hit trace_scalar(const SceneView& scene, const Ray& ray) {
  Closest closest(ray);
  const SlabRay world = make_world_slab(ray);
  if (!is_usable(world)) return closest.hit;
  const auto visit_instance = [&](std::uint32_t entry) {
    std::uint32_t index = scene.leaf2instance[entry];
    InstanceView moved;
    LocalRay local;
    if (index >= scene.instance_count) {
      const MotionGroup& group = scene.motion_groups[index - scene.instance_count];
      if (!enter_group(scene, group, ray, world, &moved, &local)) return false;
      index = group.instance;
    } else if (!enter_instance(scene.instances[index], ray, world, &local)) {
      return false;
    }
    const InstanceView& instance =
        scene.instances[index].motion == kNoMotion ? scene.instances[index] : moved;
    const MeshView& mesh = scene.meshes[instance.mesh];
    const HitTest test(scene, index, ray);
    if (mesh.kind == PrimitiveKind::kMovingTriangle) {
      return trace_moving<kAny>(mesh, index, local, ray, test, &closest);
    }
    if (mesh.kind != PrimitiveKind::kTriangle) {
      return trace_round<kAny>(mesh, index, local, local_direction(instance, ray), ray, test,
                               &closest);
    }
    const auto visit_cluster = [&](std::uint32_t leaf) {
      const ClusterView cluster(mesh.clusters + std::size_t{leaf} * kClusterUnit);
      for (std::uint32_t k = 0; k < cluster.triangle_count(); ++k) {
        const auto meet = [&](Closest* to) {
          return test_triangle(local, ray, index, cluster.primitive(k), cluster.position(k, 0),
                               cluster.position(k, 1), cluster.position(k, 2), to);
        };
        const bool found = test.keep(meet, &closest);
        if (kAny && found) return true;
      }
      return false;
    };
    return walk(mesh.tree, local.slab, local.range, closest.limit, visit_cluster);
  };
  walk(scene.tree, world, Interval{ray.t_min, ray.t_max}, closest.limit, visit_instance);
  return closest.hit;
}

}  // namespace komorebi
