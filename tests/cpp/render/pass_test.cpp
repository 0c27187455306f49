// What passes hold, against closed forms and against the picture itself.

#include <gtest/gtest.h>

#include <cmath>

#include "support/made_curves.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

InstanceInput placed(Scene& scene, const std::shared_ptr<const Mesh>& mesh, const Vec3d& at,
                     std::uint32_t flags = 0, std::uint32_t mask = kMaskAll) {
  return {scene.add_mesh(mesh), glm::translate(Mat4d(1.0), at), 0, mask, flags, 0};
}

/// A ground at z = 0 and a ball of radius 1 above the origin, each with flags of its own; the world
/// is white.
std::shared_ptr<Scene> ball_on_ground(const CameraDesc& camera, std::uint32_t ground_flags,
                                      std::uint32_t ball_flags,
                                      std::uint32_t ball_mask = kMaskAll) {
  auto scene = std::make_shared<Scene>();
  const InstanceInput instances[] = {
      placed(*scene, quad({-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0}).mesh(), Vec3d(0),
             ground_flags),
      placed(*scene, sphere(64, Vec3d(0), 1.0, true).mesh(), Vec3d(0, 0, 1.5), ball_flags,
             ball_mask)};
  scene->add_instances(instances, "test");
  scene->set_world_color(Vec3(1.0f));
  scene->set_camera(camera);
  return committed(scene);
}

/// Occlusion of a plane's point by a sphere of radius r, d away, at angle θ from the normal, wholly
/// above the plane: (r/d)² cos θ.
double hidden_by_ball(double x) {
  const double d2 = x * x + 1.5 * 1.5;
  return 1.0 / d2 * 1.5 / std::sqrt(d2);
}

Settings with_passes(std::vector<std::string> passes, Method method = Method::kAmbientOcclusion) {
  Settings s;
  s.method = method;
  s.samples = 64;
  s.light_samples = 16;
  s.passes = std::move(passes);
  s.clay_color = Vec3(1.0f);
  return s;
}

double mean_of(const std::vector<float>& values, std::size_t channels, std::size_t channel) {
  double sum = 0.0;
  for (std::size_t i = channel; i < values.size(); i += channels) sum += double{values[i]};
  return sum / (static_cast<double>(values.size()) / static_cast<double>(channels));
}

TEST(Passes, ShadowCatcherIsTheLightThatIsLeft) {
  for (const Method method : {Method::kAmbientOcclusion, Method::kWorldLight}) {
    const auto scene =
        ball_on_ground(probe_at({2, 0, 0}, {0, 0, 1}, 0.01), kInstanceShadowCatcher, 0);
    Settings settings = with_passes({"Combined", "Shadow Catcher"}, method);
    const double left = 1.0 - hidden_by_ball(2.0);
    EXPECT_NEAR(mean_of(render(scene, settings, "Shadow Catcher"), 3, 0), left, 2e-3);
    // Asked for as a pass, the shadow is not in the picture; else its darkness is alpha.
    settings.film_transparent = true;
    EXPECT_NEAR(mean_of(render(scene, settings), 4, 3), 0.0, 1e-6);
    settings.passes = {"Combined"};
    EXPECT_NEAR(mean_of(render(scene, settings), 4, 3), 1.0 - left, 2e-3);
    EXPECT_NEAR(mean_of(render(scene, settings), 4, 0), 0.0, 1e-6);
    settings.film_transparent = false;  // over the world, which is white
    EXPECT_NEAR(mean_of(render(scene, settings), 4, 0), left, 2e-3);
    EXPECT_NEAR(mean_of(render(scene, settings), 4, 3), 1.0, 1e-6);
  }
}

TEST(Passes, ACatcherInTheShadowOfACatcherIsNoDarker) {
  const auto scene = ball_on_ground(probe_at({2, 0, 0}, {0, 0, 1}, 0.01), kInstanceShadowCatcher,
                                    kInstanceShadowCatcher);
  const Settings settings = with_passes({"Combined", "Shadow Catcher"});
  EXPECT_NEAR(mean_of(render(scene, settings, "Shadow Catcher"), 3, 0), 1.0, 1e-6);
}

