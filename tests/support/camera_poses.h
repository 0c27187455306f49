// Poses of cameras in doubles, for oracles that know angles and not matrices' inverses.
#pragma once

#include <cmath>

#include "core/vector.h"

namespace komorebi::testing {

/// XYZ Euler angles as Blender's: x first.
inline Mat3d euler_rotation(const Vec3d& e) {
  const double cx = std::cos(e.x), sx = std::sin(e.x), cy = std::cos(e.y), sy = std::sin(e.y);
  const double cz = std::cos(e.z), sz = std::sin(e.z);
  const Mat3d x(1, 0, 0, 0, cx, sx, 0, -sx, cx), y(cy, 0, -sy, 0, 1, 0, sy, 0, cy);
  return Mat3d(cz, sz, 0, -sz, cz, 0, 0, 0, 1) * y * x;
}

inline Mat4d pose(const Vec3d& euler, const Vec3d& location) {
  Mat4d m(euler_rotation(euler));
  m[3] = glm::dvec4(location, 1.0);
  return m;
}

}  // namespace komorebi::testing
