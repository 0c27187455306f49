#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bvh/round_tree.h"
#include "parallel/array.h"
#include "render/mesh_attributes.h"

namespace komorebi {

/// Keys or points at other times: as those of MeshInput, with radii.
struct RoundMotion {
  std::span<const float> positions;  ///< [2 k][keys or points][3]; empty: they stand still
  std::span<const float> radii;      ///< [2 k][keys or points]; empty: those do not change
  std::span<const float> steps;      ///< [2][keys or points][3], for the Vector pass; or empty
};

/// Hair and other curves as Blender holds them; the arrays are only read during the build.
struct CurvesInput {
  std::string name;
  std::span<const float> key2xyz;               ///< [keys][3], object space
  std::span<const float> key2radius;            ///< [keys], not negative
  std::span<const std::int32_t> curve_offsets;  ///< [curves + 1], first key of each curve
  CurveShape shape = CurveShape::kRibbon;
  std::uint32_t subdivisions = 2;  ///< a ribbon's segment has 2^subdivisions + 1 pieces
  std::span<const std::int32_t> curve2material;  ///< [curves]; empty: slot 0
  std::span<const float> curve2uv;               ///< [curves][2], where it grows; empty: no UVs
  RoundMotion motion{};
  std::vector<AttributeInput> attributes{};  ///< kVertex: by key; kFace: by curve
};

/// A point cloud: a sphere a point.
struct PointsInput {
  std::string name;
  std::span<const float> point2xyz;     ///< [points][3], object space
  std::span<const float> point2radius;  ///< [points], not negative; 0: it is not there
  RoundMotion motion{};
  std::vector<AttributeInput> attributes{};  ///< kVertex: by point
};

inline constexpr std::uint32_t kMaxSubdivisions = 8;

/// What of curves or points decides where rays hit. Positions are relative to `origin`, as those
/// of MeshGeometry.
struct RoundGeometry {
  PrimitiveKind kind = PrimitiveKind::kCurve;
  CurveShape shape = CurveShape::kRibbon;
  std::uint32_t subdivisions = 0;
  std::uint32_t pieces = 1, segment_parts = 1;
  Vec3d origin{0.0};
  std::uint32_t sets = 1;            ///< of keys or points, at even times; 1: nothing moves
  Array<float> points;               ///< [sets][keys or points][4]: x, y, z, radius
  Array<std::uint32_t> segment2key;  ///< as MeshView has it; empty for points
  RoundTree tree;

  std::uint32_t point_count() const { return static_cast<std::uint32_t>(points.size() / 4 / sets); }
  /// Segments, or points.
  std::uint32_t primitive_count() const {
    return kind == PrimitiveKind::kCurve ? static_cast<std::uint32_t>(segment2key.size())
                                         : point_count();
  }
  std::size_t byte_count() const;
  /// Without normals, which there are none of.
  void fill(MeshView& view) const;
  /// Of all sets.
  void take_points(std::span<const float> xyz, std::span<const float> radius, ThreadPool& pool);
  void take_sets(std::span<const float> xyz, std::span<const float> radius,
                 const RoundMotion& motion, ThreadPool& pool);
  void build_tree(Builder builder, ThreadPool& pool, const Cancel& cancel);
  /// The same under `matrix`, which acts on object space: as Cycles has it, the radius grows by the
  /// cube root of the volume's growth.
  RoundGeometry transformed(const Mat4d& matrix, Builder builder, ThreadPool& pool,
                            const Cancel& cancel) const;
  /// First key of each curve and, at the end, the number of keys.
  std::vector<std::int32_t> curve_offsets() const;
};

/// @throws std::invalid_argument naming the curves or points and a count; Cancelled
RoundGeometry build_curves(const CurvesInput& input, Builder builder, ThreadPool& pool,
                           const Cancel& cancel);
RoundGeometry build_points(const PointsInput& input, Builder builder, ThreadPool& pool,
                           const Cancel& cancel);

}  // namespace komorebi
