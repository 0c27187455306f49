#include "bvh/moving_tree.h"

#include <algorithm>

#include "bvh/time_parts.h"
#include "bvh/wide_tree.h"
#include "core/moving_triangle.h"
#include "core/triangle.h"
#include "parallel/array.h"

namespace komorebi {
namespace {

Aabb hull(const Corners& at) {
  Aabb box;
  for (const Vec3& p : at.corner) box = united(box, Aabb{p, p});
  return box;
}

Aabb hull(const MeshView& mesh, std::size_t triangle, const MotionPlace& place) {
  return hull(moving_triangle(mesh, triangle, {place.step, static_cast<float>(place.fraction)}));
}

/// Contains the padded box of the triangle at every time of a part. Between two sets corners move
/// on straight lines; what the fraction and the sum of the two round is relative to the sets'
/// coordinates, and less than the padding again.
Aabb box_over(const MeshView& mesh, std::size_t triangle, const TimePart& part) {
  Aabb box, sets;
  for (const MotionPlace& place : part.times) box = united(box, hull(mesh, triangle, place));
  for (std::uint32_t set = part.first_set; set <= part.last_set; ++set) {
    const bool is_last = set + 1 == mesh.position_sets;
    sets = united(sets, hull(mesh, triangle, {is_last ? set - 1 : set, is_last ? 1.0 : 0.0}));
  }
  return padded(box, 2.0f * (max_abs(sets) * kPadding));
}

}  // namespace

std::size_t MovingTree::node_count() const {
  std::size_t sum = 0;
  for (const Part& part : parts) sum += part.nodes.size();
  return sum;
}

std::uint32_t MovingTree::depth() const {
  std::uint32_t most = 0;
  for (const Part& part : parts) most = std::max(most, part.depth);
  return most;
}

std::size_t MovingTree::byte_count() const {
  std::size_t sum = 0;
  for (const Part& part : parts) {
    sum += sizeof(Part) + part.nodes.byte_count() + part.leaf2triangle.byte_count();
  }
  return sum + views.size() * sizeof(TimeTree);
}

MovingTree build_moving_tree(std::span<const float> positions, std::uint32_t sets,
                             std::span<const std::uint32_t> tri2vtx, Builder builder,
                             ThreadPool& pool, const Cancel& cancel) {
  constexpr std::size_t kGrain = 1 << 13;
  MeshView mesh;  // positions and triangles alone
  mesh.position_sets = sets;
  mesh.vertex_count = static_cast<std::uint32_t>(positions.size() / 3 / sets);
  mesh.triangle_count = static_cast<std::uint32_t>(tri2vtx.size() / 3);
  mesh.vtx2xyz = positions.data();
  mesh.tri2vtx = tri2vtx.data();
  const std::uint32_t parts = count_time_parts(
      mesh.triangle_count, sets,
      [&](std::size_t i, const TimePart& part) { return box_over(mesh, i, part); },
      [&](std::size_t i, const MotionPlace& place) { return hull(mesh, i, place); });

  MovingTree tree;
  Array<Aabb> boxes(mesh.triangle_count);
  for (std::uint32_t k = 0; k < parts; ++k) {
    const TimePart part = time_part(sets, k, parts);
    pool.for_each_chunk(boxes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      check(cancel);
      for (std::size_t i = begin; i < end; ++i) boxes[i] = box_over(mesh, i, part);
    });
    WideTree wide = build_wide_tree({{}, {}, boxes, {1, kNone}}, builder, pool, cancel);
    tree.bounds = united(tree.bounds, wide.bounds);
    tree.parts.push_back({std::move(wide.nodes), std::move(wide.leaves), wide.depth});
  }
  for (const MovingTree::Part& part : tree.parts) {
    const auto count = static_cast<std::uint32_t>(part.nodes.size());
    tree.views.push_back({{part.nodes.data(), count, part.depth}, part.leaf2triangle.data()});
  }
  return tree;
}

}  // namespace komorebi
