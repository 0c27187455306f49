// Things that diffuse rays see and shadow rays do not, or the other way round, under a map: what
// Cycles' two kinds of rays find together, by quadrature.

#include <gtest/gtest.h>

#include "support/environment_maps.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

constexpr int kPoints = 48;  // a side of each patch of the map
constexpr float kAlbedo = 0.8f;

/// A level plate above the floor.
struct Plate {
  Vec3d low, size;
  std::uint32_t mask, flags = 0;

  bool hides(const Vec3d& direction, double distance) const {  // from the origin
    if (!(direction.z * distance > low.z)) return false;
    const Vec3d at = direction * (low.z / direction.z) - low;
    return at.x > 0.0 && at.x < size.x && at.y > 0.0 && at.y < size.y;
  }
};

/// Over a part of each other, and each over a part of the sky that the other leaves.
const Plate kForDiffuse = {{-1.0, -0.6, 0.5}, {1.6, 0.9, 0}, kMaskDiffuse};
const Plate kForShadow = {{-0.2, -0.5, 0.8}, {1.7, 2.0, 0}, kMaskShadow};

std::shared_ptr<const Environment> map() {
  static const std::shared_ptr<const Environment> made(new Environment(random_map(16, 8, 11)));
  return made;
}

/// Plates over a floor, of which the origin is looked at, from between it and the plates.
std::shared_ptr<Scene> floor_under(const std::vector<Plate>& plates, std::uint32_t flags = 0) {
  auto scene = std::make_shared<Scene>();
  CameraDesc camera = probe_at({0, 0, 0}, {0, 0, 1}, 1e-4);
  camera.clip_start = 0.7;
  camera.clip_from_world = glm::ortho(-1e-4, 1e-4, -1e-4, 1e-4, 0.7, 1.5) *
                           glm::lookAt(Vec3d(0, 0, 1), Vec3d(0, 0, 0), Vec3d(0, 1, 0));
  scene->set_camera(camera);
  scene->set_world_environment(map(), 0.7, Mat3d(1.0));
  const auto add = [&](const Polygons& shape, std::uint32_t mask, std::uint32_t its_flags) {
    const InstanceInput instance{scene->add_mesh(shape.mesh()), Mat4d(1.0), 0, mask, its_flags, 0};
    scene->add_instances({&instance, 1}, "test");
  };
  add(quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), kMaskAll, flags);
  for (const Plate& plate : plates) {
    add(quad(plate.low, {plate.size.x, 0, 0}, {0, plate.size.y, 0}), plate.mask, plate.flags);
  }
  return committed(scene);
}

constexpr double kFar = 1e9;

/// The light of red that the two kinds of rays bring together: each weighted by the power heuristic
/// over its own density and the other's. Those sampled by the surface find nothing beyond
/// `distance`, and of the light a part `factor` counts.
double light_under(const std::vector<Plate>& plates, double distance = kFar, double factor = 1.0) {
  const auto mean = [](const Vec3d& rgb) { return (rgb.x + rgb.y + rgb.z) / 3.0; };
  const EnvironmentView sky = map()->view(0.7);
  const double flux =
      integrate_map(sky, kPoints, [&](const Vec3d& l, const Vec3d&) { return mean(l); });
  const double red = integrate_map(sky, kPoints, [&](const Vec3d& l, const Vec3d& direction) {
    if (!(direction.z > 0.0)) return 0.0;
    const double of_surface = direction.z / kPi, of_map = mean(l) / flux;
    const double squares = of_surface * of_surface + of_map * of_map;
    double found = 0.0;
    for (const std::uint32_t kind : {kMaskDiffuse, kMaskShadow}) {
      bool hidden = false;
      for (const Plate& plate : plates) {
        hidden = hidden || ((plate.mask & kind) != 0 &&
                            plate.hides(direction, kind == kMaskDiffuse ? distance : kFar));
      }
      const double own = kind == kMaskDiffuse ? of_surface : of_map;
      if (!hidden) found += own * own / squares * (kind == kMaskDiffuse ? factor : 1.0);
    }
    return found * l.x * direction.z;
  });
  return double{kAlbedo} / kPi * 0.7 * red;
}

Settings world_light() {
  Settings s;
  s.method = Method::kWorldLight;
  s.clay_color = Vec3(kAlbedo);
  s.pixel_filter = PixelFilter::kBox;
  s.samples = 256;
  s.light_samples = 8;
  return s;
}

