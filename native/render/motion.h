#pragma once

#include <span>
#include <vector>

#include "core/motion.h"

namespace komorebi {

/// Takes affine maps at even times apart, for pose_at to go the shorter way round from each to the
/// next. Where a map has shrunk to nothing its rotation is that of its neighbour. Mirrored maps are
/// an improper rotation's negative, stretch and shear with it (Cycles leaves the shear's sign, and
/// so shows mirrored and sheared objects in another shape as soon as they move).
/// @param origin  what translations become relative to
std::vector<MotionPose> decompose_poses(std::span<const Mat4d> poses, const Vec3d& origin);

}  // namespace komorebi
