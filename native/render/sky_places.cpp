#include "render/sky_places.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace komorebi {
namespace {

constexpr float kMostCells = 32.0f;  ///< along the longest axis
constexpr double kOutliers = 0.01;   ///< share of the points that the grid leaves out on each side

/// What the next coarser level knows counts as much as so many rays.
constexpr float kPriorRays = 4.0f;

/// 34 MB of tables, and a twentieth of a second to make them.
constexpr std::size_t kMostTables = 4096;

/// The range of a coordinate without its outliers.
std::pair<float, float> range(const SkySurvey& survey, int axis) {
  std::vector<float> at;
  at.reserve(survey.points.size());
  for (const SkySurvey::Point& p : survey.points) at.push_back(p.origin[axis]);
  const auto skip = static_cast<std::ptrdiff_t>(kOutliers * static_cast<double>(at.size()));
  const auto low = at.begin() + skip, high = at.end() - 1 - skip;
  std::nth_element(at.begin(), low, at.end());
  const float least = *low;
  std::nth_element(at.begin(), high, at.end());
  return {least, *high};
}

/// Of the coarse grid the cell that a fine one lies in.
std::uint32_t coarse_cell(std::uint32_t cell) {
  constexpr std::uint32_t kFine = SkyPlaces::kGrid, kCoarse = SkyPlaces::kCoarseGrid;
  return (cell / kFine / (kFine / kCoarse)) * kCoarse + cell % kFine / (kFine / kCoarse);
}

/// The noise of a surface's light that no visibility explains, over the square of the light.
constexpr double kOtherNoise = 0.05;

/// One place of so many is looked at to tell what places are worth.
constexpr std::uint32_t kPlacesPerTrial = 4;

}  // namespace

SkyPlaces::SkyPlaces(const SkySurvey& survey, const SkyVisibility& whole, ThreadPool& pool,
                     Purpose purpose) {
  if (survey.points.empty()) return;
  coarse_whole_.assign(std::size_t{SkyVisibility::kSides} * kCoarseGrid * kCoarseGrid, 0.0f);
  for (std::uint32_t i = 0; i < SkyVisibility::kSides * kGrid * kGrid; ++i) {
    const std::uint32_t side = i / (kGrid * kGrid), cell = i % (kGrid * kGrid);
    whole_.push_back(whole.share_of_cell(side, cell));
    coarse_whole_[side * kCoarseGrid * kCoarseGrid + coarse_cell(cell)] += 0.25f * whole_.back();
  }
  find_places(survey);
  if (places_ == 0) return;
  pool.for_each_chunk(kLevels, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t level = begin; level < end; ++level) {
      levels_[level] = count_level(survey, static_cast<std::uint32_t>(level), purpose);
    }
  });
  if (purpose == Purpose::kTables) choose_tables(survey);
  variance_left_ = measure_variance();
}

void SkyPlaces::find_places(const SkySurvey& survey) {
  Vec3 extent(0.0f);
  for (int a = 0; a < 3; ++a) {
    const auto [least, most] = range(survey, a);
    origin_[a] = least;
    extent[a] = most - least;
  }
  const float longest = max_of(extent.x, max_of(extent.y, extent.z));
  cells_per_length_ = kMostCells / longest;
  if (!(longest > 0.0f) || !std::isfinite(cells_per_length_)) return;  // a single place
  // Half a cell around, since what is flat may lie at its very end.
  for (int a = 0; a < 3; ++a) {
    origin_[a] -= 0.5f / cells_per_length_;
    size_[a] = static_cast<std::uint32_t>(min_of(extent[a] * cells_per_length_, kMostCells)) + 2;
  }
  place_of_cell_.assign(std::size_t{size_[0]} * size_[1] * size_[2], 0);
  place_of_point_.reserve(survey.points.size());
  for (const SkySurvey::Point& p : survey.points) {
    const std::uint32_t cell = cell_of_place(view(), p.origin);
    if (cell == kNoTable) {
      place_of_point_.push_back(kNoTable);
      continue;
    }
    std::uint16_t& place = place_of_cell_[cell];
    if (place == 0) place = static_cast<std::uint16_t>(++places_);  // 34³ cells at most
    place_of_point_.push_back(place - 1u);
  }
}

