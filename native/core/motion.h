#pragma once

#include "core/math.h"
#include "core/vector.h"

namespace komorebi {

/// An affine map taken apart so that it can be interpolated in time: rotation · stretch +
/// translation (Shoemake and Duff 1992, "Matrix Animation and Polar Decomposition"; the split is
/// that of Cycles, orthonormal columns and an upper triangle). Made by decompose_poses
/// (render/motion.h).
struct MotionPose {
  glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  ///< unit quaternion x, y, z, w
  Vec3d translation{0.0};
  Mat3d stretch{1.0};
};

/// world = linear · local + translation.
struct AffineMap {
  Mat3d linear{1.0};
  Vec3d translation{0.0};
};

namespace detail {

inline glm::dvec4 unit(const glm::dvec4& q) {
  return q / std::sqrt(glm::dot(q, q));
}

/// Spherical linear interpolation (Shoemake 1985), linear where the rotations are nearly the same.
/// The quaternions are on the same side: see decompose_poses.
inline glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double t) {
  const double cosine = glm::dot(a, b);
  if (cosine > 0.9995) return unit((1.0 - t) * a + t * b);
  const glm::dvec4 across = b - cosine * a;
  const double sine = std::sqrt(glm::dot(across, across));
  if (!(sine > 0.0)) return a;
  const double angle = atan2_radians(sine, cosine);
  const SinCos<double> part = sin_cos_turns(t * angle / (2.0 * kPi));
  return part.cos * a + (part.sin / sine) * across;
}

inline Mat3d rotation_matrix(const glm::dvec4& q) {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double xw = q.x * q.w, yw = q.y * q.w, zw = q.z * q.w;
  return Mat3d(1.0 - 2.0 * (yy + zz), 2.0 * (xy + zw), 2.0 * (xz - yw),  //
               2.0 * (xy - zw), 1.0 - 2.0 * (xx + zz), 2.0 * (yz + xw),  //
               2.0 * (xz + yw), 2.0 * (yz - xw), 1.0 - 2.0 * (xx + yy));
}

}  // namespace detail

/// Between which of `count` poses at even times over the shutter a time lies, and where; times
/// beyond the shutter are held at its ends.
struct MotionPlace {
  std::uint32_t step;
  double fraction;
};
inline MotionPlace motion_place(std::uint32_t count, double time) {
  const double place = (time > 0.0 ? (time < 1.0 ? time : 1.0) : 0.0) * (count - 1);
  auto step = static_cast<std::uint32_t>(place);
  if (step > count - 2) step = count - 2;
  return {step, place - step};
}

/// The map at a time in [0, 1], from `count` ≥ 2 poses at even times.
inline AffineMap pose_at(const MotionPose* poses, std::uint32_t count, double time) {
  const MotionPlace place = motion_place(count, time);
  const MotionPose &a = poses[place.step], &b = poses[place.step + 1];
  const double t = place.fraction, s = 1.0 - t;
  const Mat3d turn = detail::rotation_matrix(detail::slerp(a.rotation, b.rotation, t));
  return {turn * (s * a.stretch + t * b.stretch), s * a.translation + t * b.translation};
}

}  // namespace komorebi
