#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/sky_places.h"
#include "render/sky_visibility.h"

namespace komorebi {

/// What surfaces see of the sky by where they are: below an arcade, or beside a window, it is
/// another part than what the scene sees as a whole. Places are cells of a grid, and cells of
/// coarser ones say what is likely where few rays of a place are known (a tree of places:
/// Müller, Gross, Novák 2017, "Practical Path Guiding for Efficient Light-Transport Simulation",
/// §3; here all levels count, each as the prior of the next).
class SkyPlaces {
 public:
  /// Of directions, for places of the finest level and of the others.
  static constexpr std::uint32_t kGrid = SkyVisibility::kGrid, kCoarseGrid = 16;

  /// The normals of a place that rays go out for, and the side that they face.
  struct Table {
    std::uint32_t place, side, bin;
  };

  /// kTrial: to tell what places are worth, by some of them; it has no tables nor shares.
  enum class Purpose { kTrial, kTables };

  SkyPlaces(const SkySurvey& survey, const SkyVisibility& whole, ThreadPool& pool,
            Purpose purpose = Purpose::kTables);

  /// The variance of ambient occlusion by what places see over that by what the whole sees, for
  /// independent samples.
  float variance_left() const { return variance_left_; }

  /// Those most rays are for, one place after another, and the normals of a side together.
  const std::vector<Table>& tables() const { return tables_; }

  /// The share of rays from a place's surfaces of a side that arrive, by cells of directions.
  void shares(std::uint32_t place, std::uint32_t side, std::span<float> share) const;

  SkyPlacesView view() const;

 private:
  /// Of rays by place, side and direction; few enough for 16 bits (a cell of directions gets a
  /// sixtieth of a surface's rays at most).
  struct Count {
    std::uint16_t cast = 0, seen = 0;
  };
  struct Level {
    std::uint32_t grid = 0;            // of directions
    std::vector<std::uint32_t> place;  // of the finest places
    std::vector<std::uint32_t> first;  // [place][side] in counts; kNoTable: nothing is known
    std::vector<Count> counts;         // [grid²] each
  };
  static constexpr std::uint32_t kLevels = 4;
  using CoarseShares = std::array<float, kCoarseGrid * kCoarseGrid>;

  void find_places(const SkySurvey& survey);
  std::uint32_t place_of(const Vec3& origin) const;
  std::uint32_t number_places(std::uint32_t level, std::vector<std::uint32_t>& place) const;
  Level count_level(const SkySurvey& survey, std::uint32_t level, Purpose purpose) const;
  void choose_tables(const SkySurvey& survey);
  bool knows(std::uint32_t level, std::uint32_t place, std::uint32_t side) const;
  /// The share of a cell's rays that arrive by what a level knows of a place, given what is likely.
  float learnt(std::uint32_t level, std::uint32_t place, std::uint32_t side, std::uint32_t cell,
               float prior) const;
  /// What all levels but the finest know.
  CoarseShares coarse_shares(std::uint32_t place, std::uint32_t side) const;
  static bool is_tried(std::uint32_t place);
  float measure_variance() const;

  std::vector<float> whole_, coarse_whole_;  // [side][directions]: shares
  Vec3 origin_{0.0f};
  float cells_per_length_ = 0.0f;
  std::uint32_t size_[3] = {0, 0, 0};
  std::uint32_t places_ = 0;
  std::vector<std::uint16_t> place_of_cell_;
  std::vector<std::uint32_t> place_of_point_;  // kNoTable: outside
  Level levels_[kLevels];
  std::vector<Table> tables_;
  std::vector<std::uint16_t> table_;
  float variance_left_ = 1.0f;
};

}  // namespace komorebi