/// Numbers of a level's places by those of the finest one; returns how many there are.
std::uint32_t SkyPlaces::number_places(std::uint32_t level,
                                       std::vector<std::uint32_t>& place) const {
  place.resize(places_);
  if (level == 0) {
    std::iota(place.begin(), place.end(), 0u);
    return places_;
  }
  std::uint32_t size[3];
  for (int a = 0; a < 3; ++a) size[a] = ((size_[a] - 1) >> level) + 1;
  std::vector<std::uint32_t> numbers(std::size_t{size[0]} * size[1] * size[2], kNoTable);
  std::uint32_t count = 0;
  for (std::uint32_t cell = 0; cell < place_of_cell_.size(); ++cell) {
    if (place_of_cell_[cell] == 0) continue;
    const std::uint32_t x = cell % size_[0] >> level, y = cell / size_[0] % size_[1] >> level,
                        z = cell / (size_[0] * size_[1]) >> level;
    std::uint32_t& number = numbers[(z * size[1] + y) * size[0] + x];
    if (number == kNoTable) number = count++;
    place[place_of_cell_[cell] - 1u] = number;
  }
  return count;
}

SkyPlaces::Level SkyPlaces::count_level(const SkySurvey& survey, std::uint32_t level,
                                        Purpose purpose) const {
  Level found;
  found.grid = level == 0 ? kGrid : kCoarseGrid;
  found.first.assign(number_places(level, found.place) * SkyVisibility::kSides, kNoTable);
  const bool all = level > 0 || purpose == Purpose::kTables;
  std::vector<std::uint32_t> of_point(survey.points.size(), kNoTable);  // entries of `first`
  std::uint32_t known = 0;
  for (std::size_t i = 0; i < survey.points.size(); ++i) {
    const std::uint32_t place = place_of_point_[i];
    if (place == kNoTable || !(all || is_tried(place))) continue;
    of_point[i] =
        found.place[place] * SkyVisibility::kSides + SkyVisibility::side(survey.points[i].normal);
    std::uint32_t& first = found.first[of_point[i]];
    if (first == kNoTable) first = found.grid * found.grid * known++;
  }
  found.counts.resize(std::size_t{found.grid} * found.grid * known);
  for (std::size_t i = 0; i < survey.points.size(); ++i) {
    if (of_point[i] == kNoTable) continue;
    Count* const counts = &found.counts[found.first[of_point[i]]];
    for (std::size_t j = i * survey.rays_per_point; j < (i + 1) * survey.rays_per_point; ++j) {
      const std::uint32_t cell = survey.cells[j];
      Count& count = counts[level == 0 ? cell : coarse_cell(cell)];
      ++count.cast;
      count.seen = static_cast<std::uint16_t>(count.seen + survey.seen[j]);
    }
  }
  return found;
}

void SkyPlaces::choose_tables(const SkySurvey& survey) {
  constexpr std::uint32_t kBins = SkyPlacesView::kBins * SkyPlacesView::kBins;
  std::vector<std::uint32_t> points(std::size_t{places_} * kBins, 0);
  for (std::size_t i = 0; i < survey.points.size(); ++i) {
    if (place_of_point_[i] == kNoTable) continue;
    ++points[place_of_point_[i] * kBins +
             octahedral_cell(survey.points[i].normal, SkyPlacesView::kBins)];
  }
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (points[i] > 0) chosen.push_back(i);
  }
  if (chosen.size() > kMostTables) {
    std::stable_sort(chosen.begin(), chosen.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return points[a] > points[b]; });
    chosen.resize(kMostTables);
  }
  for (const std::uint32_t i : chosen) {
    const std::uint32_t column = i % SkyPlacesView::kBins;
    const std::uint32_t row = i % kBins / SkyPlacesView::kBins;
    const auto middle = [](std::uint32_t at) {
      return (2.0f * static_cast<float>(at) + 1.0f) / static_cast<float>(SkyPlacesView::kBins) -
             1.0f;
    };
    const Vec3 normal = direction_from_octahedral(Vec2(middle(column), middle(row)));
    tables_.push_back({i / kBins, SkyVisibility::side(normal), i % kBins});
  }
  std::sort(tables_.begin(), tables_.end(), [](const Table& a, const Table& b) {
    return std::tie(a.place, a.side, a.bin) < std::tie(b.place, b.side, b.bin);
  });
  table_.assign(points.size(), 0);
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    table_[tables_[i].place * kBins + tables_[i].bin] = static_cast<std::uint16_t>(i + 1);
  }
}

