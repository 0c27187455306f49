#pragma once

#include "support/environment_maps.h"
#include "support/scenes.h"

namespace komorebi::testing {

/// A roofed way of 24 × 4 × 3 m along x, with walls to its left and right in turns of 4 m: what is
/// seen of the sky, which is nearly even, is on the one side here and on the other there.
inline std::shared_ptr<Scene> arcade(std::uint32_t width, std::uint32_t height) {
  const auto part = [](const Vec3d& corner, const Vec3d& a, const Vec3d& b) {
    return Placed{quad(corner, a, b).mesh()};
  };
  std::vector<Placed> parts = {part({0, -2, 0}, {24, 0, 0}, {0, 4, 0}),
                               part({0, -2, 3}, {24, 0, 0}, {0, 4, 0}),
                               part({24, -2, 0}, {0, 4, 0}, {0, 0, 3})};
  for (int i = 0; i < 6; ++i) {
    parts.push_back(part({4.0 * i, i % 2 == 0 ? -2.0 : 2.0, 0}, {4, 0, 0}, {0, 0, 3}));
  }
  auto scene = make_scene(parts, camera_at({0.2, 0, 2}, {12, 0, 0.5}, width, height));
  std::vector<float> texels;
  for (std::uint32_t i = 0; i < 64 * 32; ++i) {
    const float up = static_cast<float>(i / 64) / 32.0f;
    for (const float c : {0.5f, 0.7f, 1.0f}) texels.push_back(c + 0.3f * up);
  }
  const auto map = std::shared_ptr<const Environment>(new Environment(make_map(64, 32, texels)));
  scene->set_world_environment(map, 0.7, Mat3d(1.0));
  return committed(scene);
}

}  // namespace komorebi::testing
