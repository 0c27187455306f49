#pragma once

#include "support/scenes.h"

namespace komorebi::testing {

/// A hollow sphere of radius 1 from which a cap is cut off at the top, of rings [cut, n); and the
/// share of its area that is missing.
struct Cavity {
  std::shared_ptr<const Mesh> mesh;
  double open;
};
inline Cavity cavity(int n, int cut) {
  Polygons all = sphere(n, Vec3d(0), 1.0, false), rest;
  rest.vtx2xyz = all.vtx2xyz;
  const auto first = static_cast<std::size_t>(8 * n * cut);  // corners: 4 of 2n faces a ring
  rest.corner2vtx.assign(all.corner2vtx.begin() + static_cast<std::ptrdiff_t>(first),
                         all.corner2vtx.end());
  for (std::size_t c = 4; c <= rest.corner2vtx.size(); c += 4) {
    rest.face_offsets.push_back(static_cast<std::int32_t>(c));
  }
  return {rest.mesh(), 0.5 - 0.5 * std::cos(glm::pi<double>() * cut / n)};
}

/// Light in a cavity after k bounces: each sends back what it gets but for what leaves.
inline double cavity_light(double albedo, double first_albedo, double open, std::uint32_t k) {
  double sum = 0.0, share = 1.0;
  for (std::uint32_t i = 0; i <= k; ++i, share *= albedo * (1.0 - open)) sum += share;
  return first_albedo * open * sum;
}

}  // namespace komorebi::testing
