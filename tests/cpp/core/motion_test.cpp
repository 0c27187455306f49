// Poses in time: taken apart and put together again, and half of a turn is half of the turn.
#include "core/motion.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "render/motion.h"

namespace komorebi {
namespace {

double difference(const AffineMap& map, const Mat4d& matrix) {
  double most = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      most = std::max(most, std::abs(map.linear[c][r] - matrix[c][r]));
    }
    most = std::max(most, std::abs(map.translation[c] - matrix[3][c]));
  }
  return most;
}

TEST(Motion, PosesComeBackMirroredShearedAndFlat) {
  std::mt19937 random(4);
  std::normal_distribution<double> number;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Mat4d> poses(5, Mat4d(1.0));
    for (Mat4d& pose : poses) {
      for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 3; ++r) pose[c][r] = number(random);
      }
      if (trial % 3 == 1) pose[2] = glm::dvec4(0.0);
      if (trial % 3 == 2) pose[1] = 1e-6 * pose[1] + pose[0];
    }
    const auto parts = decompose_poses(poses, Vec3d(0.0));
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_LT(difference(pose_at(parts.data(), 5, double(i) / 4.0), poses[i]), 1e-12) << trial;
    }
  }
}

TEST(Motion, TurnsEvenlyTheShorterWayAndStretchesLinearly) {
  const Vec3d axis = glm::normalize(Vec3d(1, -2, 3));
  for (const double degrees : {1.0, 30.0, 90.0, 179.0, -120.0, 200.0}) {
    const auto at = [&](double t) {
      const double turn = degrees > 180.0 ? degrees - 360.0 : degrees;
      Mat4d pose = glm::rotate(glm::translate(Mat4d(1.0), Vec3d(5.0 * t, 1, 2)),
                               glm::radians(t * turn), axis);
      return glm::scale(pose, Vec3d(1.0 + t, 2.0, 1.0 - 3.0 * t));  // mirrored at the end
    };
    const auto still = [&](double t) {
      return glm::rotate(Mat4d(1.0), glm::radians(t * degrees), axis);
    };
    const Mat4d turning[] = {still(0.0), still(1.0)};
    const auto parts = decompose_poses(turning, Vec3d(0.0));
    for (const double t : {0.1, 0.5, 0.9}) {
      const double turn = degrees > 180.0 ? degrees - 360.0 : degrees;
      EXPECT_LT(difference(pose_at(parts.data(), 2, t),
                           glm::rotate(Mat4d(1.0), glm::radians(t * turn), axis)),
                std::abs(degrees) < 3.0 ? 1e-6 : 1e-12)
          << degrees;
    }
    const Mat4d growing[] = {at(0.0), at(0.25)};
    const auto apart = decompose_poses(growing, Vec3d(5, 1, 2));
    const AffineMap half = pose_at(apart.data(), 2, 0.5);
    EXPECT_NEAR(half.translation.x, -5.0 + 0.625, 1e-12);
    EXPECT_NEAR(glm::length(half.linear[0]), 1.125, 1e-12);
    EXPECT_NEAR(glm::length(half.linear[2]), 0.625, 1e-12);
  }
}

TEST(Motion, TimesBeyondTheShutterStayAtItsEnds) {
  const Mat4d poses[] = {Mat4d(1.0), glm::translate(Mat4d(1.0), Vec3d(1, 0, 0))};
  const auto parts = decompose_poses(poses, Vec3d(0.0));
  EXPECT_EQ(pose_at(parts.data(), 2, -3.0).translation.x, 0.0);
  EXPECT_EQ(pose_at(parts.data(), 2, 7.0).translation.x, 1.0);
}

TEST(Motion, WhatHasNoSizeTurnsAsItsNeighbour) {
  const Mat4d turned = glm::rotate(Mat4d(1.0), 1.0, Vec3d(0, 0, 1));
  const Mat4d poses[] = {Mat4d(glm::dvec4(0), glm::dvec4(0), glm::dvec4(0), glm::dvec4(0, 0, 0, 1)),
                         turned};
  const auto parts = decompose_poses(poses, Vec3d(0.0));
  const AffineMap half = pose_at(parts.data(), 2, 0.5);
  EXPECT_LT(glm::length(half.linear[0] - 0.5 * Vec3d(turned[0])), 1e-12);
}

}  // namespace
}  // namespace komorebi
