#pragma once

#include "bvh/closest.h"
#include "bvh/topology.h"
#include "bvh/wide_node.h"

namespace komorebi {

/// Places on a traversal stack: going one level down leaves at most seven siblings behind.
inline constexpr std::uint32_t kStackSize = kMaxDepth * (kWidth - 1) + 1;

/// Visits the leaves of a wide tree that the ray meets within `range` and before `limit` (which
/// shrinks as the visitor finds hits), near children first. `visit(child, count)` returns true to
/// stop; so does walk then.
template <class Visit>
bool walk(const TreeView& tree, const SlabRay& slab, Interval range, const float& limit,
          const Visit& visit) {
  struct Entry {
    float begin;
    std::uint32_t child, count;
  };
  if (tree.node_count == 0) return false;
  Entry stack[kStackSize];
  std::uint32_t size = 0;
  stack[size++] = {range.begin, 0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.begin > limit) continue;
    if (entry.count > 0) {
      if (visit(entry.child, entry.count)) return true;
      continue;
    }
    const WideNode& node = tree.nodes[entry.child];
    const std::uint32_t bottom = size;
    for (int i = 0; i < kWidth; ++i) {
      const Interval inside = slab_interval(slab, node.box(i), range);
      if (inside.is_empty() || inside.begin > limit) continue;
      std::uint32_t place = size++;  // sorted: the nearest on top
      for (; place > bottom && stack[place - 1].begin < inside.begin; --place) {
        stack[place] = stack[place - 1];
      }
      stack[place] = {inside.begin, node.child[i], node.count[i]};
    }
  }
  return false;
}

/// Closest (or any) hit of one ray through both levels of trees.
template <bool kAny, class Filter>
Hit trace_scalar(const SceneView& scene, const Ray& ray, const Filter& filter) {
  Closest closest(ray);
  const SlabRay world = make_world_slab(ray);
  if (!is_usable(world)) return closest.hit;
  const auto visit_instances = [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i) {
      const std::uint32_t index = scene.leaf2instance[i];
      const InstanceView& instance = scene.instances[index];
      LocalRay local;
      if (!enter_instance(instance, ray, world, &local)) continue;
      const MeshView& mesh = scene.meshes[instance.mesh];
      const auto visit_block = [&](std::uint32_t leaf, std::uint32_t triangles) {
        const TriangleBlock& block = mesh.blocks[leaf];
        for (int k = 0; k < static_cast<int>(triangles); ++k) {
          const bool found =
              test_triangle(local, ray, index, block.primitive[k], block.position(0, k),
                            block.position(1, k), block.position(2, k), filter, &closest);
          if (kAny && found) return true;
        }
        return false;
      };
      if (walk(mesh.tree, local.slab, local.range, closest.limit, visit_block)) return true;
    }
    return false;
  };
  walk(scene.tree, world, Interval{ray.t_min, ray.t_max}, closest.limit, visit_instances);
  return closest.hit;
}

}  // namespace komorebi
