// Light that bounces, against formulas and against a path tracer without any of the renderer's
// shortcuts: no light rays, no roulette, no tree.

#include <gtest/gtest.h>

#include <random>

#include "bvh/traverse.h"
#include "core/surface_point.h"
#include "render/batch.h"
#include "render/one_ray.h"
#include "support/busy_scenes.h"
#include "support/cavity.h"

namespace komorebi::testing {
namespace {

constexpr double kPi = glm::pi<double>();

void expect_cavity(Settings settings, double albedo, std::uint32_t bounces) {
  const Cavity hollow = cavity(64, 16);
  const auto scene =
      committed(make_scene({{hollow.mesh}}, camera_at({0.3, 0.1, 0.2}, {0.1, 0.5, -1}, 24, 16)));
  settings.bounces = bounces;
  settings.samples = 256;
  settings.clay_color = Vec3(static_cast<float>(albedo));
  const Estimate e = estimate(render(scene, settings));
  const double first = settings.method == Method::kWorldLight ? albedo : 1.0;
  const double exact = cavity_light(albedo, first, hollow.open, bounces);
  EXPECT_NEAR(e.mean, exact, 4.0 * e.error + 1e-3 * exact) << bounces << " bounces";
  EXPECT_LT(e.error, 5e-3 * exact);
}

TEST(Bounces, InACavityAreAGeometricSeries) {
  Settings settings;
  settings.method = Method::kWorldLight;
  for (const std::uint32_t bounces : {0u, 1u, 2u, 4u, 8u}) expect_cavity(settings, 0.8, bounces);
}

TEST(Bounces, InACavityComeToALimit) {
  Settings settings;
  settings.method = Method::kWorldLight;
  const double open = cavity(64, 16).open;
  EXPECT_NEAR(cavity_light(0.8, 0.8, open, 64), 0.8 * open / (1.0 - 0.8 * (1.0 - open)), 1e-9);
  expect_cavity(settings, 0.8, 64);
}

TEST(Bounces, OfWhiteClayLoseNothingAndAddNothing) {
  Settings settings;
  settings.method = Method::kWorldLight;
  expect_cavity(settings, 1.0, 3);
  expect_cavity(settings, 1.0, 256);  // all of the sky comes back
}

TEST(Bounces, OfAmbientOcclusionBeginAtAWhiteSurface) {
  Settings settings;
  for (const std::uint32_t bounces : {0u, 1u, 6u}) expect_cavity(settings, 0.5, bounces);
}

std::shared_ptr<const Environment> sunny_map() {
  std::vector<float> texels;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const float sun = x == 9 && y == 12 ? 40.0f : 0.0f;
      texels.insert(texels.end(), {0.1f + 0.02f * static_cast<float>(x) + sun, 0.5f + sun,
                                   0.05f * static_cast<float>(y) + sun});
    }
  }
  return std::make_shared<Environment>("sunny", 32, 16, std::move(texels));
}

/// Two walls, a floor, a roof over a part of it and a ball between them; the roof is not there for
/// shadow rays, if asked for.
std::shared_ptr<Scene> corner(bool split = false) {
  const auto floor = quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}).mesh();
  const auto wall = quad({-2, 2, 0}, {4, 0, 0}, {0, 0, 3}).mesh();
  const auto side = quad({-2, -2, 0}, {0, 4, 0}, {0, 0, 3}).mesh();
  const auto roof = quad({-2, 0, 2.5}, {4, 0, 0}, {0, 2, 0}).mesh();
  const auto ball = sphere(12, {-0.6, 0.8, 0.6}, 0.6, false).mesh();
  auto scene = std::make_shared<Scene>();
  for (const auto& mesh : {floor, wall, side, ball, roof}) {
    const std::uint32_t mask = mesh == roof && split ? kMaskAll & ~kMaskShadow : kMaskAll;
    const InstanceInput instance{scene->add_mesh(mesh), Mat4d(1.0), 0, mask, 0};
    scene->add_instances({&instance, 1}, "test");
  }
  scene->set_world_environment(sunny_map(), 0.7, Mat3d(1.0));
  scene->set_camera(probe_at({-1.2, 1.5, 0}, {0, 0, 1}, 0.05));
  return committed(scene);
}