TEST(Passes, AHoldoutIsAHoleThatStillCastsShadows) {
  const auto on_ball = ball_on_ground(probe_at({0, 0, 2.5}, {0, 0, 1}, 0.01), 0, kInstanceHoldout);
  const Settings settings = with_passes({"Combined", "Depth", "Normal"});
  for (const float value : render(on_ball, settings)) EXPECT_EQ(value, 0.0f);
  for (const float value : render(on_ball, settings, "Depth")) EXPECT_EQ(value, 1e10f);
  const auto beside = ball_on_ground(probe_at({2, 0, 0}, {0, 0, 1}, 0.01), 0, kInstanceHoldout);
  EXPECT_NEAR(mean_of(render(beside, settings), 4, 0), 1.0 - hidden_by_ball(2.0), 2e-3);
  EXPECT_EQ(mean_of(render(beside, settings), 4, 3), 1.0);
}

TEST(Passes, RaysSeeWhatIsVisibleToThem) {
  const CameraDesc beside = probe_at({2, 0, 0}, {0, 0, 1}, 0.01);
  const CameraDesc above = probe_at({0, 0, 2.5}, {0, 0, 1}, 0.01);
  const double left = 1.0 - hidden_by_ball(2.0);
  const auto brightness = [&](const CameraDesc& camera, std::uint32_t mask, Method method) {
    const auto scene = ball_on_ground(camera, 0, 0, mask);
    return mean_of(render(scene, with_passes({"Combined"}, method)), 4, 0);
  };
  // Ambient occlusion asks for shadows, light from an even world goes by diffuse rays.
  EXPECT_NEAR(brightness(beside, kMaskShadow, Method::kAmbientOcclusion), left, 2e-3);
  EXPECT_NEAR(brightness(beside, kMaskDiffuse, Method::kAmbientOcclusion), 1.0, 1e-6);
  EXPECT_NEAR(brightness(beside, kMaskShadow, Method::kWorldLight), 1.0, 1e-6);
  EXPECT_NEAR(brightness(beside, kMaskDiffuse, Method::kWorldLight), left, 2e-3);
  const auto depth = [&](std::uint32_t mask) {
    const auto scene = ball_on_ground(above, 0, 0, mask);
    return mean_of(render(scene, with_passes({"Combined", "Depth"}), "Depth"), 1, 0);
  };
  EXPECT_NEAR(depth(kMaskCamera), 1.0, 1e-3);
  EXPECT_GT(depth(kMaskShadow | kMaskDiffuse), 1e9);  // beyond the ball lies what is clipped
}

/// Which pixels show no background at all.
std::vector<bool> surfaces_alone(const std::shared_ptr<const Scene>& scene) {
  Settings settings = with_passes({"Combined"});
  settings.film_transparent = true;
  settings.light_samples = 1;
  const auto picture = render(scene, settings);
  std::vector<bool> whole;
  for (std::size_t i = 3; i < picture.size(); i += 4) whole.push_back(picture[i] == 1.0f);
  return whole;
}

TEST(Passes, AmbientOcclusionUnderTheWorldsLightIsThatOfTheMethod) {
  const CameraDesc camera = camera_at({6, -5, 4}, {0, 0, 0.6}, 64, 48);
  const auto scene = ball_on_ground(camera, 0, 0);
  for (const float distance : {0.0f, 1.2f}) {
    Settings settings = with_passes({"Combined", "Ambient Occlusion", "Sky Visibility"});
    settings.ao_distance = distance;
    const auto picture = render(scene, settings);
    const auto of_method = render(scene, settings, "Ambient Occlusion");
    const auto whole = surfaces_alone(scene);
    settings.method = Method::kWorldLight;
    const auto of_world = render(scene, settings, "Ambient Occlusion");
    const auto visible = render(scene, settings, "Sky Visibility");
    for (std::size_t i = 0; i < of_method.size(); ++i) {
      if (whole[i]) {
        ASSERT_NEAR(picture[4 * i], of_method[i], 1e-6f);
      }
    }
    EXPECT_NEAR(mean_of(of_world, 1, 0), mean_of(of_method, 1, 0), 2e-3);
    if (distance == 0.0f) {
      EXPECT_EQ(visible, of_world);  // the same rays
    } else {
      EXPECT_LT(mean_of(visible, 1, 0), mean_of(of_world, 1, 0) - 0.01);
    }
  }
}

