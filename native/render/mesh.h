#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bvh/mesh_tree.h"
#include "bvh/topology.h"
#include "core/scene_view.h"
#include "parallel/array.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// A polygon mesh as Blender holds it; the arrays are only read during the build.
struct MeshInput {
  std::string name;
  std::span<const float> vtx2xyz;               ///< [vertices][3], object space
  std::span<const std::int32_t> corner2vtx;     ///< [corners]
  std::span<const std::int32_t> face_offsets;   ///< [faces + 1], first corner of each face
  std::span<const std::int32_t> tri2corner;     ///< [triangles][3]; empty: triangles and quads only
  std::span<const std::int32_t> tri2face;       ///< [triangles]; empty with tri2corner
  std::span<const float> corner2normal;         ///< [corners][3]
  std::span<const float> vtx2normal;            ///< [vertices][3]; neither: every face is flat
  std::span<const std::uint8_t> face2smooth;    ///< [faces]; empty: every face is smooth
  std::span<const std::int32_t> face2material;  ///< [faces]; empty: slot 0
};

/// A mesh in the tracer's own layout, with its tree: immutable, counted, shared by scenes, frames
/// and view layers. Positions are relative to `origin`: the point of the bounds nearest to the
/// object's own origin when that subtraction is exact for every vertex, else null. So a mesh far
/// from its object's origin costs the rays no precision, and one around it keeps its own.
class Mesh {
 public:
  /// Throws std::invalid_argument naming the mesh and a count, or Cancelled.
  static std::shared_ptr<const Mesh> build(const MeshInput& input, Builder builder,
                                           ThreadPool& pool, const Cancel& cancel);

  /// The same triangles under a matrix that has no inverse (an object scaled flat): transformed
  /// here, because no ray can be taken into such an object's space. `matrix` acts on object space.
  std::shared_ptr<const Mesh> flattened(const Mat4d& matrix, ThreadPool& pool,
                                        const Cancel& cancel) const;

  MeshView view() const;
  const std::string& name() const { return name_; }
  const Vec3d& origin() const { return origin_; }
  const Aabb& bounds() const { return tree_.bounds; }  ///< relative to `origin`, conservative
  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(tri2vtx_.size() / 3); }
  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vtx2xyz_.size() / 3); }
  std::uint32_t degenerate_count() const { return tree_.degenerate_count; }
  const MeshTree& tree() const { return tree_; }
  /// Which corners carry a triangle's UVs and normals, [triangles][3].
  std::vector<std::int32_t> tri2corner() const;
  std::size_t byte_count() const;

 private:
  Mesh() = default;
  void take_positions(std::span<const float> vtx2xyz, ThreadPool& pool);
  void take_triangles(const MeshInput& input, ThreadPool& pool, const Cancel& cancel);
  void take_normals(const MeshInput& input, ThreadPool& pool, const Cancel& cancel);
  void take_materials(const MeshInput& input, ThreadPool& pool, const Cancel& cancel);

  std::string name_;
  Vec3d origin_{0.0};
  Array<float> vtx2xyz_;
  Array<std::uint32_t> tri2vtx_;
  Array<std::uint32_t> tri2corner_;  // empty: triangle t has the corners 3 t, 3 t + 1, 3 t + 2
  Array<float> normals_;             // as they came, by vertex or by corner; empty: flat
  bool normals_by_corner_ = false;
  Array<std::uint8_t> tri2smooth_;
  Array<std::uint16_t> tri2material_;
  MeshTree tree_;
};

}  // namespace komorebi
