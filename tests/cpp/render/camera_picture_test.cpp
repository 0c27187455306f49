// Pictures of fisheyes and lenses: samples without a ray are black, opaque and far; batches agree
// with one ray after another.

#include <gtest/gtest.h>

#include "bvh/traverse.h"
#include "render/batch.h"
#include "render/filter.h"
#include "render/one_ray.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

constexpr std::uint32_t kSize = 48;

/// A fisheye inside a ball above a ground: every ray hits something, but corners have none.
CameraDesc fisheye() {
  CameraDesc camera = camera_at({0.2, 0.1, 1.0}, {1, 1, 1}, kSize, kSize);
  camera.kind = CameraKind::kPanorama;
  camera.world_from_camera[3] = glm::dvec4(0.2, 0.1, 1.0, 1.0);
  camera.panorama.kind = PanoramaKind::kFisheyeEquidistant;
  camera.panorama.fov = 3.5;
  return camera;
}

std::shared_ptr<Scene> ball_and_ground(const CameraDesc& camera) {
  return committed(make_scene({{quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh()},
                               {sphere(24, {0, 0, 1}, 4.0, false).mesh()}},
                              camera, Vec3(0.5f)));
}

Settings settings() {
  Settings s;
  s.samples = 5;
  s.light_samples = 2;
  s.has_region = true;
  s.region = {0, 0, kSize, kSize};
  s.passes = {"Combined", "Depth", "Normal"};
  return s;
}

TEST(CameraPicture, CornersOfAFisheyeAreBlackOpaqueAndFar) {
  const auto scene = ball_and_ground(fisheye());
  for (const bool transparent : {false, true}) {
    Settings s = settings();
    s.film_transparent = transparent;
    const std::vector<float> picture = render(scene, s), depth = render(scene, s, "Depth");
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
      return std::vector<float>(&picture[4 * (y * kSize + x)], &picture[4 * (y * kSize + x)] + 4);
    };
    for (const std::uint32_t x : {0u, kSize - 1}) {
      for (const std::uint32_t y : {0u, kSize - 1}) {
        EXPECT_EQ(at(x, y), std::vector<float>({0.0f, 0.0f, 0.0f, 1.0f}));
        EXPECT_EQ(depth[y * kSize + x], 1e10f);
      }
    }
    EXPECT_EQ(at(kSize / 2, kSize / 2)[3], 1.0f);
    EXPECT_LT(depth[kSize * kSize / 2 + kSize / 2], 10.0f);
  }
}

TEST(CameraPicture, BatchesAgreeWithOneRayAfterAnother) {
  CameraDesc lens = camera_at({5, -4, 3}, {0, 0, 0.8}, kSize, kSize);
  lens.lens = {0.3, 5, 0.2, 1.3, 5.0};
  CameraDesc fish_lens = fisheye();
  fish_lens.lens = {0.3, 0, 0.0, 1.0, 2.0};
  fish_lens.stereo = {0.1, 2.0, 0.5, 1.0};
  for (const CameraDesc& camera : {fisheye(), lens, fish_lens}) {
    const auto scene = ball_and_ground(camera);
    const Settings s = settings();
    const FilterTable filter(s.pixel_filter, s.filter_width);
    const RenderContext context = make_context(*scene, s, filter.view());
    std::vector<PixelPlace> pixels;
    for (std::uint32_t y = 0; y < kSize; ++y) {
      for (std::uint32_t x = 0; x < kSize; ++x) pixels.push_back({x, y});
    }
    std::vector<float> row(context.passes.size());
    std::vector<Vec3> radiance(5 * pixels.size());
    for (const std::string& name : built_instruction_sets()) {
      force_instruction_set(name);
      BatchIntegrator integrator(context);
      ASSERT_TRUE(integrator.sample(pixels, 5, radiance.data(), Cancel()));
      for (std::size_t p = 0; p < pixels.size(); ++p) {
        for (std::uint32_t i = 0; i < 5; ++i) {
          const PixelSample one = render_sample(context, pixels[p].x, pixels[p].y, i, row.data());
          ASSERT_EQ(radiance[5 * p + i], one.radiance) << name << ' ' << p << ' ' << i;
        }
      }
    }
    force_instruction_set("");
  }
}

}  // namespace
}  // namespace komorebi::testing
