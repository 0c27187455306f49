#pragma once

#include <cstddef>

#include "bvh/topology.h"

namespace komorebi {

/// The builder with which build and rays together take the least time.
///
/// Measured on the dragon (0.87 M triangles) with one thread: a tree by SAH takes 185 ns a triangle
/// more to build than a linear one (275 in place of 90), and an occlusion ray 104 ns in place of
/// 112. So it pays for itself from about kRaysPerTriangle rays a triangle on; both scale alike with
/// threads. In architecture it pays earlier.
inline constexpr double kRaysPerTriangle = 20.0;

/// @param expected_rays  that will meet the tree until it is thrown away: pixels × samples × rays
///                       a sample, and over all frames that keep the tree
Builder choose_builder(std::size_t triangle_count, double expected_rays);

}  // namespace komorebi
