#include <bit>
#include <cstdint>

#include "bvh/triangle_cluster.h"
#include "bvh/validate.h"
#include "core/triangle.h"

namespace komorebi {
namespace {

/// The part of `a` that is in `b`.
Aabb common(const Aabb& a, const Aabb& b) {
  return Aabb{Vec3(max_of(a.lo.x, b.lo.x), max_of(a.lo.y, b.lo.y), max_of(a.lo.z, b.lo.z)),
              Vec3(min_of(a.hi.x, b.hi.x), min_of(a.hi.y, b.hi.y), min_of(a.hi.z, b.hi.z))};
}

/// Walks the wide nodes; `leaf(child, box)` returns a complaint or "". A child's box may leave its
/// parent's, by a step of the child's grid; what counts is that each item lies in all boxes above
/// it, so `box` is what these have in common.
template <class Leaf>
std::string walk_wide(std::span<const WideNode> nodes, std::uint32_t depth, const Leaf& leaf) {
  struct Visit {
    std::uint32_t node, level;
    Aabb box;
  };
  if (nodes.empty()) return depth == 0 ? "" : "an empty tree has a depth";
  std::vector<bool> seen(nodes.size(), false);
  std::size_t seen_count = 0;
  std::uint32_t deepest = 0;
  Aabb everything;
  everything.lo = Vec3(-kFloatMax);
  everything.hi = Vec3(kFloatMax);
  std::vector<Visit> stack{{0, 1, everything}};
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const std::string name = "wide node " + std::to_string(visit.node);
    if (visit.node >= nodes.size()) return name + " does not exist";
    if (seen[visit.node]) return name + " has two parents";
    seen[visit.node] = true;
    ++seen_count;
    deepest = std::max(deepest, visit.level);
    const WideNode& node = nodes[visit.node];
    if (node.child_count() < 1 || node.child_count() > kWidth) return name + " has no children";
    if (node.inner_count() > node.child_count()) return name + " has more inner children than all";
    for (int i = 0; i < node.child_count(); ++i) {
      const Aabb box = common(visit.box, node.box(i));
      if (box.is_empty()) return name + " has a child that no ray meets";
      if (i < node.inner_count()) {
        stack.push_back({node.child_node(i), visit.level + 1, box});
      } else if (std::string complaint = leaf(node.child_leaf(i), box); !complaint.empty()) {
        return complaint;
      }
    }
  }
  if (seen_count != nodes.size()) return "some wide nodes cannot be reached";
  if (deepest != depth) return "the wide tree's depth is not the one recorded";
  return depth <= kMaxDepth ? "" : "the wide tree is deeper than kMaxDepth";
}

bool same_bits(const Vec3& a, const Vec3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::bit_cast<std::uint32_t>(a[axis]) != std::bit_cast<std::uint32_t>(b[axis]))
      return false;
  }
  return true;
}

}  // namespace

std::string validate(const MeshTree& tree, std::span<const float> vtx2xyz,
                     std::span<const std::uint32_t> tri2vtx) {
  const std::size_t count = tri2vtx.size() / 3;
  std::vector<bool> placed(count, false);
  if (tree.clusters.size() < kClusterSlack && count > 0) return "the clusters have no slack";
  const std::size_t end = count > 0 ? tree.clusters.size() - kClusterSlack : 0;
  std::size_t used = 0;
  const auto corner = [&](std::size_t triangle, std::size_t which) {
    const float* xyz = &vtx2xyz[3 * std::size_t{tri2vtx[3 * triangle + which]}];
    return Vec3(xyz[0], xyz[1], xyz[2]);
  };
  const auto leaf = [&](std::uint32_t index, const Aabb& box) -> std::string {
    const std::string name = "cluster " + std::to_string(index);
    const std::size_t begin = std::size_t{index} * kClusterUnit;
    if (begin + 2 > end) return name + " does not exist";
    const ClusterView cluster(tree.clusters.data() + begin);
    const std::uint32_t triangles = cluster.triangle_count(), vertices = cluster.vertex_count();
    if (triangles < 1 || triangles > kClusterTriangles) return name + " is empty or too full";
    if (vertices < 3 || vertices > kClusterVertices) return name + " has too few or many vertices";
    const std::size_t bytes = ClusterView::units(triangles, vertices) * kClusterUnit;
    if (begin + bytes > end) return name + " is cut off";
    used += bytes;
    for (std::uint32_t k = 0; k < triangles; ++k) {
      const std::uint32_t triangle = cluster.primitive(k);
      const std::string which = "triangle " + std::to_string(triangle);
      if (triangle >= count) return which + " does not exist";
      if (placed[triangle]) return which + " is in two leaves";
      placed[triangle] = true;
      const Vec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
      if (is_degenerate(a, b, c)) return which + " has no area and is in a leaf";
      for (std::uint32_t corners = 0; corners < 3; ++corners) {
        if (cluster.vertex(k, corners) >= vertices) return which + " has a corner too many";
      }
      if (!same_bits(cluster.position(k, 0), a) || !same_bits(cluster.position(k, 1), b) ||
          !same_bits(cluster.position(k, 2), c)) {
        return which + " has other corners in its cluster";
      }
      if (!contains(box, triangle_bounds(a, b, c))) return which + " leaves a box above it";
      if (!contains(tree.bounds, triangle_bounds(a, b, c))) return which + " leaves the bounds";
    }
    return "";
  };
  if (std::string complaint = walk_wide(tree.nodes, tree.depth, leaf); !complaint.empty()) {
    return complaint;
  }
  if (used != end) return "there are bytes between the clusters";
  std::size_t degenerate = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (placed[i]) continue;
    if (!is_degenerate(corner(i, 0), corner(i, 1), corner(i, 2))) {
      return "triangle " + std::to_string(i) + " is in no leaf";
    }
    ++degenerate;
  }
  return degenerate == tree.degenerate_count ? "" : "the degenerate triangles are miscounted";
}

std::string validate(const InstanceTree& tree, std::span<const Aabb> world_boxes) {
  std::vector<bool> placed(world_boxes.size(), false);
  const auto leaf = [&](std::uint32_t entry, const Aabb& box) -> std::string {
    if (entry >= tree.leaf2instance.size()) {
      return "leaf entry " + std::to_string(entry) + " is missing";
    }
    const std::uint32_t instance = tree.leaf2instance[entry];
    const std::string name = "instance " + std::to_string(instance);
    if (instance >= world_boxes.size()) return name + " does not exist";
    if (placed[instance]) return name + " is in two leaves";
    placed[instance] = true;
    if (!contains(box, world_boxes[instance])) return name + " leaves a box above it";
    return "";
  };
  if (std::string complaint = walk_wide(tree.nodes, tree.depth, leaf); !complaint.empty()) {
    return complaint;
  }
  for (std::size_t i = 0; i < world_boxes.size(); ++i) {
    if (placed[i] == world_boxes[i].is_empty()) {
      return "instance " + std::to_string(i) + " is in no leaf, or should be in none";
    }
  }
  return "";
}

}  // namespace komorebi
