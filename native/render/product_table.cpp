#include "render/product_table.h"

#include <algorithm>
#include <cmath>

#include "core/aabb.h"
#include "parallel/thread_pool.h"
#include "render/quantized_cdf.h"
#include "render/sky_places.h"
#include "render/sky_visibility.h"

namespace komorebi {
namespace {

constexpr std::uint32_t kBins = 32, kRows = 32, kColumns = 64;

/// A share of the map's mean radiance is added where the map shines: what is bright may be hidden
/// (the sun, from inside a room), and what is seen then has rays enough.
constexpr double kMeanShare = 0.25;

/// No cell weighs less than this share of what the largest cosine in it would give: no normal in
/// the bin meets light that is hardly ever sampled. It also bounds a sample by the film's limit.
constexpr float kLeastShare = 0.5f;

/// Hidden parts of the sky keep this weight: what was measured holds for most points, not for all.
constexpr float kLeastSeen = 0.04f;

/// The angle between two directions of any length.
double angle(const Vec3d& a, const Vec3d& b) {
  return atan2_radians(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

std::vector<std::uint32_t> even_cuts(std::uint32_t count, std::uint32_t pieces) {
  std::vector<std::uint32_t> cuts;
  for (std::uint32_t i = 0; i <= pieces; ++i) {
    cuts.push_back(static_cast<std::uint32_t>(std::uint64_t{count} * i / pieces));
  }
  return cuts;
}

/// What a cell's energy weighs for a bin whose middle has this cosine with the cell's centre: the
/// root mean square of the clamped cosine, when it is spread evenly about that one with the given
/// variance. No normal in the bin and no point of the cell are farther apart than by `reach` less,
/// so nothing that can be lit weighs nothing. Without branches, for the compiler's sake.
float cosine_weight(float cosine, float reach, float variance) {
  const float largest = min_of(cosine + reach, 1.0f);
  const float spread = std::sqrt(3.0f * variance);
  const float above = max_of(cosine + spread, 0.0f);
  const float whole = cosine * cosine + variance;
  const float clipped = above * above * above / (6.0f * spread);
  const float weight = max_of(std::sqrt(cosine < spread ? clipped : whole), kLeastShare * largest);
  return largest > 0.0f ? weight : 0.0f;
}

/// Of the map's patch edge `column`, or of a place between two, as a direction at height z.
Vec3d edge_point(const EnvironmentView& map, double column, double z) {
  const auto [sin_phi, cos_phi] = sin_cos_turns(0.5 - (column + 0.5) / map.width);
  const double r = std::sqrt((1.0 - z) * (1.0 + z));
  return Vec3d(r * cos_phi, r * sin_phi, z);
}

/// A direction of the bin, (0, 0) and (1, 1) being opposite corners of it; of unit length.
Vec3d in_bin(std::uint32_t bin, std::uint32_t bins, double x, double y) {
  const std::uint32_t bin_column = bin % bins, bin_row = bin / bins;
  const double column = bin_column + x, row = bin_row + y;
  const Vec2 at(Vec3d(2.0 * column / bins - 1.0, 2.0 * row / bins - 1.0, 0));
  return glm::normalize(Vec3d(direction_from_octahedral(at)));
}

}  // namespace

ProductTable::ProductTable(const EnvironmentView& map, const Cancel& cancel)
    : bins_(kBins),
      rows_(std::min(kRows, map.height + 1)),
      columns_(std::min(kColumns, map.width)) {
  patch_row_ = even_cuts(map.height + 1, rows_);
  patch_column_ = even_cuts(map.width, columns_);
  sum_cells(map, cancel);
  ThreadPool pool(0);  // once a map
  fill(nullptr, pool);
}

ProductTable::ProductTable(const ProductTable& map, const SkyVisibility& visibility,
                           ThreadPool& pool)
    : bins_(map.bins_),
      rows_(map.rows_),
      columns_(map.columns_),
      cells_(map.cells_),
      patch_row_(map.patch_row_),
      patch_column_(map.patch_column_),
      patch_row_cdf_(map.patch_row_cdf_) {
  fill(&visibility, pool);
}

void ProductTable::fill(const SkyVisibility* visibility, ThreadPool& pool) {
  row_cdf_.resize(std::size_t{bins_} * bins_ * (rows_ + 1));
  column_cdf_.resize(std::size_t{bins_} * bins_ * rows_ * (columns_ + 1));
  const std::size_t cells = cells_.energy.size();
  std::vector<float> seen(SkyVisibility::kSides * cells, 1.0f);
  std::vector<float> share(std::size_t{SkyVisibility::kGrid} * SkyVisibility::kGrid);
  for (std::uint32_t side = 0; visibility != nullptr && side < SkyVisibility::kSides; ++side) {
    for (std::uint32_t i = 0; i < share.size(); ++i) share[i] = visibility->share_of_cell(side, i);
    weigh_cells(share, {&seen[side * cells], cells});
  }
  pool.for_each_chunk(std::size_t{bins_} * bins_, 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t bin = begin; bin < end; ++bin) {
      const std::uint32_t side =
          SkyVisibility::side(Vec3(in_bin(static_cast<std::uint32_t>(bin), bins_, 0.5, 0.5)));
      const auto at = static_cast<std::uint32_t>(bin);
      fill_bin(at, at, bins_, {&seen[side * cells], cells});
    }
  });
}

void ProductTable::sum_cells(const EnvironmentView& map, const Cancel& cancel) {
  Cells& cells = cells_;
  const std::size_t strip = map.height + 1 + rows_;
  patch_row_cdf_.resize(columns_ * strip);
  std::vector<double> row_energy;
  std::vector<SinCos<double>> angles(map.width);
  for (std::uint32_t c = 0; c < map.width; ++c) {
    angles[c] = sin_cos_turns(0.5 - (c + 1.0) / map.width);
  }
  for (std::uint32_t r = 0; r < rows_; ++r) {
    for (std::uint32_t c = 0; c < columns_; ++c) {
      cancel.check();
      Vec3d sum(0.0);
      row_energy.clear();
      for (std::uint32_t y = patch_row_[r]; y < patch_row_[r + 1]; ++y) {
        const double height = map.row_z[y + 1] - map.row_z[y];
        const double z = 0.5 * (map.row_z[y] + map.row_z[y + 1]);
        const double radius = std::sqrt((1.0 - z) * (1.0 + z));
        double energy = 0.0;
        Vec3d along(0.0);
        for (std::uint32_t x = patch_column_[c]; x < patch_column_[c + 1]; ++x) {
          const auto w = detail::patch_weights(map, detail::environment_patch(map, y, x));
          const double e = 0.25 * ((double{w.low_left} + double{w.low_right}) +
                                   (double{w.high_left} + double{w.high_right}));
          energy += e;
          along += e * Vec3d(radius * angles[x].cos, radius * angles[x].sin, z);
        }
        row_energy.push_back(energy * height);
        sum += height * along;
      }
      const double energy =
          quantize_cdf(row_energy, &patch_row_cdf_[c * strip + patch_row_[r] + r]);
      const double z0 = map.row_z[patch_row_[r]], z1 = map.row_z[patch_row_[r + 1]];
      const double length = glm::length(sum);
      const std::uint32_t patches = patch_column_[c + 1] - patch_column_[c];
      const bool narrow = 4 * patches <= map.width;  // the corners are then its farthest points
      const bool has_centre = narrow && length > 1e-3 * energy;
      const Vec3d centre = has_centre ? sum / length : Vec3d(0.0, 0.0, 1.0);
      double radius = kPi;
      if (has_centre) {
        radius = 0.0;
        for (const std::uint32_t edge : {patch_column_[c], patch_column_[c + 1]}) {
          for (const double z : {z0, z1}) {
            radius = std::max(radius, angle(centre, edge_point(map, edge, z)));
          }
        }
      }
      const double mean_cosine = has_centre ? std::min(1.0, length / energy) : 0.0;
      for (const double x : {0.0, 0.5, 1.0}) {
        for (const double y : {0.0, 0.5, 1.0}) {
          const Vec3 at(edge_point(map, patch_column_[c] + x * patches, z0 + y * (z1 - z0)));
          cells.spread_cell.push_back(octahedral_cell(at, SkyVisibility::kGrid));
        }
      }
      cells.energy.push_back(energy);
      cells.solid_angle.push_back(patches * (z1 - z0));
      for (int a = 0; a < 3; ++a) cells.centre[a].push_back(static_cast<float>(centre[a]));
      cells.radius.push_back(static_cast<float>(radius) + 1e-4f);
      cells.variance.push_back(static_cast<float>(1.0 - mean_cosine * mean_cosine) * 0.5f);
    }
  }
  double energy = 0.0, solid_angle = 0.0;
  for (const double e : cells.energy) energy += e;
  for (const double s : cells.solid_angle) solid_angle += s;
  for (std::size_t i = 0; i < cells.energy.size(); ++i) {
    if (cells.energy[i] > 0.0) {
      cells.energy[i] += kMeanShare * (energy / solid_angle) * cells.solid_angle[i];
    }
  }
}

/// A cell may be seen in part: what is seen most in it counts, else that part would have few rays
/// of great weight.
void ProductTable::weigh_cells(std::span<const float> share, std::span<float> seen) const {
  for (std::size_t cell = 0; cell < seen.size(); ++cell) {
    float greatest = 0.0f;
    for (std::size_t k = 0; k < kSpread; ++k) {
      greatest = max_of(greatest, share[cells_.spread_cell[cell * kSpread + k]]);
    }
    seen[cell] = max_of(std::sqrt(greatest), kLeastSeen);
  }
}

void ProductTable::add_places(const SkyPlaces& places, ThreadPool& pool) {
  places_ = &places;
  const std::size_t tables = std::size_t{bins_} * bins_ + places.tables().size();
  row_cdf_.resize(tables * (rows_ + 1));
  column_cdf_.resize(tables * rows_ * (columns_ + 1));
  pool.for_each_chunk(places.tables().size(), 64, [&](std::size_t begin, std::size_t end) {
    weigh_places(places, begin, end);
  });
}

void ProductTable::weigh_places(const SkyPlaces& places, std::size_t begin, std::size_t end) {
  std::vector<float> share(std::size_t{SkyPlaces::kGrid} * SkyPlaces::kGrid);
  std::vector<float> seen(cells_.energy.size());
  for (std::size_t i = begin; i < end; ++i) {
    const SkyPlaces::Table& table = places.tables()[i];
    const SkyPlaces::Table* const last = i > begin ? &table - 1 : nullptr;
    if (last == nullptr || last->place != table.place || last->side != table.side) {
      places.shares(table.place, table.side, share);
      weigh_cells(share, seen);
    }
    fill_bin(bins_ * bins_ + static_cast<std::uint32_t>(i), table.bin, SkyPlacesView::kBins, seen);
  }
}

void ProductTable::fill_bin(std::uint32_t to, std::uint32_t bin, std::uint32_t bins,
                            std::span<const float> seen) {
  const Vec3d middle = in_bin(bin, bins, 0.5, 0.5);
  double bin_radius = 0.0;
  for (const double x : {0.0, 1.0}) {
    for (const double y : {0.0, 1.0})
      bin_radius = std::max(bin_radius, angle(middle, in_bin(bin, bins, x, y)));
  }
  const Vec3 normal(middle);
  const auto reach = static_cast<float>(bin_radius);
  const auto bin_variance = static_cast<float>(bin_radius * bin_radius / 6.0);
  std::vector<float> weight(columns_);
  std::vector<double> product(columns_), row_weight(rows_);
  for (std::uint32_t r = 0; r < rows_; ++r) {
    const std::size_t first = std::size_t{r} * columns_;
    const float* const x = &cells_.centre[0][first];
    const float* const y = &cells_.centre[1][first];
    const float* const z = &cells_.centre[2][first];
    const float* const radius = &cells_.radius[first];
    const float* const variance = &cells_.variance[first];
    for (std::uint32_t c = 0; c < columns_; ++c) {
      const float cosine = (normal.x * x[c] + normal.y * y[c]) + normal.z * z[c];
      weight[c] = cosine_weight(cosine, reach + radius[c], bin_variance + variance[c]);
    }
    for (std::uint32_t c = 0; c < columns_; ++c) {
      product[c] = cells_.energy[first + c] * static_cast<double>(weight[c] * seen[first + c]);
    }
    row_weight[r] =
        quantize_cdf(product, &column_cdf_[(std::size_t{to} * rows_ + r) * (columns_ + 1)]);
  }
  quantize_cdf(row_weight, &row_cdf_[std::size_t{to} * (rows_ + 1)]);
}

ProductView ProductTable::view() const {
  ProductView view;
  view.bins = bins_;
  view.rows = rows_;
  view.columns = columns_;
  view.patch_row = patch_row_.data();
  view.patch_column = patch_column_.data();
  view.row_cdf = row_cdf_.data();
  view.column_cdf = column_cdf_.data();
  view.patch_row_cdf = patch_row_cdf_.data();
  if (places_ != nullptr) view.places = places_->view();
  return view;
}

std::size_t ProductTable::byte_count() const {
  return sizeof(std::uint32_t) * (patch_row_.size() + patch_column_.size() + row_cdf_.size() +
                                  column_cdf_.size() + patch_row_cdf_.size());
}

}  // namespace komorebi
