#include "bvh/mesh_tree.h"

#include "bvh/triangle_cluster.h"
#include "bvh/wide_tree.h"

namespace komorebi {

TreeView MeshTree::view() const {
  return TreeView{nodes.data(), static_cast<std::uint32_t>(nodes.size()), depth};
}

std::size_t MeshTree::byte_count() const {
  return nodes.byte_count() + clusters.byte_count();
}

MeshTree build_mesh_tree(std::span<const float> vtx2xyz, std::span<const std::uint32_t> tri2vtx,
                         Builder builder, ThreadPool& pool, const Cancel& cancel) {
  const Items items{vtx2xyz, tri2vtx, {}, {kClusterTriangles, kClusterVertices}};
  WideTree wide = build_wide_tree(items, builder, pool, cancel);
  MeshTree tree;
  tree.nodes = std::move(wide.nodes);
  tree.clusters = std::move(wide.clusters);
  tree.depth = wide.depth;
  tree.degenerate_count = wide.left_out;
  tree.bounds = wide.bounds;
  return tree;
}

}  // namespace komorebi
