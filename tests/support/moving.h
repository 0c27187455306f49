// Things that move, rays at all times, and what they cover of a picture.
#pragma once

#include <cstring>
#include <functional>
#include <random>

#include "bvh/traverse.h"
#include "core/surface_point.h"
#include "support/ray_list.h"
#include "support/scenes.h"

namespace komorebi::testing {

using Way = std::function<Mat4d(double)>;

inline void add_moving(Scene& scene, const std::shared_ptr<const Mesh>& mesh, const Way& way,
                       int count) {
  std::vector<Mat4d> poses;
  for (int i = 0; i < count; ++i) poses.push_back(way(double(i) / (count - 1)));
  const InstanceInput instance{scene.add_mesh(mesh), poses[static_cast<std::size_t>(count / 2)]};
  scene.add_moving_instances({&instance, 1}, poses, "moving");
}

inline Mat4d translated(double x, double y, double z) {
  return glm::translate(Mat4d(1.0), Vec3d(x, y, z));
}

inline RayList random_rays(std::uint32_t count, const Vec3& centre, float radius) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  RayList rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    Ray ray;
    const Vec3 target = centre + radius * Vec3(number(random), number(random), number(random));
    ray.origin = centre + 2.0f * radius * Vec3(number(random), number(random), number(random));
    ray.direction = target - ray.origin;
    ray.time = i % 7 == 0 ? 0.25f * float(i % 5) : 0.5f + 0.5f * number(random);
    ray.mask = i % 3 == 0 ? kMaskShadow : kMaskAll;
    if (i % 11 == 0) ray.self_instance = i % 4, ray.self_primitive = i % 50;
    rays.push_back(ray);
  }
  return rays;
}

/// Closest and any hits of every kernel are those of brute force; how many hits there are.
inline std::uint32_t expect_brute_force(const Scene& scene, const RayList& rays) {
  std::vector<Hit> expected, hits(rays.size());
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    expected.push_back(intersect_brute_force(scene.view(), rays[i]));
    found += expected.back().valid() ? 1u : 0u;
  }
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    intersect(scene.view(), rays.span(), hits.data());
    std::vector<std::uint32_t> bits((rays.size() + 31) / 32);
    occluded(scene.view(), rays.span(), bits.data());
    std::uint32_t wrong = 0;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      wrong += std::memcmp(&expected[i], &hits[i], sizeof(Hit)) != 0;
      wrong += ((bits[i / 32] >> (i % 32)) & 1u) != (expected[i].valid() ? 1u : 0u);
    }
    EXPECT_EQ(wrong, 0u) << name;
  }
  force_instruction_set("");
  return found;
}

/// The alpha of a row of pixels of an orthographic picture of [−1, 1]², seen from above.
inline std::vector<double> coverage(const std::shared_ptr<Scene>& scene, std::uint32_t width,
                                    std::uint32_t row) {
  Settings settings;
  settings.samples = 8192;
  settings.light_samples = 1;
  settings.film_transparent = true;
  settings.pixel_filter = PixelFilter::kBox;
  settings.has_region = true;
  settings.region = {0, row, width, row + 1};
  const auto picture = render(committed(scene), settings);
  std::vector<double> alpha;
  for (std::uint32_t x = 0; x < width; ++x) alpha.push_back(double{picture[4 * x + 3]});
  return alpha;
}

inline CameraDesc from_above(std::uint32_t width) {
  CameraDesc camera = probe_at(Vec3d(0.0), Vec3d(0, 0, 1), 1.0);
  camera.width = camera.height = width;
  return camera;
}

/// The share of time that a square from −0.2 to 0.2, which moves by 1, covers of a pixel from x to
/// x + 0.05, the middle of its way being 0.
inline double trapezoid(double x) {
  const auto integral = [](double at) {
    const auto ramp = [](double past) { return past > 0.0 ? 0.5 * past * past : 0.0; };
    return ramp(at + 0.7) - ramp(at + 0.3) - ramp(at - 0.3) + ramp(at - 0.7);
  };
  return (integral(x + 0.05) - integral(x)) / 0.05;
}

}  // namespace komorebi::testing
