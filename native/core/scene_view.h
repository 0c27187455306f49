#pragma once

#include <cstddef>

#include "core/aabb.h"
#include "core/hit_filter.h"

namespace komorebi {

/// What a mesh's primitives are; all come behind the same records.
enum class PrimitiveKind : std::uint32_t {
  kTriangle = 0,
  kCurve = 1,
  kSphere = 2,
  kMovingTriangle = 3,  ///< of a mesh that deforms: core/moving_triangle.h
};

/// What a curve looks like: flat and turned to every ray, round, or round with straight segments
/// (core/curve.h).
enum class CurveShape : std::uint32_t { kRibbon = 0, kThick = 1, kThickLinear = 2 };

enum InstanceFlag : std::uint32_t {
  kInstanceHoldout = 1u << 0,
  kInstanceShadowCatcher = 1u << 1,
};

struct WideNode;   // bvh/wide_node.h
struct RoundLeaf;  // core/round_leaf.h

/// Where the leaves of a tree over curves or points put theirs.
struct LeafGrid {
  Vec3 origin{0.0f};
  Vec3 step{0.0f};
};

/// A named array on a mesh (UV map, colour, …), laid out so that a hit's primitive, u and v find
/// their place (core/attribute.h).
enum class AttributeDomain : std::uint32_t {
  kVertex,  ///< rows as vertices, keys or points are
  kCorner,  ///< three rows a triangle
  kFace,    ///< a row a primitive: triangle, segment or point
};
struct AttributeView {
  const char* name;
  AttributeDomain domain;
  std::uint32_t components;  ///< floats a row, 1 to 4
  const float* data;
};

/// Where a wide tree starts; node 0 is the root when node_count > 0.
struct TreeView {
  const WideNode* nodes = nullptr;
  std::uint32_t node_count = 0;
  std::uint32_t depth = 0;  ///< of the wide tree; bounds the traversal stack
};

/// The tree of something that deforms for some of the shutter's time: of a mesh
/// (bvh/moving_tree.h), or of curves or points (bvh/round_tree.h).
struct TimeTree {
  TreeView tree;
  const std::uint32_t* leaf2triangle = nullptr;
  const RoundLeaf* leaves = nullptr;
};

/// One mesh as the tracer and the shading read it; spans into memory that Mesh owns.
/// Local space is Blender's object space moved by the mesh's own origin (render/mesh.h).
struct MeshView {
  PrimitiveKind kind = PrimitiveKind::kTriangle;
  Vec3d object_origin{0.0};     ///< of local space, in the object's own
  std::uint32_t stretched = 0;  ///< 1: by its only instance, which stands still (world_normals)
  std::uint32_t triangle_count = 0;
  std::uint32_t vertex_count = 0;
  std::uint32_t position_sets = 1;  ///< 1 = still; n sets of positions or points at even times
  const float* vtx2xyz = nullptr;   ///< [position_sets][vertex_count][3]
  const std::uint32_t* tri2vtx = nullptr;  ///< [triangle_count][3]
  std::uint32_t normal_sets = 1;           ///< 1: the same at all times
  std::uint32_t normal_count = 0;          ///< of a set
  const float* normals = nullptr;  ///< [normal_sets][by vertex or by corner][3]; null: all flat
  const std::uint32_t* tri2normal = nullptr;    ///< [triangle_count][3], rows of `normals`
  const std::uint8_t* tri2smooth = nullptr;     ///< [triangle_count]; null: all smooth if `normals`
  const std::uint16_t* tri2material = nullptr;  ///< [triangles or segments]; null: all slot 0
  const float* tri2uv = nullptr;                ///< [triangles][3][2] or [segments][2]; null: none
  const AttributeView* attributes = nullptr;
  std::uint32_t attribute_count = 0;
  TreeView tree;
  const std::byte* clusters = nullptr;   ///< leaves of the tree: bvh/triangle_cluster.h
  const TimeTree* time_trees = nullptr;  ///< of what deforms, in place of the other
  std::uint32_t time_tree_count = 0;
  // Curves and spheres instead of triangles; primitives are segments (of all curves), or points.
  CurveShape shape = CurveShape::kRibbon;
  std::uint32_t pieces = 1;                    ///< of a segment
  std::uint32_t segment_parts = 1;             ///< leaves that a segment is spread over
  std::uint32_t primitive_count = 0;           ///< segments, or points
  std::uint32_t point_count = 0;               ///< keys of curves, or points
  const float* points = nullptr;               ///< [position_sets][point_count][4]: x, y, z, radius
  const std::uint32_t* segment2key = nullptr;  ///< first key | bits of core/curve.h
  const RoundLeaf* leaves = nullptr;           ///< of the tree
  LeafGrid leaf_grid;
};

/// A moving instance at the end of a segment of its time; in between everything is linear.
struct MotionKey {
  Mat3 world_from_local{1.0f};
  Vec3 position{0.0f};
  Aabb world_bounds;  ///< of the segment that begins here; nobody asks for that of the last key
};

/// Keys of a moving instance, at even times over the shutter.
struct InstanceMotion {
  std::uint32_t first_key = 0;
  std::uint32_t key_count = 0;  ///< at least 2
};

/// Some of a moving instance's segments, which are a leaf of the tree over instances.
struct MotionGroup {
  std::uint32_t instance = 0;
  std::uint32_t first_segment = 0, end_segment = 0;
};

inline constexpr std::uint32_t kNoMotion = (1u << 22) - 1;  ///< the instance stands still

/// One instance of a mesh.  world = world_from_local · local + position
/// and local = local_from_world · (world − position); the difference first, so that distance from
/// the scene's origin costs no precision. One that moves is here as it is at rest, but for its box,
/// which is that of all its time: see instance_at (core/instance_motion.h).
///
/// Scenes have millions of these: what can be had from the rest in a few steps is not kept.
struct InstanceView {
  Mat3 local_from_world{1.0f};
  Vec3 position{0.0f};
  std::uint32_t mesh = 0;
  std::uint32_t mask : 8 = 0xff;          ///< RayMask bits that see it
  std::uint32_t flags : 2 = 0;            ///< InstanceFlag bits
  std::uint32_t motion : 22 = kNoMotion;  ///< which entry of SceneView::motions
  std::uint32_t object_index = 0;         ///< which Blender object it came from
  /// Filled by place_instance() (bvh/instance_tree.h) when matrix and position are known.
  /// Conservative for the traced ray; empty: the instance is never hit.
  Aabb world_bounds;
  Mat3 world_from_local{1.0f};
  std::uint32_t material_slots : 31 = 0;  ///< which list of slots (render/scene_tables.h)
  std::uint32_t filtered : 1 = 0;         ///< its hits count if SceneView::filter says so
};
static_assert(sizeof(InstanceView) == 124);

inline bool is_round(PrimitiveKind kind) {
  return kind == PrimitiveKind::kCurve || kind == PrimitiveKind::kSphere;
}

/// A committed scene, as plain pointers and counts: what kernels get.
struct SceneView {
  const MeshView* meshes = nullptr;
  std::uint32_t mesh_count = 0;
  const InstanceView* instances = nullptr;
  std::uint32_t instance_count = 0;
  TreeView tree;  ///< over instances
  /// What leaves of `tree` are: an instance, or instance_count + an entry of motion_groups.
  const std::uint32_t* leaf2instance = nullptr;
  const InstanceMotion* motions = nullptr;
  const MotionKey* motion_keys = nullptr;
  const MotionGroup* motion_groups = nullptr;
  std::uint32_t motion_group_count = 0;
  bool moves = false;  ///< whether any hit depends on the ray's time
  HitFilter filter;    ///< of instances that are `filtered`
};

}  // namespace komorebi
