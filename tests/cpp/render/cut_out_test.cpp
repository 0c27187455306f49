// What a share of the rays passes by lot: coverage and light in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "support/lottery.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

/// A ground, and above it a plate that stops a share of all rays, seen from between by `camera`.
std::shared_ptr<Scene> under_a_plate(const Lottery& lottery, const CameraDesc& camera) {
  auto scene = std::make_shared<Scene>();
  const auto add = [&](const Polygons& polygons, std::uint32_t list) {
    const InstanceInput input{scene->add_mesh(polygons.mesh()), Mat4d(1.0), 0, kMaskAll, 0, list};
    scene->add_instances({&input, 1}, "test");
  };
  add(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), 0);
  add(quad({-5000, -5000, 1}, {10000, 0, 0}, {0, 10000, 0}), 1);
  SceneTables tables;
  tables.materials = {{}, {}};
  tables.slot_begin = {0, 1, 2};
  tables.slots = {0, 1};
  scene->set_tables(std::move(tables));
  scene->set_hit_filter(lottery.filter(), {0, 1});
  scene->set_world_color(Vec3(1.0f));
  scene->set_camera(camera);
  return committed(scene);
}

Settings of(Method method) {
  Settings settings;
  settings.method = method;
  settings.samples = 64;
  settings.light_samples = 4;
  settings.clay_color = Vec3(1.0f);
  return settings;
}

TEST(CutOuts, LetLightThroughByTheirShare) {
  for (const double share : {0.25, 0.7}) {
    const Lottery lottery(share);
    const auto scene = under_a_plate(lottery, probe_at({0, 0, 0}, {0, 0, 1}, 0.3));
    for (const Method method : {Method::kAmbientOcclusion, Method::kWorldLight}) {
      // The probe's camera begins below the plate.
      const Estimate found = estimate(render(scene, of(method)));
      EXPECT_NEAR(found.mean, 1.0 - share, 4.0 * found.error + 1e-3);
      EXPECT_LT(found.error, 0.01);
    }
  }
}

TEST(CutOuts, AreSeenByTheirShare) {
  const Lottery lottery(0.3);
  CameraDesc camera = probe_at({0, 0, 5}, {0, 0, -1}, 0.3);  // from below, past the ground
  camera.clip_from_world = glm::ortho(-0.3, 0.3, -0.3, 0.3, 0.1, 9.0) *
                           glm::lookAt(Vec3d(0, 0, 0.5), Vec3d(0, 0, 5), Vec3d(0, 1, 0));
  camera.clip_start = 0.1;
  camera.clip_end = 9.0;
  const auto scene = under_a_plate(lottery, camera);
  Settings settings = of(Method::kAmbientOcclusion);
  settings.film_transparent = true;
  const auto picture = render(scene, settings);
  double alpha = 0.0;
  for (std::size_t i = 3; i < picture.size(); i += 4) alpha += double{picture[i]};
  const double rays = 64.0 * 256.0;
  EXPECT_NEAR(alpha / 256.0, 0.3, 4.0 * std::sqrt(0.3 * 0.7 / rays));
}

}  // namespace
}  // namespace komorebi::testing