TEST(Passes, BentNormalPointsAwayFromWhatHides) {
  // A ground point at the foot of an endless wall sees the quarter sphere away from it: the mean of
  // the direction, weighted by the cosine, points 45 degrees up.
  auto scene = std::make_shared<Scene>();
  const InstanceInput instances[] = {
      placed(*scene, quad({-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0}).mesh(), Vec3d(0)),
      placed(*scene, quad({0, -500, 0}, {0, 1000, 0}, {0, 0, 1000}).mesh(), Vec3d(0))};
  scene->add_instances(instances, "test");
  scene->set_camera(probe_at({0.01, 0, 0}, {0, 0, 1}, 0.001));
  committed(scene);
  const Settings settings = with_passes({"Combined", "Bent Normal"});
  const auto bent = render(scene, settings, "Bent Normal");
  // ∫ over x > 0 of (x, z) z dω: x gives 2/3, z gives π/3.
  const double x = 2.0 / 3.0, z = kPi / 3.0, length = std::hypot(x, z);
  EXPECT_NEAR(mean_of(bent, 3, 0), x / length, 5e-3);
  EXPECT_NEAR(mean_of(bent, 3, 1), 0.0, 5e-3);
  EXPECT_NEAR(mean_of(bent, 3, 2), z / length, 5e-3);
}

TEST(Passes, PlacesAreBlendersOwn) {
  const Vec3d far(3e5, -2e5, 1e4);  // the scene's own space lies elsewhere
  auto scene = std::make_shared<Scene>();
  const InstanceInput instance =
      placed(*scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}).mesh(), far);
  scene->add_instances({&instance, 1}, "test");
  scene->set_camera(camera_at(far + Vec3d(0, 0, 4), far, 32, 32));
  committed(scene);
  Settings settings = with_passes({"Combined", "Position", "Mist", "Instance Index"});
  settings.samples = 1;
  settings.mist_start = 3.0f;
  settings.mist_depth = 2.0f;
  settings.mist_falloff = MistFalloff::kLinear;
  const auto position = render(scene, settings, "Position");
  const auto mist = render(scene, settings, "Mist");
  const auto instance_index = render(scene, settings, "Instance Index");
  const std::size_t middle = 16 * 32 + 16;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(position[3 * middle + static_cast<std::size_t>(c)], far[c], c == 2 ? 1e-3 : 0.1);
  }
  EXPECT_NEAR(mist[middle], 0.5f, 1e-3f);
  EXPECT_EQ(instance_index[middle], 1.0f);
}

TEST(Passes, MaterialValuesAreMeansOverAllSamples) {
  // The left half of the picture has one material, the right half another, the top no surface.
  auto scene = std::make_shared<Scene>();
  const auto half = [&](double x, std::uint32_t slots, std::uint32_t flags) {
    const auto mesh = scene->add_mesh(quad({x, -1, 0}, {1, 0, 0}, {0, 1.5, 0}).mesh());
    const InstanceInput instance{mesh, Mat4d(1.0), 0, kMaskAll, flags, slots};
    scene->add_instances({&instance, 1}, "half");
  };
  half(-1, 0, 0);
  half(0, 1, kInstanceHoldout);  // which leaves this and nothing else
  SceneTables tables;
  tables.materials = {{0.0f, 0}, {0.0f, 0}};
  tables.slot_begin = {0, 1, 2};
  tables.slots = {1, 0};
  tables.value_count = 5;
  tables.values = {1e6f, 0.25f, -0.5f, 0.125f, 1.0f, 3.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  scene->set_tables(tables);
  CameraDesc camera = probe_at(Vec3d(0.0), Vec3d(0, 0, 1), 1.0);
  scene->set_camera(camera);
  committed(scene);
  Settings settings = with_passes({"Combined", "Material Value 0 1", "Material Value 1 4"});
  settings.pixel_filter = PixelFilter::kBox;
  settings.samples = 16;
  const auto number = render(scene, settings, "Material Value 0 1");
  const auto color = render(scene, settings, "Material Value 1 4");
  for (std::size_t y = 0; y < 16; ++y) {
    for (std::size_t x = 0; x < 16; ++x) {
      const std::size_t i = 16 * y + x;
      const bool seen = y < 12, right = x >= 8;
      EXPECT_FLOAT_EQ(number[i], !seen ? 0.0f : right ? 1e6f : 3.0f);
      const float expected[] = {0.25f, -0.5f, 0.125f, 1.0f};
      for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_FLOAT_EQ(color[4 * i + c], seen && right ? expected[c] : 0.0f);
      }
    }
  }
  settings.passes = {"Material Value 2 4"};
  EXPECT_THROW(Session(scene, settings), std::invalid_argument);
  for (const char* bad : {"Material Value", "Material Value 0", "Material Value 0 5",
                          "Material Value 0 0", "Material Value -1 1", "Material Value 0 1 "}) {
    EXPECT_THROW(find_pass(bad), std::invalid_argument) << bad;
  }
}

