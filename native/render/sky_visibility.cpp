#include "render/sky_visibility.h"

#include <cmath>

#include "core/octahedral.h"

namespace komorebi {
namespace {

/// What is known of all sides counts as much as so many rays of one side.
constexpr float kPriorRays = 8.0f;

}  // namespace

SkyVisibility::SkyVisibility(const SkySurvey& survey)
    : counts_(std::size_t{kSides} * kGrid * kGrid) {
  std::size_t ray = 0;
  for (const SkySurvey::Point& point : survey.points) {
    Count* const of_side = &counts_[side(point.normal) * kGrid * kGrid];
    for (std::uint32_t j = 0; j < survey.rays_per_point; ++j, ++ray) {
      Count& c = of_side[survey.cells[ray]];
      ++c.cast;
      c.seen += survey.seen[ray];
    }
  }
}

std::uint32_t SkyVisibility::side(const Vec3& n) {
  const Vec3 a(n.x < 0.0f ? -n.x : n.x, n.y < 0.0f ? -n.y : n.y, n.z < 0.0f ? -n.z : n.z);
  const int axis = a.z < a.x || a.z < a.y ? (a.y < a.x ? 0 : 1) : 2;
  return 2u * static_cast<std::uint32_t>(axis) + (n[axis] < 0.0f ? 1u : 0u);
}

float SkyVisibility::share_of_cell(std::uint32_t side, std::uint32_t cell) const {
  std::uint32_t cast = 0, seen = 0;
  for (std::uint32_t s = 0; s < kSides; ++s) {
    cast += counts_[s * kGrid * kGrid + cell].cast;
    seen += counts_[s * kGrid * kGrid + cell].seen;
  }
  const float all = (static_cast<float>(seen) + 1.0f) / (static_cast<float>(cast) + 2.0f);
  const Count& own = counts_[side * kGrid * kGrid + cell];
  return (static_cast<float>(own.seen) + kPriorRays * all) /
         (static_cast<float>(own.cast) + kPriorRays);
}

float SkyVisibility::share(std::uint32_t side, const Vec3& direction) const {
  return share_of_cell(side, octahedral_cell(direction, kGrid));
}

float SkyVisibility::variance_left() const {
  double guided = 0.0, even = 0.0;
  for (std::uint32_t side = 0; side < kSides; ++side) {
    double rays = 0.0, share = 0.0, root = 0.0;
    for (std::uint32_t cell = 0; cell < kGrid * kGrid; ++cell) {
      const double cast = counts_[side * kGrid * kGrid + cell].cast;
      const double seen = static_cast<double>(share_of_cell(side, cell));
      rays += cast;
      share += cast * seen;
      root += cast * std::sqrt(seen);
    }
    if (rays == 0.0) continue;
    guided += (root * root - share * share) / rays;
    even += share - share * share / rays;
  }
  return even > 0.0 ? static_cast<float>(guided / even) : 1.0f;
}

}  // namespace komorebi
