#pragma once

#include <span>
#include <vector>

#include "core/environment_product.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

class SkyPlaces;
class SkyVisibility;

/// The tables of product importance sampling for one map; immutable. They belong to the texels and
/// to normals in the map's own space, so neither strength nor rotation touches them.
class ProductTable {
 public:
  /// `map` must shine somewhere. Of a large map: 32² bins of normals, 32 × 64 cells.
  /// Throws Cancelled.
  explicit ProductTable(const EnvironmentView& map, const Cancel& cancel = Cancel::never());

  /// The same of the same map, for what `visibility` says is seen of it: cells are weighted by the
  /// root of the share of their rays that arrive: the root mean square of 0 and 1.
  ProductTable(const ProductTable& map, const SkyVisibility& visibility, ThreadPool& pool);

  /// Adds tables for what places see, once; `places` outlives the view.
  void add_places(const SkyPlaces& places, ThreadPool& pool);

  ProductView view() const;
  std::size_t byte_count() const;

 private:
  /// What the product needs to know of each cell, [rows][columns].
  struct Cells {
    std::vector<double> energy;  ///< luminance times solid angle, to a common factor
    std::vector<double> solid_angle;
    std::vector<float> centre[3];  ///< where its light comes from in the mean; unit length
    /// The cells of SkyVisibility that kSpread directions all over the cell fall into, corners too.
    std::vector<std::uint32_t> spread_cell;
    std::vector<float> radius;    ///< bound of the angle from the centre to any point of the cell
    std::vector<float> variance;  ///< of the light's angle from the centre, on one axis
  };
  static constexpr std::size_t kSpread = 9;
  void sum_cells(const EnvironmentView& map, const Cancel& cancel);
  /// What cells weigh, given the shares of rays that arrive from SkyVisibility's cells.
  void weigh_cells(std::span<const float> share, std::span<float> seen) const;
  void fill(const SkyVisibility* visibility, ThreadPool& pool);
  void weigh_places(const SkyPlaces& places, std::size_t begin, std::size_t end);
  void fill_bin(std::uint32_t to, std::uint32_t bin, std::uint32_t bins,
                std::span<const float> seen);

  std::uint32_t bins_, rows_, columns_;
  Cells cells_;
  std::vector<std::uint32_t> patch_row_, patch_column_;
  std::vector<std::uint32_t> row_cdf_, column_cdf_, patch_row_cdf_;
  const SkyPlaces* places_ = nullptr;
};

}  // namespace komorebi
