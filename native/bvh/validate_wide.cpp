#include <bit>
#include <cstdint>

#include "bvh/validate.h"
#include "core/triangle.h"

namespace komorebi {
namespace {

/// Walks the wide nodes; `leaf(child, count, box)` returns a complaint or "".
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
    Aabb all;
    for (int i = 0; i < kWidth; ++i) {
      const Aabb box = node.box(i);
      if (box.is_empty()) {
        if (node.count[i] != 0) return name + " has a leaf that no ray meets";
        continue;
      }
      all = united(all, box);
      if (!contains(visit.box, box)) return name + " has a child that leaves its box";
      if (node.count[i] == 0) {
        if (node.child[i] <= visit.node) return name + " has a child that stands before it";
        stack.push_back({node.child[i], visit.level + 1, box});
      } else if (std::string complaint = leaf(node.child[i], node.count[i], box);
                 !complaint.empty()) {
        return complaint;
      }
    }
    if (all.is_empty()) return name + " has no children";
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
  std::vector<bool> placed(count, false), block_seen(tree.blocks.size(), false);
  const auto corner = [&](std::size_t triangle, std::size_t which) {
    const float* xyz = &vtx2xyz[3 * std::size_t{tri2vtx[3 * triangle + which]}];
    return Vec3(xyz[0], xyz[1], xyz[2]);
  };
  const auto leaf = [&](std::uint32_t index, std::uint32_t used, const Aabb& box) -> std::string {
    const std::string name = "block " + std::to_string(index);
    if (index >= tree.blocks.size()) return name + " does not exist";
    if (block_seen[index]) return name + " is in two leaves";
    block_seen[index] = true;
    if (used > kBlockSize) return name + " is too full";
    for (int k = 0; k < kBlockSize; ++k) {
      const std::uint32_t triangle = tree.blocks[index].primitive[k];
      if (static_cast<std::uint32_t>(k) >= used) {
        if (triangle != kNone) return name + " has a triangle too many";
        continue;
      }
      const std::string which = "triangle " + std::to_string(triangle);
      if (triangle >= count) return which + " does not exist";
      if (placed[triangle]) return which + " is in two leaves";
      placed[triangle] = true;
      const Vec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
      if (is_degenerate(a, b, c)) return which + " has no area and is in a leaf";
      if (!same_bits(tree.blocks[index].position(0, k), a) ||
          !same_bits(tree.blocks[index].position(1, k), b) ||
          !same_bits(tree.blocks[index].position(2, k), c)) {
        return which + " has other corners in its block";
      }
      if (!contains(box, triangle_bounds(a, b, c))) return which + " leaves its leaf's box";
      if (!contains(tree.bounds, triangle_bounds(a, b, c))) return which + " leaves the bounds";
    }
    return "";
  };
  if (std::string complaint = walk_wide(tree.nodes, tree.depth, leaf); !complaint.empty()) {
    return complaint;
  }
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
  const auto leaf = [&](std::uint32_t first, std::uint32_t used, const Aabb& box) -> std::string {
    for (std::size_t i = first; i < std::size_t{first} + used; ++i) {
      if (i >= tree.leaf2instance.size()) return "leaf entry " + std::to_string(i) + " is missing";
      const std::uint32_t instance = tree.leaf2instance[i];
      const std::string name = "instance " + std::to_string(instance);
      if (instance >= world_boxes.size()) return name + " does not exist";
      if (placed[instance]) return name + " is in two leaves";
      placed[instance] = true;
      if (!contains(box, world_boxes[instance])) return name + " leaves its leaf's box";
    }
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
