#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scene_view.h"
#include "render/mesh_geometry.h"
#include "render/round_geometry.h"

namespace komorebi {

/// A mesh in the tracer's own layout, with its tree: immutable, counted, shared by scenes, frames
/// and view layers. In place of triangles it can hold curves or points (`round`).
class Mesh {
 public:
  /// Throws std::invalid_argument naming the mesh and a count, or Cancelled. With `same_geometry`,
  /// a mesh built from the same positions and faces, its tree is shared and none is built.
  static std::shared_ptr<const Mesh> build(const MeshInput& input, Builder builder,
                                           ThreadPool& pool, const Cancel& cancel,
                                           const Mesh* same_geometry = nullptr);

  static std::shared_ptr<const Mesh> build(const CurvesInput& input, Builder builder,
                                           ThreadPool& pool, const Cancel& cancel);
  static std::shared_ptr<const Mesh> build(const PointsInput& input, Builder builder,
                                           ThreadPool& pool, const Cancel& cancel);

  /// The same triangles under a matrix that has no inverse (an object scaled flat): transformed
  /// here, because no ray can be taken into such an object's space. `matrix` acts on object space.
  /// Also curves and points under any matrix.
  std::shared_ptr<const Mesh> flattened(const Mat4d& matrix, ThreadPool& pool,
                                        const Cancel& cancel) const;

  /// The same with a tree by another builder. Throws Cancelled.
  std::shared_ptr<const Mesh> rebuilt(Builder builder, ThreadPool& pool,
                                      const Cancel& cancel) const;

  MeshView view() const;
  /// MeshInput::step_positions, or those of keys or points, in local space; or null.
  const float* step_positions() const { return step_xyz_.empty() ? nullptr : step_xyz_.data(); }
  const std::string& name() const { return name_; }
  const Vec3d& origin() const { return round_ ? round_->origin : geometry_->origin; }
  /// Relative to `origin`, conservative.
  const Aabb& bounds() const { return round_ ? round_->tree.bounds : tree().bounds; }
  /// Curves or points in place of triangles, or null.
  const RoundGeometry* round() const { return round_.get(); }
  std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(geometry_->triangle_count());
  }
  std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(geometry_->vertex_count());
  }
  std::uint32_t degenerate_count() const { return tree().degenerate_count; }
  const MeshTree& tree() const { return geometry_->tree; }
  std::size_t node_count() const {
    return round_ ? round_->tree.node_count()
                  : geometry_->tree.nodes.size() + geometry_->moving_tree.node_count();
  }
  std::uint32_t depth() const {
    if (round_) return round_->tree.depth();
    return deforms() ? geometry_->moving_tree.depth() : geometry_->tree.depth;
  }
  /// Whether its vertices, keys or points move while the shutter is open.
  bool deforms() const { return (round_ ? round_->sets : geometry_->sets) > 1; }
  /// Triangles, segments of curves, or points.
  std::uint32_t primitive_count() const {
    return round_ ? round_->primitive_count() : triangle_count();
  }
  /// Which corners carry a triangle's UVs and normals, [triangles][3].
  std::vector<std::int32_t> tri2corner() const;
  /// Null: none.
  const MeshAttributes* attributes() const { return attributes_.get(); }
  std::size_t byte_count() const;

 private:
  Mesh() = default;
  void take_shading(const Mesh& other);
  void take_shading(const CurvesInput& input);
  Mesh(std::string name, RoundGeometry round)
      : name_(std::move(name)),
        geometry_(std::make_shared<const MeshGeometry>()),
        round_(std::make_shared<const RoundGeometry>(std::move(round))) {}
  void take_normals(const MeshInput& input, ThreadPool& pool, const Cancel& cancel);
  void take_materials(const MeshInput& input, ThreadPool& pool, const Cancel& cancel);
  void take_uvs(const MeshInput& input, ThreadPool& pool, const Cancel& cancel);
  void take_attributes(const MeshInput& input, ThreadPool& pool, const Cancel& cancel);
  void take_attributes(const CurvesInput& input, ThreadPool& pool, const Cancel& cancel);
  void take_attributes(const PointsInput& input, ThreadPool& pool, const Cancel& cancel);
  void take_steps(std::span<const float> positions, ThreadPool& pool, const Cancel& cancel);

  std::string name_;
  std::shared_ptr<const MeshGeometry> geometry_;  // empty where there are curves or points
  std::shared_ptr<const RoundGeometry> round_;
  // By vertex or by corner, as they came; of a mesh that deforms once a set, or the same at all
  // times. Empty: flat.
  Array<float> normals_;
  std::uint32_t normal_sets_ = 1;
  const std::uint32_t* tri2normal_ = nullptr;  // into geometry_, or every_corner_
  Array<std::uint32_t> every_corner_;          // 0, 1, 2 …
  Array<std::uint8_t> tri2smooth_;
  Array<std::uint16_t> tri2material_;                 // of curves by segment
  Array<float> tri2uv_;                               // [triangles][3][2]; of curves [segments][2]
  std::shared_ptr<const MeshAttributes> attributes_;  // null: none
  Array<float> step_xyz_;  // [2][vertices, keys or points][3], relative to the origin
};

}  // namespace komorebi
