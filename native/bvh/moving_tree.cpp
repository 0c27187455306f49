#include "bvh/moving_tree.h"

#include <algorithm>

#include "bvh/wide_tree.h"
#include "core/moving_triangle.h"
#include "core/triangle.h"
#include "parallel/array.h"

namespace komorebi {
namespace {

constexpr std::uint32_t kMostParts = 16;
constexpr double kWorthGrowth = 2.0;
constexpr std::size_t kSampled = 1 << 13;  ///< triangles that the number of parts is chosen by

Aabb hull(const Corners& at) {
  Aabb box;
  for (const Vec3& p : at.corner) box = united(box, Aabb{p, p});
  return box;
}

/// Positions in time, and the boxes of triangles over a part of it.
struct Sets {
  MeshView mesh;  ///< positions and triangles alone

  /// Contains the padded box of the triangle at every time of part `k` of `parts`. Between two sets
  /// corners move on straight lines; what the fraction and the sum of the two round is relative to
  /// the sets' coordinates, and less than the padding again.
  Aabb box(std::size_t triangle, std::uint32_t k, std::uint32_t parts) const {
    const std::uint32_t last = mesh.position_sets - 1;
    const std::uint32_t first_set = k * last / parts;
    const std::uint32_t end_set = ((k + 1) * last + parts - 1) / parts;
    Aabb box, sets;
    for (std::uint32_t set = first_set; set <= end_set; ++set) {
      const Aabb at = hull(moving_triangle(mesh, triangle, on(set)));
      sets = united(sets, at);
      const bool within = set * parts >= k * last && set * parts <= (k + 1) * last;
      if (within) box = united(box, at);
    }
    box = united(box, hull(moving_triangle(mesh, triangle, begin_of(k, parts))));
    box = united(box, hull(moving_triangle(mesh, triangle, begin_of(k + 1, parts))));
    return padded(box, 2.0f * (max_abs(sets) * kPadding));
  }

  /// Mean area of boxes over that of triangles' own.
  double growth(std::uint32_t parts) const {
    const std::size_t count = mesh.triangle_count, step = count / kSampled + 1;
    double swept = 0.0, own = 0.0;
    for (std::size_t t = 0; t < count; t += step) {
      for (std::uint32_t k = 0; k < parts; ++k) {
        swept += double(half_area(box(t, k, parts)));
        own += double(half_area(hull(moving_triangle(mesh, t, begin_of(k, parts)))));
      }
    }
    return own > 0.0 ? swept / own : 1.0;
  }

 private:
  SetPlace on(std::uint32_t set) const {
    return set + 1 < mesh.position_sets ? SetPlace{set, 0.0f} : SetPlace{set - 1, 1.0f};
  }
  SetPlace begin_of(std::uint32_t k, std::uint32_t parts) const {
    const MotionPlace place = motion_place(mesh.position_sets, double(k) / parts);
    return {place.step, static_cast<float>(place.fraction)};
  }
};

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
  Sets in;
  in.mesh.position_sets = sets;
  in.mesh.vertex_count = static_cast<std::uint32_t>(positions.size() / 3 / sets);
  in.mesh.triangle_count = static_cast<std::uint32_t>(tri2vtx.size() / 3);
  in.mesh.vtx2xyz = positions.data();
  in.mesh.tri2vtx = tri2vtx.data();
  std::uint32_t parts = 1;
  while (parts < kMostParts && in.growth(parts) > kWorthGrowth) parts *= 2;

  MovingTree tree;
  Array<Aabb> boxes(in.mesh.triangle_count);
  for (std::uint32_t k = 0; k < parts; ++k) {
    pool.for_each_chunk(boxes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      check(cancel);
      for (std::size_t i = begin; i < end; ++i) boxes[i] = in.box(i, k, parts);
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
