#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bvh/mesh_tree.h"
#include "bvh/moving_tree.h"
#include "parallel/array.h"
#include "render/mesh_attributes.h"

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
  std::span<const float> corner2uv;             ///< [corners][2]; empty: no UV map
  std::vector<AttributeInput> attributes;       ///< named arrays that materials ask for
  /// Of a mesh that deforms: positions at the other times, [2 k][vertices][3] in their order.
  /// `vtx2xyz` are those in the middle; all together are at even times over the shutter.
  std::span<const float> motion_positions;
  std::span<const float> motion_normals;  ///< [2 k][rows of normals][3]; empty: those do not change
  /// Positions a step of time before and after, [2][vertices][3], for the Vector pass of a mesh
  /// that stands still while the shutter is open; or empty.
  std::span<const float> step_positions;

  /// At how many times there are positions.
  std::uint32_t set_count() const {
    return vtx2xyz.empty()
               ? 1
               : static_cast<std::uint32_t>(1 + motion_positions.size() / vtx2xyz.size());
  }
};

/// What of a mesh decides where rays hit: positions, triangles and the tree over them. Apart from
/// the shading, so that meshes which differ in normals or materials alone share it: Blender 3.4
/// adds up normals in the order of its threads, and so has others each time it evaluates a mesh.
///
/// Positions are relative to `origin`: the point of the bounds nearest to the object's own origin
/// when that subtraction is exact for every vertex, else null. So a mesh far from its object's
/// origin costs the rays no precision, and one around it keeps its own.
struct MeshGeometry {
  Vec3d origin{0.0};
  std::uint32_t sets = 1;        ///< of positions, at even times; 1: nothing moves
  Array<float> vtx2xyz;          ///< [sets][vertices][3]
  Array<std::uint32_t> tri2vtx;  ///< [triangles][3]
  Array<std::uint32_t>
      tri2corner;          ///< [triangles][3]; empty: triangle t has corners 3 t to 3 t + 2
  MeshTree tree;           ///< of one that deforms: its box alone
  MovingTree moving_tree;  ///< of one that deforms

  std::size_t vertex_count() const { return vtx2xyz.size() / 3 / sets; }
  std::size_t triangle_count() const { return tri2vtx.size() / 3; }
  std::size_t byte_count() const;
  /// Fills vtx2xyz and origin.
  void take_positions(std::span<const float> positions, ThreadPool& pool);
  /// From positions and triangles.
  void build_tree(Builder builder, ThreadPool& pool, const Cancel& cancel);
  /// Fills tri2vtx and tri2corner.
  void take_triangles(const MeshInput& input, ThreadPool& pool, const Cancel& cancel);
};

/// Sets at all times in their order, from those at the others and the one in the middle.
std::vector<float> in_order(std::span<const float> others, std::span<const float> rest);

/// `input` has passed check_mesh. Throws Cancelled.
MeshGeometry build_geometry(const MeshInput& input, Builder builder, ThreadPool& pool,
                            const Cancel& cancel);

}  // namespace komorebi
