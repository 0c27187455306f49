#pragma once

#include <functional>
#include <random>

#include "core/sampler.h"
#include "core/warp.h"
#include "support/chi_square.h"

namespace komorebi::testing {

/// Uniform random bits with a fixed seed: independent points, as the χ² test assumes (Sobol' points
/// would fit too well).
class RandomBits {
 public:
  explicit RandomBits(std::uint64_t seed) : engine_(seed) {}
  Bits2 next() {
    const std::uint64_t bits = engine_();
    return {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
  }
  Vec2 next_2d() {
    const Bits2 bits = next();
    return Vec2(to_unit_float(bits.x), to_unit_float(bits.y));
  }

 private:
  std::mt19937_64 engine_;
};

/// A grid over the sphere with cells equal in longitude φ/2π and in z, hence in solid angle.
struct SphereGrid {
  int columns, rows;  ///< over longitude and z
  int points = 8;     ///< midpoints along each side of a cell, for integrals

  std::size_t cell_count() const { return static_cast<std::size_t>(columns * rows); }

  std::size_t cell(const Vec3& d) const {
    const double turns = std::atan2(double{d.y}, double{d.x}) / (2.0 * kPi) + 0.5;
    const int column = std::min(static_cast<int>(turns * columns), columns - 1);
    const int row = std::min(static_cast<int>((double{d.z} + 1.0) * 0.5 * rows), rows - 1);
    return static_cast<std::size_t>(row * columns + column);
  }

  /// ∫ f dω over each cell.
  std::vector<double> integrate(const std::function<double(const Vec3&)>& f) const {
    std::vector<double> sum(cell_count(), 0.0);
    const double weight = 4.0 * kPi / (double(cell_count()) * points * points);
    for (int j = 0; j < rows * points; ++j) {
      const double z = 2.0 * (j + 0.5) / (rows * points) - 1.0;
      const double r = std::sqrt((1.0 - z) * (1.0 + z));
      for (int i = 0; i < columns * points; ++i) {
        const double phi = 2.0 * kPi * ((i + 0.5) / (columns * points) - 0.5);
        const Vec3 d(Vec3d(r * std::cos(phi), r * std::sin(phi), z));
        sum[static_cast<std::size_t>(j / points * columns + i / points)] += f(d) * weight;
      }
    }
    return sum;
  }
};

/// χ² of `count` directions from independent random points against their density.
inline ChiSquare test_directions(const SphereGrid& grid, int count, std::uint64_t seed,
                                 const std::function<Vec3(const Bits2&)>& sample,
                                 const std::function<double(const Vec3&)>& pdf) {
  RandomBits random(seed);
  std::vector<std::uint64_t> observed(grid.cell_count(), 0);
  for (int i = 0; i < count; ++i) ++observed[grid.cell(sample(random.next()))];
  std::vector<double> expected = grid.integrate(pdf);
  for (double& e : expected) e *= count;
  return chi_square(observed, expected);
}

/// |det J| of a map from the unit square to the sphere: the solid angle per unit of area, from
/// central differences of width 2h.
inline double jacobian(const std::function<Vec3(double, double)>& map, double u, double v,
                       double h) {
  const Vec3d du = (Vec3d(map(u + h, v)) - Vec3d(map(u - h, v))) / (2.0 * h);
  const Vec3d dv = (Vec3d(map(u, v + h)) - Vec3d(map(u, v - h))) / (2.0 * h);
  return glm::length(glm::cross(du, dv));
}

}  // namespace komorebi::testing
