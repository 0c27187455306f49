#pragma once

#include <span>
#include <string>

#include "bvh/instance_tree.h"
#include "bvh/mesh_tree.h"
#include "bvh/topology.h"

namespace komorebi {

// Each looks at a whole structure and returns what is wrong first, or an empty string. They trust
// no index, so that a broken tree is reported and not followed.

/// Every item in exactly one leaf; ranges, children, depth and root right; every node's box
/// contains its children's.
std::string validate(const Topology& topology, std::span<const Aabb> boxes);

/// Every triangle that is not degenerate in exactly one leaf, with its own corners; the others in
/// none, and counted; all boxes above a triangle contain it; depth and node order right.
std::string validate(const MeshTree& tree, std::span<const float> vtx2xyz,
                     std::span<const std::uint32_t> tri2vtx);

/// Every instance whose box is not empty in exactly one leaf, and inside all boxes above.
std::string validate(const InstanceTree& tree, std::span<const Aabb> world_boxes);

}  // namespace komorebi
