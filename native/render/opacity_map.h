#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene_view.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"
#include "render/clear_programs.h"
#include "render/scene_tables.h"

namespace komorebi {

/// Where on triangles a material is solid, and where it is clear, to all rays: most hits on leaves
/// that are cut out of cards are decided by looking there, without a program. A triangle's
/// barycentric square is cut into cells, of which half lie in the triangle, and the programs are
/// run on intervals over each (shader/program_bounds.h). Where they depend on more than pictures at
/// attributes of the mesh, or a cell holds the edge of a leaf, the map does not know.
///
/// Triangles of which the attributes are the same share their cells, so that a tree of a hundred
/// thousand equal cards has those of one.
class OpacityMap {
 public:
  enum class Cell : std::uint8_t { kUnknown, kSolid, kClear };

  /// How far from 0 or 1 the share that is let through may be where a cell is solid or clear: more
  /// than interpolation between equal texels errs by. Lots as close to the end are no business of
  /// the map's.
  static constexpr float kSure = 1.0f / 4096.0f;

  /// @param clear  of the materials of the tables
  /// Throws Cancelled.
  OpacityMap(const SceneView& scene, const SceneTables& tables,
             std::span<const ClearPrograms> clear, ThreadPool& pool, const Cancel& cancel);

  Cell at(const InstanceView& instance, const Hit& hit) const {
    for (std::uint32_t l = mesh2first_[instance.mesh]; l < mesh2first_[instance.mesh + 1]; ++l) {
      if (lists_[l].material_slots != instance.material_slots) continue;
      const std::uint32_t pattern = tri2pattern_[lists_[l].first_triangle + hit.primitive];
      if (pattern < kFirstPattern) return static_cast<Cell>(pattern);
      return cell(pattern - kFirstPattern, hit.u, hit.v);
    }
    return Cell::kUnknown;
  }

  std::size_t pattern_count() const { return pattern_count_; }
  std::size_t byte_count() const;

 private:
  /// One list of material slots that instances of a mesh have.
  struct List {
    std::uint32_t material_slots;
    std::size_t first_triangle;  // in tri2pattern_
  };
  static constexpr std::uint32_t kFirstPattern = 3;  // below: a Cell, for all of the triangle

  friend class OpacityMapBuilder;

  Cell cell(std::size_t pattern, float u, float v) const {
    if (!(u >= 0.0f && v >= 0.0f && u + v <= 1.0f)) return Cell::kUnknown;
    const auto i = static_cast<std::uint32_t>(u * static_cast<float>(side_));
    const auto j = static_cast<std::uint32_t>(v * static_cast<float>(side_));
    if (i + j >= side_) return Cell::kUnknown;
    const std::size_t at = pattern * cells_ + place(i, j);
    return static_cast<Cell>(bits_[at / 4] >> (2 * (at % 4)) & 3u);
  }
  /// Of a cell among those of its triangle: rows along u, each shorter by one than that before.
  std::size_t place(std::uint32_t i, std::uint32_t j) const {
    return std::size_t{j} * side_ - std::size_t{j} * (j - std::size_t{1}) / 2 + i;
  }

  std::uint32_t side_ = 1;  // cells along an edge, a power of two
  std::size_t cells_ = 1;   // of a triangle; a multiple of 4 are kept
  std::size_t pattern_count_ = 0;
  std::vector<std::uint32_t> mesh2first_;  // [meshes + 1] into lists_
  std::vector<List> lists_;
  std::vector<std::uint32_t> tri2pattern_;
  std::vector<std::uint8_t> bits_;  // [pattern_count_][cells_], four a byte
};

}  // namespace komorebi