/// The mean radiance of the probe's patch by paths that are scattered evenly over the hemisphere
/// and bring what they find when they leave, and its standard error.
Estimate traced_by_brute_force(const Scene& scene, const Vec3& albedo, std::uint32_t bounces) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  constexpr int kPaths = 400000;
  const EnvironmentView sky = scene.environment();
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kPaths; ++i) {
    Ray ray;
    ray.origin = Vec3(static_cast<float>(-1.25 + 0.1 * unit(random)),
                      static_cast<float>(1.45 + 0.1 * unit(random)), 0.1f);
    ray.origin = Vec3(Vec3d(ray.origin) - scene.origin());
    ray.direction = Vec3(0, 0, -1);
    double throughput = 1.0, brought = 0.0;
    for (std::uint32_t vertex = 0;; ++vertex) {
      const Hit hit = intersect_brute_force(scene.view(), ray);
      if (!hit.valid()) {
        brought = throughput * double{environment_radiance(sky, ray.direction).x};
        break;
      }
      if (vertex == bounces + 1) break;
      const SurfacePoint point = surface_point(scene.view(), hit, ray);
      const double z = unit(random), phi = 2.0 * kPi * unit(random), r = std::sqrt(1.0 - z * z);
      const Vec3d n(point.normal);
      const Vec3d t =
          glm::normalize(glm::cross(n, std::abs(n.x) > 0.5 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0)));
      ray = Ray{};
      ray.origin = leaving_origin(point);
      ray.direction = Vec3(r * std::cos(phi) * t + r * std::sin(phi) * glm::cross(n, t) + z * n);
      ray.self_instance = hit.instance;
      ray.self_primitive = hit.primitive;
      throughput *= double{albedo.x} * 2.0 * z;
    }
    sum += brought;
    squares += brought * brought;
  }
  const double mean = sum / kPaths;
  return {mean, std::sqrt((squares / kPaths - mean * mean) / kPaths)};
}

TEST(Bounces, UnderAMapAgreeWithBruteForce) {
  const auto scene = corner();
  for (const std::uint32_t bounces : {0u, 1u, 4u}) {
    Settings settings;
    settings.method = Method::kWorldLight;
    settings.clay_color = Vec3(0.8f, 0.3f, 0.1f);
    settings.sample_clamp_indirect = 0.0f;
    settings.samples = 512;
    settings.bounces = bounces;
    const Estimate truth = traced_by_brute_force(*scene, settings.clay_color, bounces);
    for (const auto sampling :
         {EnvironmentSampling::kProduct, EnvironmentSampling::kMis, EnvironmentSampling::kCosine}) {
      settings.environment_sampling = sampling;
      const Estimate e = estimate(render(scene, settings));
      EXPECT_NEAR(e.mean, truth.mean, 4.0 * std::hypot(e.error, truth.error))
          << bounces << " bounces";
      EXPECT_LT(std::hypot(e.error, truth.error), 0.02 * truth.mean);
    }
  }
}

/// The probe's pixels, with or without the light that scattered rays bring where they leave.
Estimate with_sky_shared(const Scene& scene, const Settings& settings, bool shares) {
  const FilterTable filter(settings.pixel_filter, settings.filter_width);
  RenderContext context = make_context(scene, settings, filter.view());
  EXPECT_TRUE(context.shares_light);
  context.shares_light = shares;
  context.passes = {};
  context.light_samples = 1;
  std::vector<PixelPlace> pixels;
  for (std::uint32_t i = 0; i < 256; ++i) pixels.push_back({i % 16, i / 16});
  std::vector<Vec3> radiance(settings.samples * pixels.size());
  EXPECT_TRUE(BatchIntegrator(context).sample(pixels, settings.samples, radiance.data(), Cancel()));
  std::vector<float> means(4 * pixels.size());
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    means[i / settings.samples * 4] += radiance[i].x / static_cast<float>(settings.samples);
  }
  return estimate(means);
}

TEST(Bounces, ShareTheSkyWithLightRaysWithoutBias) {
  const auto scene = corner();
  for (const auto method : {Method::kWorldLight, Method::kAmbientOcclusion}) {
    for (const auto sampling : {EnvironmentSampling::kProduct, EnvironmentSampling::kMis,
                                EnvironmentSampling::kCosine, EnvironmentSampling::kEnvironment}) {
      Settings settings;
      settings.method = method;
      settings.environment_sampling = sampling;
      const bool uniform = sampling == EnvironmentSampling::kEnvironment;
      settings.ao_sampling = uniform ? AoSampling::kUniform : AoSampling::kCosine;
      settings.ao_distance = 3.0f;
      settings.sample_clamp_indirect = 0.0f;
      settings.samples = 256;
      settings.bounces = 4;
      const Estimate apart = with_sky_shared(*scene, settings, false);
      const Estimate shared = with_sky_shared(*scene, settings, true);
      EXPECT_NE(shared.mean, apart.mean);
      EXPECT_NEAR(shared.mean, apart.mean, 4.0 * std::hypot(shared.error, apart.error));
      EXPECT_LT(shared.error, 1.1 * apart.error);  // which is itself known to 4 %
      EXPECT_LT(apart.error, 0.02 * apart.mean);
    }
  }
}

