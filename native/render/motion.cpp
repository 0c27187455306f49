#include "render/motion.h"

namespace komorebi {
namespace {

/// Any unit vector across a unit vector.
Vec3d across(const Vec3d& v) {
  const Vec3d axis = v.x * v.x < 0.5 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
  return glm::normalize(glm::cross(v, axis));
}

/// `v` without length: `other` in its place.
Vec3d unit_or(const Vec3d& v, double length, const Vec3d& other) {
  return length > 0.0 ? v / length : other;
}

/// Unit quaternion of a rotation matrix (Shepperd 1978): by the largest of its parts.
glm::dvec4 quaternion(const Mat3d& m) {
  const double trace = m[0][0] + m[1][1] + m[2][2];
  if (trace > 0.0) {
    const double s = std::sqrt(trace + 1.0), r = 0.5 / s;
    return {(m[1][2] - m[2][1]) * r, (m[2][0] - m[0][2]) * r, (m[0][1] - m[1][0]) * r, 0.5 * s};
  }
  int i = m[1][1] > m[0][0] ? 1 : 0;
  if (m[2][2] > m[i][i]) i = 2;
  const int j = (i + 1) % 3, k = (j + 1) % 3;
  const double s = std::sqrt(m[i][i] - (m[j][j] + m[k][k]) + 1.0), r = s > 0.0 ? 0.5 / s : 0.0;
  glm::dvec4 q;
  q[i] = 0.5 * s;
  q[j] = (m[i][j] + m[j][i]) * r;
  q[k] = (m[i][k] + m[k][i]) * r;
  q.w = (m[j][k] - m[k][j]) * r;
  return q;
}

bool has_size(const MotionPose& pose) {
  return pose.stretch[0][0] != 0.0 || pose.stretch[1][1] != 0.0 || pose.stretch[2][2] != 0.0;
}

MotionPose decompose(const Mat4d& matrix, const Vec3d& origin) {
  MotionPose pose;
  pose.translation = Vec3d(matrix[3]) - origin;
  const Vec3d x(matrix[0]), y(matrix[1]), z(matrix[2]);
  Mat3d turn, &s = pose.stretch;
  s = Mat3d(0.0);
  s[0][0] = glm::length(x);
  turn[0] = unit_or(x, s[0][0], Vec3d(1.0, 0.0, 0.0));
  s[1][0] = glm::dot(turn[0], y);
  const Vec3d y_across = y - s[1][0] * turn[0];
  turn[1] = unit_or(y_across, glm::length(y_across), across(turn[0]));
  turn[1] = glm::normalize(turn[1] - glm::dot(turn[0], turn[1]) * turn[0]);  // of a long difference
  s[1][1] = glm::dot(turn[1], y);
  s[2][0] = glm::dot(turn[0], z);
  s[2][1] = glm::dot(turn[1], z);
  turn[2] = glm::cross(turn[0], turn[1]);
  s[2][2] = glm::dot(turn[2], z);
  if (s[2][2] < 0.0) {
    // Mirrored: all three scales are negative, as Cycles has them.
    turn[0] = -turn[0];
    turn[1] = -turn[1];
    for (int c = 0; c < 3; ++c) {
      s[c][0] = -s[c][0];
      s[c][1] = -s[c][1];
    }
  }
  pose.rotation = detail::unit(quaternion(turn));
  return pose;
}

}  // namespace

std::vector<MotionPose> decompose_poses(std::span<const Mat4d> poses, const Vec3d& origin) {
  std::vector<MotionPose> all;
  all.reserve(poses.size());
  for (const Mat4d& matrix : poses) {
    all.push_back(decompose(matrix, origin));
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (has_size(all[i])) continue;
    if (i > 0) {
      all[i].rotation = all[i - 1].rotation;
    } else if (all.size() > 1) {
      all[i].rotation = all[1].rotation;
    }
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (glm::dot(all[i - 1].rotation, all[i].rotation) < 0.0) all[i].rotation = -all[i].rotation;
  }
  return all;
}

}  // namespace komorebi
