#pragma once

#include <cstddef>

#include "bvh/topology.h"

namespace komorebi {

/// The builder with which build and rays together take the least time.
///
/// Measured on the dragon (0.87 M triangles) with one thread: a tree by SAH takes 310 ns a triangle
/// more to build than a linear one, and an occlusion ray 163 ns in place of 185. So it pays for
/// itself from about kRaysPerTriangle rays a triangle on; both scale alike with threads.
inline constexpr double kRaysPerTriangle = 14.0;

/// @param expected_rays  that will meet the tree until it is thrown away: pixels × samples × rays
///                       a sample, and over all frames that keep the tree
Builder choose_builder(std::size_t triangle_count, double expected_rays);

}  // namespace komorebi
