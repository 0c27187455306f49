#pragma once

#include "bvh/closest.h"
#include "bvh/time_parts.h"
#include "core/moving_triangle.h"

namespace komorebi {

/// Tests one triangle of a mesh that deforms, at the ray's time, and keeps the hit if it is the
/// better one; true if anything was hit. What has no area at that time is not hit.
/// @param self  the primitive of this instance that the ray leaves, or kNone
bool test_moving_triangle(const MeshView& mesh, const LocalRay& local, const SetPlace& place,
                          std::uint32_t self, std::uint32_t instance, std::uint32_t triangle,
                          Closest* closest);

}  // namespace komorebi