/// Of the scene with catchers, terminators, cut-outs and lobes, in which some objects are hidden
/// from some rays, so that a render would not do it there.
TEST(Bounces, ShareTheSkyInBatchesAsOneRayDoesAfterAnother) {
  const Lottery lottery(0.6);
  const auto scene = telling_scene(&lottery, many_lobes());
  Settings settings = small_settings(Method::kWorldLight);
  settings.bounces = 4;
  const FilterTable filter(settings.pixel_filter, settings.filter_width);
  RenderContext context = make_context(*scene, settings, filter.view());
  ASSERT_FALSE(context.shares_light);
  context.passes = {};
  std::vector<PixelPlace> pixels;
  for (std::uint32_t i = 0; i < 60; ++i) pixels.push_back({5 + 7 * (i % 20), 10 + 25 * (i / 20)});
  constexpr std::uint32_t kCount = 8;
  std::vector<Vec3> found(kCount * pixels.size()), apart(found.size());
  ASSERT_TRUE(BatchIntegrator(context).sample(pixels, kCount, apart.data(), Cancel()));
  context.shares_light = true;
  ASSERT_TRUE(BatchIntegrator(context).sample(pixels, kCount, found.data(), Cancel()));
  EXPECT_NE(found, apart);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const PixelPlace at = pixels[i / kCount];
    const auto sample = static_cast<std::uint32_t>(i % kCount);
    EXPECT_EQ(found[i], render_sample(context, at.x, at.y, sample, nullptr).radiance) << i;
  }
}

TEST(Bounces, OfSurfacesWithMaterialsAreThoseOfClay) {
  const auto scene = corner(true);
  Settings settings;
  settings.method = Method::kWorldLight;
  settings.clay_color = Vec3(0.8f, 0.3f, 0.1f);
  settings.bounces = 3;
  const FilterTable filter(settings.pixel_filter, settings.filter_width);
  RenderContext clay = make_context(*scene, settings, filter.view());
  clay.passes = {};
  RenderContext materials = clay;
  materials.has_materials = true;
  materials.albedo = Vec3(1.0f);
  const std::vector<PixelPlace> pixels = {{1, 2}, {7, 3}, {12, 12}};
  constexpr std::uint32_t kCount = 50;
  std::vector<Vec3> expected(kCount * pixels.size()), found(expected.size());
  ASSERT_TRUE(BatchIntegrator(clay).sample(pixels, kCount, expected.data(), Cancel()));
  ASSERT_TRUE(BatchIntegrator(materials).sample(pixels, kCount, found.data(), Cancel()));
  for (std::size_t i = 0; i < found.size(); ++i) {
    const PixelPlace at = pixels[i / kCount];
    EXPECT_EQ(found[i],
              render_sample(materials, at.x, at.y, static_cast<std::uint32_t>(i % kCount), nullptr)
                  .radiance);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i][c], expected[i][c], 1e-5f * expected[i][c]);
  }
}

TEST(Bounces, AreClampedByTheMeanOfTheirChannels) {
  const auto scene = corner();
  Settings settings;
  settings.method = Method::kWorldLight;
  settings.samples = 64;
  const double direct = estimate(render(scene, settings)).mean;
  settings.bounces = 1;
  settings.sample_clamp_indirect = 1e-3f;
  const double clamped = estimate(render(scene, settings)).mean;
  EXPECT_GT(clamped, direct + 1e-5);
  EXPECT_LT(clamped, direct + 3e-3);  // red is at most the sum of three
  settings.bounces = 0;
  settings.sample_clamp_direct = 1e-3f;
  const auto picture = render(scene, settings);
  for (std::size_t i = 0; i < picture.size(); i += 4) {
    EXPECT_LE(picture[i] + picture[i + 1] + picture[i + 2], 3.001e-3f);
  }
}

}  // namespace
}  // namespace komorebi::testing
