#pragma once

#include <cstddef>

#include "bvh/topology.h"

namespace komorebi {

/// The builder with which build and rays together take the least time.
///
/// A tree by SAH takes some 100 ns a triangle and thread more to build than a linear one, and its
/// rays some 15 % less of their 100 to 200 ns; so it pays for itself from about
/// kRaysPerTriangle rays a triangle on. In small meshes both builds are over at once.
inline constexpr double kRaysPerTriangle = 4.0;

/// @param expected_rays  that will meet the tree until it is thrown away: pixels × samples × rays
///                       a sample, and over all frames that keep the tree
Builder choose_builder(std::size_t triangle_count, double expected_rays);

}  // namespace komorebi
