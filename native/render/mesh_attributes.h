#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/scene_view.h"
#include "parallel/array.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// A named array as Blender holds it; only read during the build.
struct AttributeInput {
  std::string name;
  /// kVertex: a row a vertex, key or point; kCorner: a row a corner of a face; kFace: a row a face
  /// or curve.
  AttributeDomain domain = AttributeDomain::kVertex;
  std::uint32_t components = 1;  ///< 1 to 4
  std::span<const float> data;   ///< [rows][components]
};

/// How the rows of a domain become those that a hit finds (AttributeView).
struct AttributeRows {
  AttributeDomain domain = AttributeDomain::kVertex;
  const char* element = "vertex";           ///< what has a row, for messages
  std::size_t given = 0;                    ///< rows that an array of the domain has
  std::span<const std::uint32_t> gather{};  ///< which of them row i is; empty: row i
  std::size_t kept = 0;
};

/// The named arrays of a mesh, immutable and shared by all that have its shading.
class MeshAttributes {
 public:
  /// Numbers that are not finite count as 0 and are told of in warnings().
  /// @param what  names the mesh in messages
  /// @param rows  of the domains that the mesh has
  /// @throws std::invalid_argument naming the mesh and the attribute; Cancelled
  MeshAttributes(const std::string& what, std::span<const AttributeInput> inputs,
                 std::span<const AttributeRows> rows, ThreadPool& pool, const Cancel& cancel);
  MeshAttributes(const MeshAttributes&) = delete;
  MeshAttributes& operator=(const MeshAttributes&) = delete;

  std::span<const AttributeView> views() const { return views_; }
  /// A sentence for each array that had to be mended.
  const std::vector<std::string>& warnings() const { return warnings_; }
  std::size_t byte_count() const;

 private:
  std::vector<std::string> names_;
  std::vector<Array<float>> data_;
  std::vector<AttributeView> views_;
  std::vector<std::string> warnings_;
};

}  // namespace komorebi
