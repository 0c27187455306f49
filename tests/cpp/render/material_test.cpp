// What materials do with light, in closed form: flat things under an even sky.

#include <gtest/gtest.h>

#include "support/materials.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

/// A large plane with one material under a sky of 1, seen from above; the middle pixels' mean.
glm::dvec4 seen(const Material& material, std::uint32_t bounces = 0,
                const std::string& pass = "Combined") {
  const Polygons plane = quad({-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0});
  auto scene = std::make_shared<Scene>();
  const InstanceInput instance{scene->add_mesh(plane.mesh()), Mat4d(1.0)};
  scene->add_instances({&instance, 1}, "plane");
  SceneTables tables;
  tables.materials = {{1.0f, 1}};
  tables.slot_begin = {0, 1};
  tables.slots = {0};
  scene->set_tables(std::move(tables));
  scene->set_surfaces({material}, {});
  scene->set_world_color(Vec3(1.0f));
  scene->set_camera(camera_at({0, -1, 4}, {0, 0, 0}, 32, 32));
  Settings settings;
  settings.method = Method::kWorldLight;
  settings.samples = 64;
  settings.bounces = bounces;
  settings.sample_clamp_indirect = 0.0f;
  settings.passes = {"Combined", pass};
  const std::vector<float> pixels = render(committed(scene), settings, pass);
  const std::size_t channels = pass == "Combined" ? 4 : 3;
  glm::dvec4 sum(0.0);
  for (std::size_t i = 0; i < 32 * 32; ++i) {
    for (std::size_t c = 0; c < channels; ++c) {
      sum[static_cast<int>(c)] += double{pixels[channels * i + c]} / (32 * 32);
    }
  }
  return sum;
}

void expect_near(const glm::dvec4& value, const Vec3d& expected, double within) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], within) << c;
}

TEST(Materials, OfOneColourReflectThatShareOfAnEvenSky) {
  expect_near(seen(even_material({0.2, 0.5, 0.8})), {0.2, 0.5, 0.8}, 1e-5);
}

TEST(Materials, LetLightThroughFromTheOtherSide) {
  // Both sides see the same sky, so that what reflects and what passes adds up.
  expect_near(seen(even_material({0.3, 0.1, 0.2}, {0.4, 0.4, 0.1})), {0.7, 0.5, 0.3}, 0.02);
  expect_near(seen(even_material({0, 0, 0}, {0.4, 0.4, 0.1})), {0.4, 0.4, 0.1}, 1e-5);
}

TEST(Materials, ThatAreClearShowWhatIsBehind) {
  expect_near(seen(even_material(Vec3d(0.7 * 0.5), Vec3d(0), 0.3)), Vec3d(0.35 + 0.3), 0.01);
}

TEST(Materials, ThatShineAddTheirLight) {
  expect_near(seen(even_material(Vec3d(0.25), Vec3d(0), 0, 0, {2, 1, 0.5})), {2.25, 1.25, 0.75},
              1e-5);
  expect_near(seen(even_material(Vec3d(0.25), Vec3d(0), 0, 0, {2, 1, 0.5}), 0, "Emission"),
              {2, 1, 0.5}, 1e-5);
}

TEST(Materials, WithAHoleLeaveAlpha) {
  const glm::dvec4 value = seen(even_material(Vec3d(0.6), Vec3d(0), 0, 0.25));
  EXPECT_NEAR(value.a, 0.75, 1e-5);
  expect_near(value, Vec3d(0.6), 1e-5);
}

TEST(Materials, ShowTheirColourInThePass) {
  expect_near(seen(even_material({0.3, 0.1, 0.2}, {0.4, 0.4, 0.1}), 0, "Diffuse Color"),
              {0.3, 0.1, 0.2}, 1e-5);
}

TEST(Materials, OfAPlaneAreLitByNoBounce) {
  expect_near(seen(even_material({0.2, 0.5, 0.8}), 4), {0.2, 0.5, 0.8}, 1e-5);
}

TEST(Materials, RunOverWhatIsAskedOfPoints) {
  // The normal of a floor is up, whatever the side.
  MadeProgram made;
  const auto black = MadeProgram::color(0, 0, 0);
  const auto program = made.program({made.input("normal"), black, MadeProgram::number(0), black});
  Material material;
  material.camera = SurfaceProgram(program, {{false, false}});
  expect_near(seen(material), {0, 0, 1}, 1e-5);
}

TEST(Materials, OfTooFewOutputsAreRefused) {
  const auto program = MadeProgram().program({MadeProgram::color(0, 0, 0)});
  EXPECT_THROW(SurfaceProgram(program, {{false, false}}), std::invalid_argument);
}

}  // namespace
}  // namespace komorebi::testing
