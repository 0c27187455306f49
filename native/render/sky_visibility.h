#pragma once

#include <vector>

#include "render/sky_survey.h"

namespace komorebi {

/// Which parts of the sky the surfaces of a survey see, for directions to be chosen by: a room's
/// light comes through its windows, wherever the map is bright. The directions are on an octahedral
/// grid; surfaces count by the side of a cube that they face. Only where samples go depends on it,
/// never what they are worth. Weights by the root of the second moment: Rath et al. 2020,
/// "Variance-Aware Path Guiding", §3.
class SkyVisibility {
 public:
  static constexpr std::uint32_t kSides = 6, kGrid = SkySurvey::kGrid;

  explicit SkyVisibility(const SkySurvey& survey);

  /// The side, 0…5, that a normal in the map's space faces.
  static std::uint32_t side(const Vec3& normal);

  /// The share of rays from surfaces facing this side to about this direction that arrive, in
  /// (0, 1): measured, and where little is known, as for all sides together.
  float share(std::uint32_t side, const Vec3& direction) const;
  float share_of_cell(std::uint32_t side, std::uint32_t cell) const;

  /// The variance of ambient occlusion from directions of density cosine · √share over that from
  /// the cosine alone, for independent samples: 1 where nothing is known of a direction.
  float variance_left() const;

 private:
  struct Count {
    std::uint32_t cast = 0, seen = 0;
  };
  std::vector<Count> counts_;  // [kSides][kGrid²]
};

}  // namespace komorebi
