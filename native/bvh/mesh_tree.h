#pragma once

#include <span>

#include "bvh/topology.h"
#include "bvh/triangle_cluster.h"
#include "bvh/wide_node.h"
#include "core/scene_view.h"
#include "parallel/late_array.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// A mesh's triangles as traversal reads them: wide nodes whose leaves are clusters of up to eight
/// triangles. Nothing else of the mesh is read to find a hit. Immutable after the build.
struct MeshTree {
  LateArray<WideNode> nodes;
  /// Cluster records (bvh/triangle_cluster.h), one behind the other, and kClusterSlack bytes. A
  /// leaf is counted in kClusterUnit from the start.
  LateArray<std::byte> clusters;
  std::uint32_t depth = 0;
  /// Triangles without area: they are in no leaf and never hit, but keep their index.
  std::uint32_t degenerate_count = 0;
  Aabb bounds;  ///< of all padded triangle boxes, local space; empty if there is nothing to hit

  TreeView view() const;
  std::size_t byte_count() const;
};

/// @param vtx2xyz  [V][3] positions, finite
/// @param tri2vtx  [T][3] corner indices, each < V
/// @throws Cancelled; std::invalid_argument for too many triangles
MeshTree build_mesh_tree(std::span<const float> vtx2xyz, std::span<const std::uint32_t> tri2vtx,
                         Builder builder, ThreadPool& pool, const Cancel& cancel);

}  // namespace komorebi
