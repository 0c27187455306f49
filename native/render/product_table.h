#pragma once

#include <vector>

#include "core/environment_product.h"

namespace komorebi {

/// The tables of product importance sampling for one map; immutable. They belong to the texels and
/// to normals in the map's own space, so neither strength nor rotation touches them.
class ProductTable {
 public:
  /// `map` must shine somewhere. Of a large map: 32² bins of normals, 32 × 64 cells.
  explicit ProductTable(const EnvironmentView& map);

  ProductView view() const;
  std::size_t byte_count() const;

 private:
  struct Cells;
  void cut(const EnvironmentView& map);
  Cells sum_cells(const EnvironmentView& map);
  void fill_bin(std::uint32_t bin, const Cells& cells);

  std::uint32_t bins_, rows_, columns_;
  std::vector<std::uint32_t> patch_row_, patch_column_;
  std::vector<std::uint32_t> row_cdf_, column_cdf_, patch_row_cdf_;
};

}  // namespace komorebi
