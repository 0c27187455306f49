#include "bvh/mesh_tree.h"

#include <stdexcept>

#include "bvh/cluster_builder.h"
#include "bvh/collapse.h"
#include "core/triangle.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = 8192;

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

/// Puts a run of positions of `topology.order` into a builder; false if they are too many.
bool gather(const Topology& topology, const std::vector<std::uint32_t>& source, LeafRange range,
            ClusterBuilder& cluster) {
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
    const std::uint32_t item = topology.order[i];
    if (!cluster.add(source.empty() ? item : source[item])) return false;
  }
  return true;
}

/// Which subtrees fit into one cluster.
std::vector<std::uint8_t> fitting(const Topology& topology,
                                  const std::vector<std::uint32_t>& source,
                                  const Triangles& triangles, ThreadPool& pool,
                                  const Cancel& cancel) {
  std::vector<std::uint8_t> fits(topology.left.size(), 0);
  pool.for_each_chunk(fits.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) return;
    for (std::size_t i = begin; i < end; ++i) {
      const LeafRange range{topology.first[i], topology.last[i] - topology.first[i] + 1};
      ClusterBuilder cluster(triangles);
      if (range.count <= kClusterTriangles && gather(topology, source, range, cluster)) fits[i] = 1;
    }
  });
  check(cancel);
  return fits;
}

/// Writes the leaves of `wide` behind each other and makes its nodes point at them.
std::vector<std::byte> write_clusters(WideTree& wide, const Topology& topology,
                                      const std::vector<std::uint32_t>& source,
                                      const Triangles& triangles, ThreadPool& pool,
                                      const Cancel& cancel) {
  const std::size_t count = wide.leaves.size();
  std::vector<std::uint64_t> place(count + 1, 0);  // in kClusterUnit
  pool.for_each_chunk(count, kGrain / 4, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) return;
    for (std::size_t i = begin; i < end; ++i) {
      ClusterBuilder cluster(triangles);
      gather(topology, source, wide.leaves[i], cluster);
      place[i + 1] = cluster.units();
    }
  });
  check(cancel);
  for (std::size_t i = 0; i < count; ++i) place[i + 1] += place[i];
  if (place[count] > kMaxClusterUnits) throw std::invalid_argument("a mesh has too many triangles");
  std::vector<std::byte> clusters(place[count] * kClusterUnit + kClusterSlack);
  pool.for_each_chunk(count, kGrain / 4, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) return;
    for (std::size_t i = begin; i < end; ++i) {
      ClusterBuilder cluster(triangles);
      gather(topology, source, wide.leaves[i], cluster);
      cluster.write(clusters.data() + place[i] * kClusterUnit);
    }
  });
  pool.for_each_chunk(wide.nodes.size(), kGrain / 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      WideNode& node = wide.nodes[n];
      const std::uint64_t first = place[node.first_leaf];
      for (int k = node.inner_count(); k < node.child_count(); ++k) {
        node.leaf[k] = static_cast<std::uint8_t>(place[node.child_leaf(k)] - first);
      }
      node.first_leaf = static_cast<std::uint32_t>(first);
    }
  });
  check(cancel);
  return clusters;
}

}  // namespace

TreeView MeshTree::view() const {
  return TreeView{nodes.data(), static_cast<std::uint32_t>(nodes.size()), depth};
}

std::size_t MeshTree::byte_count() const {
  return nodes.capacity() * sizeof(WideNode) + clusters.capacity();
}

MeshTree build_mesh_tree(std::span<const float> vtx2xyz, std::span<const std::uint32_t> tri2vtx,
                         Builder builder, ThreadPool& pool, const Cancel& cancel) {
  const Triangles triangles{vtx2xyz, tri2vtx};
  std::vector<Aabb> boxes = boxes_of(triangles, pool, cancel);
  const std::vector<std::uint32_t> source = drop_empty(boxes);

  const Topology topology = build_topology(boxes, builder, pool, cancel);
  WideTree wide =
      collapse(topology, boxes, fitting(topology, source, triangles, pool, cancel), pool, cancel);

  MeshTree tree;
  tree.degenerate_count = static_cast<std::uint32_t>(triangles.count() - boxes.size());
  tree.depth = wide.depth;
  tree.clusters = write_clusters(wide, topology, source, triangles, pool, cancel);
  tree.nodes = std::move(wide.nodes);
  for (const Aabb& box : boxes) tree.bounds = united(tree.bounds, box);
  return tree;
}

}  // namespace komorebi
