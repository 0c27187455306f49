#pragma once

#include <span>

#include "core/aabb.h"
#include "core/morton.h"

namespace komorebi {

/// Cubic cells, 2^bits along the longest side of a box.
struct CellGrid {
  Vec3 lo{0.0f};
  float cells_per_unit = 0.0f;
  float cells = 0.0f;

  CellGrid() = default;
  CellGrid(const Aabb& box, int bits);

  /// The cell of one coordinate; what lies outside (or is no number) goes to the nearest cell.
  std::uint32_t cell(float x, int axis) const {
    const float scaled = (x - lo[axis]) * cells_per_unit;
    if (!(scaled > 0.0f)) return 0;
    return static_cast<std::uint32_t>(scaled < cells - 1.0f ? scaled : cells - 1.0f);
  }
};

/// How items get their Morton codes.
///
/// One grid over everything fails when something small stands in something vast: with a triangle
/// 10 km away, even 2²¹ cells a side leave 40 for a statue. So the cells are laid over the core,
/// where nearly all centres are (known from a sample); what lies outside has a code of its own in a
/// coarse grid over everything, behind all codes of the core: the root of the tree parts the two.
struct MortonGrid {
  Aabb core;
  CellGrid core_grid;
  CellGrid outer_grid;
  bool wide = false;    ///< 63-bit codes; 30 otherwise
  bool is_one = false;  ///< nothing lies outside the core

  bool in_core(const Vec3& p) const {
    return p.x >= core.lo.x && p.y >= core.lo.y && p.z >= core.lo.z && p.x <= core.hi.x &&
           p.y <= core.hi.y && p.z <= core.hi.z;
  }
  std::uint32_t code_30(const Aabb& box) const;  ///< 31 bits with that of the outer grid
  std::uint64_t code_63(const Aabb& box) const;  ///< 64 bits
};

/// From the extent of all centres (or more) and a sample of the boxes. 63-bit codes are chosen when
/// more than one box in 64 is smaller than 1/16 of a 30-bit cell: then hundreds may share a cell,
/// more than a builder parts by other means.
MortonGrid choose_morton_grid(const Aabb& all, std::span<const Aabb> sample);

}  // namespace komorebi
