#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "bvh/instance_tree.h"
#include "bvh/mesh_tree.h"
#include "bvh/traverse.h"
#include "support/mesh_file.h"

namespace komorebi::testing {

/// Meshes and instances with their trees, without the rest of the renderer. Not movable: the view
/// points into it.
class TestScene {
 public:
  explicit TestScene(unsigned threads = 1) : pool_(threads) {}
  TestScene(const TestScene&) = delete;
  TestScene& operator=(const TestScene&) = delete;

  std::uint32_t add_mesh(TriangleMesh mesh, Builder builder = Builder::kLinear) {
    auto entry = std::make_unique<Entry>();
    entry->mesh = std::move(mesh);
    entry->tree =
        build_mesh_tree(entry->mesh.vtx2xyz, entry->mesh.tri2vtx, builder, pool_, cancel_);
    entries_.push_back(std::move(entry));
    return static_cast<std::uint32_t>(entries_.size() - 1);
  }

  /// Local space is moved by `position` after `world_from_local`.
  void add_instance(std::uint32_t mesh, const Mat3d& world_from_local = Mat3d(1.0),
                    const Vec3& position = Vec3(0.0f), std::uint32_t mask = kMaskAll) {
    InstanceView instance;
    instance.world_from_local = Mat3(world_from_local);
    instance.local_from_world = Mat3(glm::inverse(world_from_local));
    instance.position = position;
    instance.mesh = mesh;
    instance.mask = mask & 0xffu;
    place_instance(instance, entries_[mesh]->tree.bounds);
    instances_.push_back(instance);
  }

  /// Hits on these instances count if the filter says so.
  void set_filter(const HitFilter& filter, const std::function<bool(std::uint32_t)>& is_filtered) {
    filter_ = filter;
    for (std::uint32_t i = 0; i < instances_.size(); ++i) instances_[i].filtered = is_filtered(i);
  }

  void commit(Builder builder = Builder::kLinear) {
    std::vector<Aabb> boxes;
    for (const InstanceView& instance : instances_) boxes.push_back(instance.world_bounds);
    tree_ = build_instance_tree(boxes, builder, pool_, cancel_);
    meshes_.clear();
    for (const auto& entry : entries_) {
      MeshView view;
      view.triangle_count = static_cast<std::uint32_t>(entry->mesh.triangle_count());
      view.vertex_count = static_cast<std::uint32_t>(entry->mesh.vtx2xyz.size() / 3);
      view.vtx2xyz = entry->mesh.vtx2xyz.data();
      view.tri2vtx = entry->mesh.tri2vtx.data();
      view.tree = entry->tree.view();
      view.clusters = entry->tree.clusters.data();
      meshes_.push_back(view);
    }
  }

  SceneView view() const {
    SceneView scene;
    scene.meshes = meshes_.data();
    scene.mesh_count = static_cast<std::uint32_t>(meshes_.size());
    scene.instances = instances_.data();
    scene.instance_count = static_cast<std::uint32_t>(instances_.size());
    scene.tree = tree_.view();
    scene.leaf2instance = tree_.leaf2instance.data();
    scene.filter = filter_;
    return scene;
  }

  const TriangleMesh& mesh(std::uint32_t i) const { return entries_[i]->mesh; }
  const MeshTree& tree(std::uint32_t i) const { return entries_[i]->tree; }
  const InstanceTree& instance_tree() const { return tree_; }
  const std::vector<InstanceView>& instances() const { return instances_; }
  ThreadPool& pool() { return pool_; }

 private:
  struct Entry {
    TriangleMesh mesh;
    MeshTree tree;
  };
  ThreadPool pool_;
  Cancel cancel_;
  std::vector<std::unique_ptr<Entry>> entries_;
  std::vector<InstanceView> instances_;
  std::vector<MeshView> meshes_;
  InstanceTree tree_;
  HitFilter filter_;
};

}  // namespace komorebi::testing