float SkyPlaces::learnt(std::uint32_t l, std::uint32_t place, std::uint32_t side,
                        std::uint32_t cell, float prior) const {
  const Level& level = levels_[l];
  const Count& count =
      level.counts[level.first[level.place[place] * SkyVisibility::kSides + side] + cell];
  return (static_cast<float>(count.seen) + kPriorRays * prior) /
         (static_cast<float>(count.cast) + kPriorRays);
}

SkyPlaces::CoarseShares SkyPlaces::coarse_shares(std::uint32_t place, std::uint32_t side) const {
  CoarseShares coarse;
  std::copy_n(&coarse_whole_[side * coarse.size()], coarse.size(), coarse.begin());
  for (std::uint32_t l = kLevels; l-- > 1;) {
    if (!knows(l, place, side)) continue;
    for (std::uint32_t cell = 0; cell < coarse.size(); ++cell) {
      coarse[cell] = learnt(l, place, side, cell, coarse[cell]);
    }
  }
  return coarse;
}

void SkyPlaces::shares(std::uint32_t place, std::uint32_t side, std::span<float> share) const {
  const CoarseShares coarse = coarse_shares(place, side);
  const bool knows_place = knows(0, place, side);
  for (std::uint32_t cell = 0; cell < share.size(); ++cell) {
    const float prior = coarse[coarse_cell(cell)];
    share[cell] = knows_place ? learnt(0, place, side, cell, prior) : prior;
  }
}

bool SkyPlaces::knows(std::uint32_t level, std::uint32_t place, std::uint32_t side) const {
  const Level& of = levels_[level];
  return of.first[of.place[place] * SkyVisibility::kSides + side] != kNoTable;
}

/// One place of so many is looked at to tell what places are worth.
bool SkyPlaces::is_tried(std::uint32_t place) {
  return place % kPlacesPerTrial == 0;
}

/// As SkyVisibility::variance_left, the rays of a place being those that were cast there.
float SkyPlaces::measure_variance() const {
  const Level& finest = levels_[0];
  constexpr std::uint32_t kCells = kGrid * kGrid;
  std::vector<double> root_of_whole(whole_.size());
  for (std::size_t i = 0; i < whole_.size(); ++i) {
    root_of_whole[i] = std::sqrt(static_cast<double>(whole_[i]));
  }
  double by_place = 0.0, by_whole = 0.0;
  for (std::uint32_t i = 0; i < finest.first.size(); ++i) {
    const std::uint32_t place = i / SkyVisibility::kSides, side = i % SkyVisibility::kSides;
    if (finest.first[i] == kNoTable || !is_tried(place)) continue;
    const CoarseShares coarse = coarse_shares(place, side);
    double rays = 0.0, seen = 0.0, root = 0.0, whole_root = 0.0, weighted = 0.0;
    for (std::uint32_t cell = 0; cell < kCells; ++cell) {
      const double cast = finest.counts[finest.first[i] + cell].cast;
      if (cast == 0.0) continue;
      const auto here =
          static_cast<double>(learnt(0, place, side, cell, coarse[coarse_cell(cell)]));
      const double whole = root_of_whole[side * kCells + cell];
      rays += cast;
      seen += cast * here;
      root += cast * std::sqrt(here);
      whole_root += cast * whole;
      weighted += cast * here / whole;
    }
    const double other = kOtherNoise * seen * seen;
    by_place += (root * root - seen * seen + other) / rays;
    by_whole += (weighted * whole_root - seen * seen + other) / rays;
  }
  return by_whole > 0.0 ? static_cast<float>(by_place / by_whole) : 1.0f;
}

SkyPlacesView SkyPlaces::view() const {
  SkyPlacesView view;
  view.origin = origin_;
  view.cells_per_length = cells_per_length_;
  for (int a = 0; a < 3; ++a) view.size[a] = size_[a];
  view.place = place_of_cell_.data();
  view.table = table_.data();
  return view;
}

}  // namespace komorebi
