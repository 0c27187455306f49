#include "bvh/cluster_builder.h"

namespace komorebi {

bool ClusterBuilder::add(std::uint32_t triangle) {
  if (triangle_count_ == kClusterTriangles) return false;
  std::uint32_t corners = 0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const float* xyz = triangles_.xyz(triangle, k);
    std::uint32_t v = 0;
    while (v < vertex_count_ && vertex_[v] != xyz &&
           std::memcmp(vertex_[v], xyz, 3 * sizeof(float)) != 0) {
      ++v;
    }
    if (v == vertex_count_) {
      if (vertex_count_ == kClusterVertices) return false;
      vertex_[vertex_count_++] = xyz;
    }
    corners |= v << (3 * k);
  }
  corners_[triangle_count_] = static_cast<std::uint16_t>(corners);
  primitive_[triangle_count_++] = triangle;
  return true;
}

void ClusterBuilder::write(std::byte* record) const {
  std::memset(record, 0, std::size_t{units()} * kClusterUnit);
  record[0] = static_cast<std::byte>(triangle_count_);
  record[1] = static_cast<std::byte>(vertex_count_);
  std::memcpy(record + 2, corners_, 2 * std::size_t{triangle_count_});
  std::byte* out = record + ClusterView::coordinates_offset(triangle_count_);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::uint32_t v = 0; v < vertex_count_; ++v, out += 4) {
      std::memcpy(out, vertex_[v] + axis, 4);
    }
  }
  std::memcpy(out, primitive_, 4 * std::size_t{triangle_count_});
}

}  // namespace komorebi