TEST(Passes, EachCurveHasAMaterialAndAPlaceWhereItGrows) {
  // Bars side by side, the second one of two segments, between curves that are not drawn.
  Curves bars;
  bars.shape = CurveShape::kThick;
  const auto bar = [&](double x, int keys) {
    for (int k = 0; k < keys; ++k) bars.key({x, 2.0 * k - 2.0, 0}, 0.45);
    bars.end_curve();
  };
  bar(-0.5, 3);
  bar(0.0, 1);
  bar(0.5, 3);
  const std::vector<std::int32_t> slots = {0, 5, 1};
  const std::vector<float> uvs = {0.25f, 0.5f, 9.0f, 9.0f, NAN, 0.75f};
  CurvesInput input = bars.input("bars");
  input.curve2material = slots;
  input.curve2uv = uvs;
  const auto mesh = Mesh::build(input, Builder::kLinear, shared_pool(), Cancel());
  const std::shared_ptr<const Mesh> meshes[] = {
      mesh, mesh->rebuilt(Builder::kSah, shared_pool(), Cancel()),
      mesh->flattened(glm::scale(Mat4d(1.0), Vec3d(1, 1, 0.5)), shared_pool(), Cancel())};
  for (const auto& built : meshes) {
    auto scene = std::make_shared<Scene>();
    const InstanceInput instance{scene->add_mesh(built)};
    scene->add_instances({&instance, 1}, "bars");
    SceneTables tables;
    tables.materials = {{7.0f, 0}, {8.0f, 0}};
    tables.slot_begin = {0, 2};
    tables.slots = {0, 1};
    scene->set_tables(tables);
    scene->set_camera(probe_at(Vec3d(0.0), Vec3d(0, 0, 1), 0.9));
    committed(scene);
    Settings settings = with_passes({"Combined", "UV", "Material Index"});
    settings.samples = 1;
    settings.pixel_filter = PixelFilter::kBox;
    const auto index = render(scene, settings, "Material Index");
    const auto uv = render(scene, settings, "UV");
    for (const std::size_t y : {2u, 13u}) {
      for (const std::size_t x : {4u, 12u}) {
        const std::size_t i = 16 * y + x;
        EXPECT_EQ(index[i], x == 4 ? 7.0f : 8.0f);
        EXPECT_EQ(uv[3 * i], x == 4 ? 0.25f : 0.0f);
        EXPECT_EQ(uv[3 * i + 1], x == 4 ? 0.5f : 0.75f);
        EXPECT_EQ(uv[3 * i + 2], 1.0f);
      }
    }
  }
  const std::vector<std::int32_t> negative = {0, -1, 0};
  input.curve2material = negative;
  EXPECT_THROW(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel()),
               std::invalid_argument);
  input.curve2material = {};
  input.curve2uv = std::span(uvs).first(4);
  EXPECT_THROW(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel()),
               std::invalid_argument);
}

TEST(Passes, TablesAreChecked) {
  Scene scene;
  SceneTables bad;
  bad.materials = {{1.0f, 2}};
  bad.slot_begin = {0, 2};
  bad.slots = {0, 1};  // there is one material
  EXPECT_THROW(scene.set_tables(bad), std::invalid_argument);
  bad.slots = {0};  // shorter than the lists
  EXPECT_THROW(scene.set_tables(bad), std::invalid_argument);
  bad.slots = {0, 0};
  EXPECT_NO_THROW(scene.set_tables(bad));
  bad.value_count = 2;
  bad.values = {1.0f};
  EXPECT_THROW(scene.set_tables(bad), std::invalid_argument);
  bad.values = {1.0f, NAN};
  EXPECT_THROW(scene.set_tables(bad), std::invalid_argument);
}

}  // namespace
}  // namespace komorebi::testing
