#pragma once

#include <cstddef>

#include "bvh/topology.h"

namespace komorebi {

/// The builder with which build and rays together take the least time.
///
/// Measured on the dragon (0.87 M triangles) with one thread: a tree by SAH takes 155 ns a triangle
/// more to build than a linear one (210 in place of 55), and an occlusion ray 143 ns in place of
/// 163. So it pays for itself from about kRaysPerTriangle rays a triangle on; both scale alike with
/// threads. In architecture it pays earlier.
inline constexpr double kRaysPerTriangle = 8.0;

/// @param expected_rays  that will meet the tree until it is thrown away: pixels × samples × rays
///                       a sample, and over all frames that keep the tree
Builder choose_builder(std::size_t triangle_count, double expected_rays);

}  // namespace komorebi
