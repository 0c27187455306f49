#pragma once

#include <cstdint>
#include <span>

#include "bvh/triangle_cluster.h"
#include "core/triangle.h"

namespace komorebi {

/// How much one leaf holds.
struct LeafLimit {
  std::uint32_t items;
  std::uint32_t vertices;  ///< distinct ones; kNone where items have none
};

/// What a tree is built over: triangles, each with its padded box, or boxes.
struct Items {
  std::span<const float> vtx2xyz;          ///< [V][3]
  std::span<const std::uint32_t> tri2vtx;  ///< [T][3]
  std::span<const Aabb> boxes;             ///< instead of triangles
  LeafLimit leaf{1, kNone};

  bool are_triangles() const { return leaf.vertices != kNone; }
  /// Bytes in which leaves are counted.
  std::size_t leaf_unit() const { return are_triangles() ? kClusterUnit : sizeof(std::uint32_t); }
  std::uint32_t leaf_units(std::uint32_t items_in_it, std::uint32_t vertices_in_it) const {
    return are_triangles() ? ClusterView::units(items_in_it, vertices_in_it) : 1;
  }
  std::size_t count() const { return are_triangles() ? tri2vtx.size() / 3 : boxes.size(); }

  Vec3 corner(std::size_t triangle, std::size_t which) const {
    const float* xyz = &vtx2xyz[3 * std::size_t{tri2vtx[3 * triangle + which]}];
    return Vec3(xyz[0], xyz[1], xyz[2]);
  }

  /// Whether no ray can meet it: a triangle without area, an empty box. It is in no tree.
  bool is_left_out(std::size_t i) const {
    return are_triangles() ? is_degenerate(corner(i, 0), corner(i, 1), corner(i, 2))
                           : boxes[i].is_empty();
  }
  Aabb box(std::size_t i) const {
    return are_triangles() ? triangle_bounds(corner(i, 0), corner(i, 1), corner(i, 2)) : boxes[i];
  }
};

}  // namespace komorebi
