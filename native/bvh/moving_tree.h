#pragma once

#include <span>
#include <vector>

#include "bvh/topology.h"
#include "bvh/wide_node.h"
#include "core/scene_view.h"
#include "parallel/late_array.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// A deforming mesh's trees: one for each of some even parts of the shutter's time, over boxes that
/// hold a triangle for all of that part. Leaves are single triangles, whose corners are read from
/// the sets of positions.
///
/// There are as many as count_time_parts finds worth it: a box of twice a triangle's own area costs
/// a ray about as much again, and a tree is some twenty bytes a triangle, less than a set of
/// positions and its normals.
struct MovingTree {
  struct Part {
    LateArray<WideNode> nodes;
    LateArray<std::uint32_t> leaf2triangle;
    std::uint32_t depth = 0;
  };
  std::vector<Part> parts;
  std::vector<TimeTree> views;  ///< of them
  Aabb bounds;                  ///< of all time; empty if there is no triangle

  std::size_t node_count() const;
  std::uint32_t depth() const;
  std::size_t byte_count() const;
};

/// @param positions  [sets][V][3] at even times, finite; at least two sets
/// @param tri2vtx  [T][3] corner indices, each < V
/// @throws Cancelled; std::invalid_argument for too many triangles
MovingTree build_moving_tree(std::span<const float> positions, std::uint32_t sets,
                             std::span<const std::uint32_t> tri2vtx, Builder builder,
                             ThreadPool& pool, const Cancel& cancel);

}  // namespace komorebi
