#pragma once

#include "core/environment.h"
#include "core/octahedral.h"
#include "core/sky_places.h"

/// Sampling of an environment map in proportion to its product with the clamped cosine of a
/// surface. Normals are put into bins, and for each of these a table over coarse cells of the map
/// holds the cells' energy times the cosine (tables for a discretised set of normals: Clarberg,
/// Jarosz, Akenine-Möller, Jensen, "Wavelet Importance Sampling", SIGGRAPH 2005; Clarberg and
/// Akenine-Möller, "Practical Product Importance Sampling for Direct Illumination", Eurographics
/// 2008). Within a cell the map's own patches decide. All of it is one inverse transform, so that
/// stratified points stay stratified.
namespace komorebi {

/// The tables as plain pointers; made by ProductTable (render/product_table.h). A cell is a
/// rectangle of patches: rows [patch_row[r], patch_row[r + 1]), columns likewise. Cumulative
/// probabilities are in units of 2^-31, as those of EnvironmentView.
struct ProductView {
  std::uint32_t bins = 0;  ///< per side of the octahedral grid of normals in the map's own space
  std::uint32_t rows = 0, columns = 0;          ///< cells
  const std::uint32_t* patch_row = nullptr;     ///< [rows + 1]
  const std::uint32_t* patch_column = nullptr;  ///< [columns + 1]
  /// [bins² and those of places][rows + 1]; all 0 if there is no light.
  const std::uint32_t* row_cdf = nullptr;
  const std::uint32_t* column_cdf = nullptr;  ///< [the same][rows][columns + 1]
  /// Patch rows in a cell: [columns][height + 1 + rows]; cell row r starts at patch_row[r] + r.
  const std::uint32_t* patch_row_cdf = nullptr;
  SkyPlacesView places;  ///< whose bins follow the bins² of the whole scene
};

/// Which of the tables is for surfaces of this normal (world space, unit) at this place.
inline std::uint32_t product_bin(const EnvironmentView& e, const ProductView& p, const Vec3& normal,
                                 const Vec3& at) {
  const Vec3 local = e.texture_from_world * normal;
  const std::uint32_t of_place = table_of_place(p.places, local, at);
  if (of_place != kNoTable) return p.bins * p.bins + of_place;
  return octahedral_cell(local, p.bins);
}

namespace detail {

/// A position in [0, 1) among entries first…last of cumulative numbers: which entry, how far into
/// it, and the entry's share of them all.
struct Selection {
  std::uint32_t entry;
  double fraction, probability;
};

inline Selection select(const std::uint32_t* cdf, std::uint32_t first, std::uint32_t last,
                        double position) {
  const std::uint32_t start = cdf[first];
  const double total = cdf[last] - start;
  const double offset = position * total;
  const double whole = offset < total - 1.0 ? offset : total - 1.0;  // the product may round up
  const std::uint32_t target = start + static_cast<std::uint32_t>(static_cast<std::int32_t>(whole));
  std::uint32_t count = last - first;
  while (count > 1) {
    const std::uint32_t half = count / 2;
    if (cdf[first + half] <= target) first += half;
    count -= half;
  }
  const double width = cdf[first + 1] - cdf[first];
  const double fraction = (offset - (cdf[first] - start)) / width;
  return {first, fraction, width / total};
}

/// The share of one entry among first…last of cumulative numbers, where not all are 0.
inline double share(const std::uint32_t* cdf, std::uint32_t first, std::uint32_t last,
                    std::uint32_t entry) {
  const std::uint32_t total = cdf[last] - cdf[first];
  return total > 0 ? static_cast<double>(cdf[entry + 1] - cdf[entry]) / total : 0.0;
}

/// Which of `cells` even pieces of 0…count an entry is in: piece c begins at ⌊count · c / cells⌋.
inline std::uint32_t cell_of(std::uint32_t entry, std::uint32_t count, std::uint32_t cells) {
  return static_cast<std::uint32_t>(((std::uint64_t{entry} + 1) * cells - 1) / count);
}

/// A fraction as a float below 1.
inline float below_one(double fraction) {
  const auto f = static_cast<float>(fraction);
  return f < kOneMinusEpsilon ? f : kOneMinusEpsilon;
}

}  // namespace detail

/// A direction with density about proportional to radiance · max(0, cos) for surfaces of this
/// normal (world space, unit) at this place, and positive wherever that product is. pdf = 0: there
/// is no light.
inline EnvironmentSample sample_product(const EnvironmentView& e, const ProductView& p,
                                        const Vec3& normal, const Vec3& at, const Bits2& bits) {
  const std::uint32_t bin = product_bin(e, p, normal, at);
  const std::uint32_t* row_cdf = p.row_cdf + bin * (p.rows + 1);
  if (row_cdf[p.rows] == 0) return {normal, Vec3(0.0f), 0.0f};
  const double u = (static_cast<double>(bits.x) + 0.5) * 2.3283064365386963e-10;  // 2^-32
  const double v = (static_cast<double>(bits.y) + 0.5) * 2.3283064365386963e-10;

  const auto row = detail::select(row_cdf, 0, p.rows, v);
  const auto column = detail::select(
      p.column_cdf + (std::uint64_t{bin} * p.rows + row.entry) * (p.columns + 1), 0, p.columns, u);
  const std::uint32_t first_row = p.patch_row[row.entry];
  const std::uint32_t* patch_row_cdf =
      p.patch_row_cdf + column.entry * (e.height + 1 + p.rows) + first_row + row.entry;
  const auto patch_row =
      detail::select(patch_row_cdf, 0, p.patch_row[row.entry + 1] - first_row, row.fraction);
  const std::uint32_t at_row = first_row + patch_row.entry;
  const auto patch_column =
      detail::select(detail::patch_columns(e, at_row), p.patch_column[column.entry],
                     p.patch_column[column.entry + 1], column.fraction);
  const double probability =
      (row.probability * column.probability) * (patch_row.probability * patch_column.probability);
  return detail::sample_patch(e, at_row, patch_column.entry,
                              detail::below_one(patch_column.fraction),
                              detail::below_one(patch_row.fraction), probability);
}

/// The density of sample_product choosing `direction` (world space, unit) for that normal and
/// place.
inline float product_pdf(const EnvironmentView& e, const ProductView& p, const Vec3& normal,
                         const Vec3& at, const Vec3& direction) {
  const std::uint32_t bin = product_bin(e, p, normal, at);
  const std::uint32_t* row_cdf = p.row_cdf + bin * (p.rows + 1);
  if (row_cdf[p.rows] == 0) return 0.0f;
  const auto found = detail::locate(e, e.texture_from_world * direction);
  const std::uint32_t patch_row = found.patch.row, patch_column = found.patch.column;
  const std::uint32_t row = detail::cell_of(patch_row, e.height + 1, p.rows);
  const std::uint32_t column = detail::cell_of(patch_column, e.width, p.columns);
  const std::uint32_t first_row = p.patch_row[row];
  const double probability =
      (detail::share(row_cdf, 0, p.rows, row) *
       detail::share(p.column_cdf + (std::uint64_t{bin} * p.rows + row) * (p.columns + 1), 0,
                     p.columns, column)) *
      (detail::share(p.patch_row_cdf + column * (e.height + 1 + p.rows) + first_row + row, 0,
                     p.patch_row[row + 1] - first_row, patch_row - first_row) *
       detail::share(detail::patch_columns(e, patch_row), p.patch_column[column],
                     p.patch_column[column + 1], patch_column));
  return detail::density_in_patch(e, found.patch, detail::patch_weights(e, found.patch), found.s,
                                  found.z_fraction, probability);
}

}  // namespace komorebi
