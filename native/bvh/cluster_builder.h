#pragma once

#include <span>

#include "bvh/triangle_cluster.h"

namespace komorebi {

/// A mesh's triangles by index.
struct Triangles {
  std::span<const float> vtx2xyz;
  std::span<const std::uint32_t> tri2vtx;

  std::size_t count() const { return tri2vtx.size() / 3; }
  const float* xyz(std::size_t triangle, std::size_t which) const {
    return &vtx2xyz[3 * std::size_t{tri2vtx[3 * triangle + which]}];
  }
  Vec3 corner(std::size_t triangle, std::size_t which) const {
    const float* p = xyz(triangle, which);
    return Vec3(p[0], p[1], p[2]);
  }
};

/// Gathers triangles for one cluster. Vertices are told apart by their position and not by their
/// index, so that flat-shaded or loose triangles share them too.
class ClusterBuilder {
 public:
  explicit ClusterBuilder(const Triangles& triangles) : triangles_(triangles) {}

  /// False, and nothing is changed that matters any more, if the triangle does not fit in.
  bool add(std::uint32_t triangle);

  std::uint32_t units() const { return ClusterView::units(triangle_count_, vertex_count_); }
  /// Writes units() · kClusterUnit bytes.
  void write(std::byte* record) const;

 private:
  const Triangles& triangles_;
  std::uint32_t triangle_count_ = 0, vertex_count_ = 0;
  const float* vertex_[kClusterVertices];
  std::uint16_t corners_[kClusterTriangles];
  std::uint32_t primitive_[kClusterTriangles];
};

}  // namespace komorebi
