#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/vector.h"

namespace komorebi {

inline constexpr std::uint32_t kClusterTriangles = 8;  ///< at most
inline constexpr std::uint32_t kClusterVertices = 8;   ///< at most
/// Clusters begin at multiples of so many bytes; leaves are counted in them.
inline constexpr std::size_t kClusterUnit = 8;
/// Most units in a mesh; one bit of an index is the traversal's.
inline constexpr std::uint64_t kMaxClusterUnits = 0x7fffffffu;
/// What traversal may read behind the last cluster, as it loads eight of everything.
inline constexpr std::size_t kClusterSlack = 64;

/// A leaf of a mesh's tree: up to eight triangles with up to eight vertices between them, copied
/// in. Everything that the triangle test reads stands together, two cache lines in the mean, and
/// triangles that share vertices share them here.
///
/// A record of variable size: triangle count and vertex count (a byte each); per triangle its
/// corners (16 bits: three vertices of three bits); x of the vertices, y, z (floats); per triangle
/// its primitive (the index in the mesh). The floats begin at a multiple of four bytes.
class ClusterView {
 public:
  explicit ClusterView(const std::byte* record) : record_(record) {}

  static constexpr std::size_t coordinates_offset(std::uint32_t triangles) {
    return (2 + 2 * std::size_t{triangles} + 3) / 4 * 4;
  }
  static constexpr std::size_t primitives_offset(std::uint32_t triangles, std::uint32_t vertices) {
    return coordinates_offset(triangles) + 12 * std::size_t{vertices};
  }
  /// Of the record, in kClusterUnit.
  static constexpr std::uint32_t units(std::uint32_t triangles, std::uint32_t vertices) {
    const std::size_t bytes = primitives_offset(triangles, vertices) + 4 * std::size_t{triangles};
    return static_cast<std::uint32_t>((bytes + kClusterUnit - 1) / kClusterUnit);
  }

  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(record_[0]); }
  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(record_[1]); }

  /// [triangle_count] 16-bit entries: vertex of the first corner | second << 3 | third << 6.
  const std::byte* corners() const { return record_ + 2; }
  /// [3][vertex_count] floats.
  const std::byte* coordinates() const { return record_ + coordinates_offset(triangle_count()); }

  std::uint32_t vertex(std::uint32_t triangle, std::uint32_t which) const {
    std::uint16_t three;
    std::memcpy(&three, corners() + 2 * triangle, 2);
    return (three >> (3 * which)) & 7u;
  }
  Vec3 position(std::uint32_t triangle, std::uint32_t which) const {
    const std::uint32_t v = vertex(triangle, which), n = vertex_count();
    return Vec3(coordinate(v), coordinate(n + v), coordinate(2 * n + v));
  }
  std::uint32_t primitive(std::uint32_t triangle) const {
    std::uint32_t index;
    std::memcpy(&index,
                record_ + primitives_offset(triangle_count(), vertex_count()) + 4 * triangle, 4);
    return index;
  }

 private:
  float coordinate(std::uint32_t i) const {
    float x;
    std::memcpy(&x, coordinates() + 4 * std::size_t{i}, 4);
    return x;
  }
  const std::byte* record_;
};

}  // namespace komorebi
