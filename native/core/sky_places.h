#pragma once

#include "core/octahedral.h"

namespace komorebi {

inline constexpr std::uint32_t kNoTable = 0xffffffffu;

/// Which parts of a scene have tables of their own for directions to the sky: cells of a grid over
/// the space that surfaces lie in, and in each the normals that were found there. Plain pointers;
/// made by SkyPlaces (render/sky_places.h).
struct SkyPlacesView {
  static constexpr std::uint32_t kBins = 16;  ///< per side of the octahedral grid of normals

  Vec3 origin{0.0f};
  float cells_per_length = 0.0f;
  std::uint32_t size[3] = {0, 0, 0};     ///< cells
  const std::uint16_t* place = nullptr;  ///< [z][y][x]: 1 + a place's number, or 0
  const std::uint16_t* table = nullptr;  ///< [place][kBins²]: 1 + a table's number, or 0

  bool exists() const { return place != nullptr; }
};

/// The cell that a place of the scene's space lies in, or kNoTable.
inline std::uint32_t cell_of_place(const SkyPlacesView& v, const Vec3& at) {
  const Vec3 cell = (at - v.origin) * v.cells_per_length;
  for (int a = 0; a < 3; ++a) {
    if (!(cell[a] >= 0.0f && cell[a] < static_cast<float>(v.size[a]))) return kNoTable;
  }
  const auto x = static_cast<std::uint32_t>(cell.x), y = static_cast<std::uint32_t>(cell.y),
             z = static_cast<std::uint32_t>(cell.z);
  return (z * v.size[1] + y) * v.size[0] + x;
}

/// The table for surfaces of this normal (in the map's space, of any length) at a place of the
/// scene's space, or kNoTable.
inline std::uint32_t table_of_place(const SkyPlacesView& v, const Vec3& normal, const Vec3& at) {
  if (!v.exists()) return kNoTable;
  const std::uint32_t cell = cell_of_place(v, at);
  const std::uint32_t place = cell == kNoTable ? 0 : v.place[cell];
  if (place == 0) return kNoTable;
  constexpr std::uint32_t kBins = SkyPlacesView::kBins;
  const std::uint32_t table = v.table[(place - 1) * kBins * kBins + octahedral_cell(normal, kBins)];
  return table == 0 ? kNoTable : table - 1;
}

}  // namespace komorebi
