// Camera rays started in lanes are those of start_ray, to the bit, for every instruction set.
#include "render/camera_kernel.h"

#include <gtest/gtest.h>

#include "bvh/traverse.h"
#include "core/sampler.h"
#include "render/filter.h"
#include "render/one_ray.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

constexpr std::uint32_t kCount = 1003, kPadded = 1024;

void expect_equal_to_scalar(const RenderContext& context) {
  std::vector<std::uint32_t> words[4];
  for (auto& column : words) column.assign(kPadded, 0);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    words[0][i] = 7 * i % 150;
    words[1][i] = 5 * i % 90;
    words[2][i] = i < 500 ? i : hash_bits(i);
    words[3][i] = Sampler(context.seed, words[0][i], words[1][i]).pixel_seed;
  }
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    std::vector<float> columns[8];
    for (auto& column : columns) column.assign(kPadded, -1.0f);
    CameraBlock block{};
    block.count = kCount;
    block.x = words[0].data();
    block.y = words[1].data();
    block.sample = words[2].data();
    block.pixel_seed = words[3].data();
    for (std::size_t c = 0; c < 3; ++c) {
      block.origin[c] = columns[c].data();
      block.direction[c] = columns[3 + c].data();
    }
    block.t_max = columns[6].data();
    block.time = columns[7].data();
    start_rays(context, block);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const Ray ray = start_ray(context, words[0][i], words[1][i], words[2][i]);
      ASSERT_EQ(ray.t_min, 0.0f);
      ASSERT_EQ(Vec3(columns[0][i], columns[1][i], columns[2][i]), ray.origin) << name << i;
      ASSERT_EQ(Vec3(columns[3][i], columns[4][i], columns[5][i]), ray.direction) << name << i;
      ASSERT_EQ(columns[6][i], ray.t_max) << name << i;
      ASSERT_EQ(columns[7][i], ray.time) << name << i;
    }
  }
  force_instruction_set("");
}

TEST(CameraKernel, EveryFilterAndKind) {
  const auto scene = committed(make_scene({{sphere(8, {0, 0, 0}, 1.0, false).mesh()}},
                                          camera_at({5, -4, 3}, {0, 0, 0.8}, 150, 90)));
  for (const auto kind :
       {PixelFilter::kBlackmanHarris, PixelFilter::kGaussian, PixelFilter::kBox}) {
    Settings settings;
    settings.seed = 3;
    settings.pixel_filter = kind;
    const FilterTable filter(kind, 1.7f);
    RenderContext context = make_context(*scene, settings, filter.view());
    expect_equal_to_scalar(context);
    context.camera.kind = CameraKind::kOrthographic;
    expect_equal_to_scalar(context);
  }
}

CameraDesc with_lens(CameraDesc camera, std::uint32_t blades) {
  camera.lens = {0.2, blades, 0.7, 1.4, 5.0};
  return camera;
}

TEST(CameraKernel, EveryLensPanoramaAndEye) {
  const FilterTable filter(PixelFilter::kBlackmanHarris, 1.5f);
  const auto check = [&](const CameraDesc& camera) {
    const auto scene = committed(make_scene({{sphere(8, {0, 0, 0}, 1.0, false).mesh()}}, camera));
    expect_equal_to_scalar(make_context(*scene, Settings{}, filter.view()));
  };
  const CameraDesc perspective = camera_at({5, -4, 3}, {0, 0, 0.8}, 150, 90);
  for (const std::uint32_t blades : {0u, 3u, 5u, 16u}) {
    check(with_lens(perspective, blades));
    check(with_lens(probe_at({0, 0, 1}, {0, 0.6, 0.8}, 2.0), blades));
  }
  CameraDesc eye = perspective;
  eye.stereo = {0.1, 3.0, 0.1, 0.5};
  check(eye);
  check(with_lens(eye, 6));
  CameraDesc panorama = perspective;
  panorama.kind = CameraKind::kPanorama;
  panorama.panorama.fov = 2.0;
  panorama.panorama.polynomial[1] = -0.05;
  for (std::uint32_t kind = 0; kind < 7; ++kind) {
    panorama.panorama.kind = static_cast<PanoramaKind>(kind);
    check(panorama);
    check(with_lens(panorama, 5));
  }
}

TEST(CameraKernel, MovesZoomsAndOpensAsOneRay) {
  const FilterTable filter(PixelFilter::kBlackmanHarris, 1.5f);
  CameraDesc camera = camera_at({5, -4, 3}, {0, 0, 0.8}, 150, 90);
  const auto check = [&] {
    const auto scene = committed(make_scene({{sphere(8, {0, 0, 0}, 1.0, false).mesh()}}, camera));
    expect_equal_to_scalar(make_context(*scene, Settings{}, filter.view()));
  };
  camera.shutter = {{0.0f, 1.0f, 0.3f}, true, 0.4};
  check();
  const Mat4d rest = glm::inverse(glm::lookAt(Vec3d(5, -4, 3), Vec3d(0, 0, 0.8), Vec3d(0, 0, 1)));
  for (const double x : {-0.5, 0.0, 1.0}) {
    camera.motion.poses.push_back(
        glm::rotate(glm::translate(Mat4d(1.0), Vec3d(x, 0, 0)), 0.3 * x, Vec3d(0, 0, 1)) * rest);
  }
  check();
  camera.motion.zoom_open = 1.3;
  camera.lens = {0.2, 5, 0.7, 1.4, 5.0};
  check();
  camera.shutter = {};
  check();
}

}  // namespace
}  // namespace komorebi::testing
