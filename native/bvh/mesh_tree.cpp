#include "bvh/mesh_tree.h"

#include <limits>

#include "bvh/collapse.h"
#include "core/triangle.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = 8192;

/// Corners by triangle index.
struct Triangles {
  std::span<const float> vtx2xyz;
  std::span<const std::uint32_t> tri2vtx;

  std::size_t count() const { return tri2vtx.size() / 3; }
  Vec3 corner(std::size_t triangle, std::size_t which) const {
    const float* xyz = &vtx2xyz[3 * std::size_t{tri2vtx[3 * triangle + which]}];
    return Vec3(xyz[0], xyz[1], xyz[2]);
  }
};

/// Padded box of every triangle; the empty box for a degenerate one.
std::vector<Aabb> boxes_of(const Triangles& triangles, ThreadPool& pool, const Cancel& cancel) {
  std::vector<Aabb> boxes(triangles.count());
  pool.for_each_chunk(boxes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) return;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 a = triangles.corner(i, 0), b = triangles.corner(i, 1), c = triangles.corner(i, 2);
      if (!is_degenerate(a, b, c)) boxes[i] = triangle_bounds(a, b, c);
    }
  });
  check(cancel);
  return boxes;
}

/// Moves the boxes that are not empty to the front, in their order; returns where they came from,
/// or nothing if all stayed (the usual case, which costs no memory).
std::vector<std::uint32_t> drop_empty(std::vector<Aabb>& boxes) {
  std::size_t kept = 0;
  while (kept < boxes.size() && !boxes[kept].is_empty()) ++kept;
  if (kept == boxes.size()) return {};
  std::vector<std::uint32_t> source(kept);
  for (std::size_t i = 0; i < kept; ++i) source[i] = static_cast<std::uint32_t>(i);
  for (std::size_t i = kept; i < boxes.size(); ++i) {
    if (boxes[i].is_empty()) continue;
    boxes[kept++] = boxes[i];
    source.push_back(static_cast<std::uint32_t>(i));
  }
  boxes.resize(kept);
  return source;
}

void fill(TriangleBlock& block, const Triangles& triangles, const Topology& topology,
          const std::vector<std::uint32_t>& source, const LeafRange& leaf) {
  for (std::size_t k = 0; k < kBlockSize; ++k) {
    const bool used = k < leaf.count;
    std::uint32_t triangle = kNone;
    if (used) {
      triangle = topology.order[leaf.first + k];
      if (!source.empty()) triangle = source[triangle];
    }
    block.primitive[k] = triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 p =
          used ? triangles.corner(triangle, corner) : Vec3(std::numeric_limits<float>::quiet_NaN());
      block.corner[corner][0][k] = p.x;
      block.corner[corner][1][k] = p.y;
      block.corner[corner][2][k] = p.z;
    }
  }
}

}  // namespace

TreeView MeshTree::view() const {
  return TreeView{nodes.data(), static_cast<std::uint32_t>(nodes.size()), depth};
}

std::size_t MeshTree::byte_count() const {
  return nodes.capacity() * sizeof(WideNode) + blocks.capacity() * sizeof(TriangleBlock);
}

MeshTree build_mesh_tree(std::span<const float> vtx2xyz, std::span<const std::uint32_t> tri2vtx,
                         Builder builder, ThreadPool& pool, const Cancel& cancel) {
  const Triangles triangles{vtx2xyz, tri2vtx};
  std::vector<Aabb> boxes = boxes_of(triangles, pool, cancel);
  const std::vector<std::uint32_t> source = drop_empty(boxes);

  const Topology topology = build_topology(boxes, builder, pool, cancel);
  WideTree wide = collapse(topology, boxes, kBlockSize, pool, cancel);

  MeshTree tree;
  tree.degenerate_count = static_cast<std::uint32_t>(triangles.count() - boxes.size());
  tree.depth = wide.depth;
  tree.nodes = std::move(wide.nodes);
  tree.blocks.resize(wide.leaves.size());
  pool.for_each_chunk(wide.leaves.size(), kGrain / 4, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) return;
    for (std::size_t i = begin; i < end; ++i) {
      fill(tree.blocks[i], triangles, topology, source, wide.leaves[i]);
    }
  });
  check(cancel);
  if (!tree.nodes.empty()) {
    for (int i = 0; i < kWidth; ++i) tree.bounds = united(tree.bounds, tree.nodes[0].box(i));
  }
  return tree;
}

}  // namespace komorebi
