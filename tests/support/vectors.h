// What the Vector pass shows, against points that are taken along their way by hand.
#pragma once

#include <cmath>

#include "support/moving.h"

namespace komorebi::testing {

inline constexpr std::uint32_t kSize = 40;
/// camera_at has 50 mm on 36 mm: so many pixels for a slope of 1.
inline constexpr double kFocal = kSize / 2.0 / (18.0 / 50.0);

inline glm::dvec2 pinhole(const Vec3d& p, double zoom = 1.0) {
  return glm::dvec2(p.x, p.y) / -p.z * (kFocal / zoom);
}

inline Settings with_vector() {
  Settings s;
  s.samples = 4;
  s.light_samples = 1;
  s.passes = {"Combined", "Vector", "Position", "Depth", "Normal"};
  return s;
}

/// Eyes and where they look, at three times; the second is at rest.
inline std::vector<Mat4d> looking(const std::vector<Vec3d>& eyes,
                                  const std::vector<Vec3d>& targets) {
  std::vector<Mat4d> poses;
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    poses.push_back(glm::inverse(glm::lookAt(eyes[i], targets[i], Vec3d(0, 0, 1))));
  }
  return poses;
}

inline CameraDesc still_at(const Mat4d& pose) {
  CameraDesc camera = camera_at(Vec3d(pose[3]), Vec3d(pose[3]) - Vec3d(pose[2]), kSize, kSize);
  camera.shutter.still = true;
  return camera;
}

/// Where a point that is seen at rest is at time 0 and at time 1.
using Path = std::function<Vec3d(const Vec3d& rest, int time)>;

/// The pass against the points of the pass Position, taken along `path` and seen from `poses`.
/// Only pixels that show one thing count, of one sample.
inline void expect_vectors(const std::shared_ptr<Scene>& scene, const std::vector<Mat4d>& poses,
                           const std::function<glm::dvec2(const Vec3d&, int)>& project,
                           const Path& path, double tolerance = 2e-3) {
  Settings settings = with_vector();
  settings.samples = 1;
  const auto vectors = render(scene, settings, "Vector");
  const auto positions = render(scene, settings, "Position");
  const auto depth = render(scene, settings, "Depth");
  int compared = 0;
  double largest = 0.0;
  const auto seen = [&](const Vec3d& p, int step) {
    return project(Vec3d(glm::inverse(poses[static_cast<std::size_t>(step)]) * glm::dvec4(p, 1.0)),
                   step);
  };
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] > 1e9f) {
      for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(vectors[4 * i + c], 0.0f);
      continue;
    }
    const Vec3d rest(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    const glm::dvec2 now = seen(rest, 1), before = seen(path(rest, 0), 0) - now,
                     after = now - seen(path(rest, 1), 2);
    const double expected[4] = {before.x, before.y, after.x, after.y};
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_NEAR(vectors[4 * i + c], expected[c], tolerance * (1.0 + std::abs(expected[c])))
          << i << " " << c;
      largest = std::max(largest, std::abs(expected[c]));
    }
    ++compared;
  }
  EXPECT_GT(compared, 60);
  EXPECT_GT(largest, 0.5);
}

inline Vec3d stays(const Vec3d& p, int) {
  return p;
}

inline std::shared_ptr<const Mesh> ball_mesh() {
  return sphere(12, Vec3d(0), 1.0, true).mesh();
}

}  // namespace komorebi::testing