class SplitLight : public ::testing::TestWithParam<EnvironmentSampling> {
 protected:
  void expect_quadrature(const std::vector<Plate>& plates, double distance = kFar,
                         double factor = 1.0) const {
    Settings settings = world_light();
    settings.environment_sampling = GetParam();
    settings.use_fast_gi = distance < kFar;
    settings.fast_gi_distance = static_cast<float>(distance);
    settings.fast_gi_factor = static_cast<float>(factor);
    const Estimate e = estimate(render(floor_under(plates), settings));
    const double exact = light_under(plates, distance, factor);
    EXPECT_NEAR(e.mean, exact, 4.0 * e.error + 1e-3 * exact);
    EXPECT_LT(e.error, 0.01 * exact);
  }
};

TEST_P(SplitLight, OfThingsWithoutShadow) {
  expect_quadrature({kForDiffuse});
}

TEST_P(SplitLight, OfThingsThatOnlyCastShadow) {
  expect_quadrature({kForShadow});
}

TEST_P(SplitLight, OfBothOverEachOther) {
  expect_quadrature({kForDiffuse, kForShadow});
}

TEST_P(SplitLight, ThatEndsInAmbientOcclusion) {
  Plate low = kForDiffuse, high = kForShadow;
  low.mask = high.mask = kMaskAll;
  const double all = light_under({low, high});
  for (const double distance : {0.4, 0.7, 1.0}) {
    EXPECT_GT(light_under({low, high}, distance), 1.05 * all);
    expect_quadrature({low, high}, distance);
  }
  expect_quadrature({low, high}, 0.7, 0.5);
  expect_quadrature({low, kForDiffuse, kForShadow}, 0.9, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Sampling, SplitLight,
                         ::testing::Values(EnvironmentSampling::kProduct, EnvironmentSampling::kMis,
                                           EnvironmentSampling::kCosine,
                                           EnvironmentSampling::kEnvironment));

TEST(SplitLight, TheCasesDiffer) {
  Plate for_both = kForDiffuse, for_none = kForDiffuse;
  for_both.mask = kMaskDiffuse | kMaskShadow;
  for_none.mask = kMaskCamera;
  const double half = light_under({kForDiffuse});
  EXPECT_GT(half, 1.1 * light_under({for_both}));
  EXPECT_LT(half, 0.9 * light_under({for_none}));
}

TEST(SplitLight, ACatcherIsLitAloneByBothKindsOfRays) {
  for (const bool swapped : {false, true}) {
    Plate thing = swapped ? kForShadow : kForDiffuse, catcher = swapped ? kForDiffuse : kForShadow;
    catcher.flags = kInstanceShadowCatcher;
    Settings settings = world_light();
    settings.passes = {"Combined", "Shadow Catcher"};
    const auto pass =
        render(floor_under({thing, catcher}, kInstanceShadowCatcher), settings, "Shadow Catcher");
    double mean = 0.0;
    for (std::size_t i = 0; i < pass.size(); i += 3) {
      mean += double{pass[i]} * 3.0 / static_cast<double>(pass.size());
    }
    EXPECT_NEAR(mean, light_under({thing, catcher}) / light_under({catcher}), 3e-3);
  }
}

TEST(SplitLight, ThingsThatAreSeenAlikeAreAskedOnce) {
  Plate alike = kForDiffuse;
  const FilterTable filter(PixelFilter::kBox, 1.0f);
  for (const std::uint32_t mask : {kMaskCamera | 0u, kMaskDiffuse | kMaskShadow, kMaskAll | 0u}) {
    alike.mask = mask;
    EXPECT_EQ(make_context(*floor_under({alike}), world_light(), filter.view()).surface_mask, 0u);
  }
  Settings settings = world_light();
  const auto split = floor_under({kForDiffuse});
  EXPECT_EQ(make_context(*split, settings, filter.view()).surface_mask, kMaskDiffuse);
  settings.method = Method::kAmbientOcclusion;
  EXPECT_EQ(make_context(*split, settings, filter.view()).surface_mask, 0u);
}

TEST(MeanFlux, IsTheIntegralOfTheMapsMeanColour) {
  const Environment sunny = sunny_map(64, 32, 9, 25, 900.0f), random = random_map(64, 32, 5);
  for (const Environment* e : {&sunny, &random}) {
    const double exact = integrate_map(
        e->view(), 8, [](const Vec3d& l, const Vec3d&) { return (l.x + l.y + l.z) / 3.0; });
    EXPECT_NEAR(e->mean_flux(), exact, 2e-3 * exact);
  }
}

}  // namespace
}  // namespace komorebi::testing
