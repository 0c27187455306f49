// The same picture to the bit, however the work is cut, ordered, interrupted or vectorised.

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "bvh/traverse.h"
#include "render/one_ray.h"
#include "render/sky_guide.h"
#include "support/lottery.h"
#include "support/made_curves.h"
#include "support/materials.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

std::shared_ptr<const Environment> gradient_map() {
  std::vector<float> texels;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const float sun = x == 9 && y == 12 ? 900.0f : 0.0f;
      texels.insert(texels.end(), {0.1f + 0.02f * static_cast<float>(x) + sun, 0.5f + sun,
                                   0.03f * static_cast<float>(y) + sun});
    }
  }
  return std::make_shared<Environment>("gradient", 32, 16, std::move(texels));
}

/// Ground, a smooth ball, a mirrored and sheared flat one, and a box scaled to a plate.
std::shared_ptr<Scene> busy_scene(Builder builder = Builder::kLinear) {
  const auto ball = sphere(24, {0, 0, 1}, 1.0, true).mesh(builder);
  const auto facets = sphere(9, Vec3d(0), 0.7, false).mesh(builder);
  const auto plate = box(Vec3d(-1), Vec3d(1)).mesh(builder);
  Mat4d sheared = glm::translate(Mat4d(1.0), Vec3d(-1.8, 0.4, 0.8));
  sheared[2][0] = 0.6;
  sheared[0][0] = -1.0;
  const Mat4d flat = glm::scale(glm::translate(Mat4d(1.0), Vec3d(1.5, -1, 2)), Vec3d(1, 0.5, 0));
  auto scene = make_scene({{quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh(builder)},
                           {ball},
                           {facets, sheared},
                           {plate, flat}},
                          camera_at({5, -4, 3}, {0, 0, 0.8}, 150, 90));
  scene->set_world_environment(gradient_map(), 0.7, Mat3d(1.0));
  return committed(scene);
}

Settings small_settings(Method method) {
  Settings s;
  s.method = method;
  s.samples = 7;
  s.light_samples = 3;
  s.seed = 5;
  s.tile_size = 32;
  s.threads = 2;
  return s;
}

/// A lamp of every kind, and enough of them for a tree.
void add_lamps(Scene& scene) {
  LampInput lamp;
  lamp.radiance = Vec3d(2.0, 3.0, 4.0);
  lamp.angle = 0.1;
  lamp.radius = 0.3;
  lamp.size_u = 1.0;
  lamp.size_v = 0.5;
  for (std::uint32_t i = 0; i < 24; ++i) {
    lamp.kind = static_cast<LampKind>(i % 8);
    lamp.world_from_lamp = glm::rotate(
        glm::translate(Mat4d(1.0), Vec3d(0.6 * i - 6.0, 1.7 * (i % 5) - 3.0, 2.0 + 0.3 * (i % 3))),
        0.1 * i, Vec3d(0.3, 1.0, 0.0));
    lamp.spread = i % 2 ? kPi : 2.0;
    lamp.spot_angle = i % 3 ? 0.0 : 1.5;
    lamp.spot_blend = 0.3;
    lamp.flags = i % 7 == 3 ? 1 : i % 7 == 4 ? 2 : 0;  // LampFlag
    scene.add_lamp(lamp);
  }
}

/// Things that every pass has something to tell of: a shadow catcher, a hole, objects without
/// shadow or not to be seen, materials and UVs, and a camera that will be elsewhere.
/// @param lottery  of what has the first material, all of it
/// @param surfaces of the two materials
std::shared_ptr<Scene> telling_scene(const Lottery* lottery = nullptr,
                                     std::vector<Material> surfaces = {}, bool dark = false) {
  Polygons ground = quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0});
  const Polygons ball = sphere(7, Vec3d(0), 1.0, true), cube = box(Vec3d(-0.5), Vec3d(0.5));
  auto scene = std::make_shared<Scene>();
  MeshInput input = ground.input();
  const std::vector<float> uvs = {0, 0, 8, 0, 8, 8, 0, 8};
  input.corner2uv = uvs;
  const auto ground_mesh =
      scene->add_mesh(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel()));
  input = cube.input();
  const std::vector<std::int32_t> slots = {0, 1, 2, 0, 1, 2};
  const std::vector<float> cube_uvs(2 * cube.corner2vtx.size(), 0.25f);
  input.face2material = slots;
  input.corner2uv = cube_uvs;
  const auto cube_mesh =
      scene->add_mesh(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel()));
  const auto ball_mesh = scene->add_mesh(ball.mesh());
  const auto at = [](double x, double y, double z) {
    return glm::translate(Mat4d(1.0), Vec3d(x, y, z));
  };
  const InstanceInput instances[] = {
      {ground_mesh, at(0, 0, 0), 0, kMaskAll, kInstanceShadowCatcher, 0},
      {ball_mesh, at(0, 0, 1), 1, kMaskAll, 0, 0},
      {cube_mesh, at(1.5, -0.5, 0.5), 2, kMaskAll, 0, 1},
      {cube_mesh, at(-1.2, -0.6, 0.5), 3, kMaskAll, kInstanceHoldout, 1},
      {ball_mesh, at(-0.5, 1.6, 1.2), 1, kMaskCamera | kMaskDiffuse, 0, 0},
      {ball_mesh, at(1.5, 1.5, 2.5), 1, kMaskShadow, 0, 0},
      {cube_mesh, at(0, -2, 0.5), 2, kMaskAll, kInstanceShadowCatcher, 1}};
  scene->add_instances(instances, "test");
  SceneTables tables;
  tables.objects = {{1.0f, 101, 201},
                    {2.0f, 102, 201, 0.1f, 1.0f},
                    {3.0f, 103, 202, 0.1f, 1.4f},
                    {4.0f, 104, 202}};
  tables.materials = {{5.0f, 301}, {6.0f, 302}};
  tables.slot_begin = {0, 1, 3};
  tables.slots = {0, 1, 0};
  tables.value_count = 4;
  tables.values = {0.0f, 0.25f, 2.0f, 1.0f, 9.0f, -300.0f, 0.1f, 1.0f};
  scene->set_tables(std::move(tables));
  if (!surfaces.empty()) scene->set_surfaces(std::move(surfaces), {});
  add_lamps(*scene);
  if (!dark) scene->set_world_environment(gradient_map(), 0.7, Mat3d(1.0));
  CameraDesc camera = camera_at({5, -4, 3}, {0, 0, 0.8}, 150, 90);
  const Mat4d rest = glm::inverse(glm::lookAt(Vec3d(5, -4, 3), Vec3d(0, 0, 0.8), Vec3d(0, 0, 1)));
  camera.motion.poses = {at(0.1, 0, 0) * rest, rest, at(0, 0.3, 0.1) * rest};
  camera.shutter.still = true;
  scene->set_camera(camera);
  if (lottery) scene->set_hit_filter(lottery->filter(), {1, 0});
  return committed(scene);
}

/// Camera, objects and shutter in motion: a fast turn, a mirrored and sheared pass through the
/// picture, a ball that grows out of nothing, and what changes its shape.
std::shared_ptr<Scene> moving_scene(Builder builder = Builder::kLinear,
                                    const Lottery* lottery = nullptr) {
  const auto ball = sphere(16, Vec3d(0), 0.8, true).mesh(builder);
  const auto cube = box(Vec3d(-0.5), Vec3d(0.5)).mesh(builder);
  CameraDesc camera = camera_at({5, -4, 3}, {0, 0, 0.8}, 150, 90);
  const Mat4d rest = glm::inverse(glm::lookAt(Vec3d(5, -4, 3), Vec3d(0, 0, 0.8), Vec3d(0, 0, 1)));
  for (const double t : {-0.5, 0.0, 0.5}) {
    const Mat4d moved = glm::translate(Mat4d(1.0), Vec3d(t, 0, 0.2 * t));
    camera.motion.poses.push_back(glm::rotate(moved, 0.1 * t, Vec3d(0, 0, 1)) * rest);
  }
  camera.motion.zoom_close = 1.1;
  camera.shutter.curve = {0.2f, 1.0f, 0.4f};
  auto scene = make_scene({{quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh(builder)}}, camera);
  const auto move = [&](const std::shared_ptr<const Mesh>& mesh, const auto& pose_at_time) {
    std::vector<Mat4d> poses;
    for (int i = 0; i < 5; ++i) poses.push_back(pose_at_time(0.25 * i));
    const InstanceInput instance{scene->add_mesh(mesh), poses[2]};
    scene->add_moving_instances({&instance, 1}, poses, "moving");
  };
  move(cube, [](double t) {
    const Mat4d turn = glm::rotate(glm::translate(Mat4d(1.0), Vec3d(1.5, -1, 1)), 5.0 * t,
                                   glm::normalize(Vec3d(1, 1, 3)));
    return glm::scale(turn, Vec3d(2, 0.3, 0.2));
  });
  move(ball, [](double t) {
    Mat4d pose = glm::translate(Mat4d(1.0), Vec3d(-4.0 + 7.0 * t, 1.0 + t * t, 1.0));
    pose[0][0] = -1.0;
    pose[2][0] = 0.5 * t;
    return pose;
  });
  move(ball, [](double t) {
    return glm::scale(glm::translate(Mat4d(1.0), Vec3d(-0.5, -1.5, 0.5)), Vec3d(t));
  });
  const auto wave = deforming(
      sphere(16, {0, 0, 0}, 0.7, true), 4,
      [](const Vec3d& p, double t) {
        return p + Vec3d(1.5 * t * t, 0.0, 0.3 * std::sin(9.0 * p.x + 4.0 * t));
      },
      builder);
  const InstanceInput waving{scene->add_mesh(wave), glm::translate(Mat4d(1.0), Vec3d(1, 1.5, 1))};
  scene->add_instances({&waving, 1}, "waving");
  move(wave, [](double t) { return glm::translate(Mat4d(1.0), Vec3d(-2.5, -1.0 + t, 1.0)); });
  for (const CurveShape shape : {CurveShape::kRibbon, CurveShape::kThick}) {
    const Curves fur = made_fur(60, 3, 0.4, 0.03, 2.0, shape);
    const MovedKeys blown(
        fur.xyz, fur.radius, 4,
        [](const Vec3d& p, double t) {
          return p + Vec3d(0.8 * t * t, 0.0, 0.2 * std::sin(9.0 * t));
        },
        [](double r, double t) { return r * (1.0 + t); });
    CurvesInput curves = fur.input("fur");
    PointsInput cloud{"cloud", fur.xyz, fur.radius};
    curves.motion = cloud.motion = blown.motion();
    const InstanceInput there{
        scene->add_mesh(Mesh::build(curves, builder, shared_pool(), Cancel())),
        glm::translate(Mat4d(1.0), Vec3d(1.0, shape == CurveShape::kThick ? -2.0 : 0.0, 1.2))};
    scene->add_instances({&there, 1}, "fur");
    move(Mesh::build(cloud, builder, shared_pool(), Cancel()),
         [](double t) { return glm::translate(Mat4d(1.0), Vec3d(2.5 - t, 0.5, 0.8)); });
  }
  SceneTables tables;
  tables.objects = {{1.0f, 101, 201, 0.3f, 1.2f}};
  if (lottery) {
    tables.materials = {{1.0f, 301}};
    tables.value_count = 4;
    tables.values = {0.5f, 0.25f, 2.0f, 1.0f};
    tables.slot_begin = {0, 1};
    tables.slots = {0};
    scene->set_hit_filter(lottery->filter(), {1});
  }
  scene->set_tables(std::move(tables));
  add_lamps(*scene);
  scene->set_world_environment(gradient_map(), 0.7, Mat3d(1.0));
  return committed(scene);
}

std::vector<std::string> every_pass() {
  std::vector<std::string> names = {"CryptoObject00", "CryptoMaterial00", "CryptoAsset00",
                                    "CryptoObject01", "Material Value 1 3"};
  for (const PassDesc& pass : known_passes()) names.emplace_back(pass.name);
  return names;
}

class Equality : public ::testing::TestWithParam<Method> {
 protected:
  Settings settings_ = small_settings(GetParam());
};

void expect_batches_as_one_ray(const std::shared_ptr<Scene>& scene, Settings settings_) {
  settings_.has_region = true;
  settings_.region = {30, 20, 110, 70};
  settings_.ao_distance = 1.5f;
  settings_.passes = every_pass();
  const FilterTable filter(settings_.pixel_filter, settings_.filter_width);
  RenderContext context = make_context(*scene, settings_, filter.view());
  SkyGuide guide;
  guide.prepare(*scene, shared_pool(), Cancel(), context);
  Film film(settings_.region, settings_, max_radiance(*scene, settings_), scene->has_catchers(),
            scene->tables().max_value());
  for (const Rect& cell : cells_of(settings_.region)) {
    TileSums sums;
    film.reset(sums, cell.area());
    std::vector<float> row(film.layout().size());
    std::size_t pixel = 0;
    for (std::uint32_t y = cell.y_min; y < cell.y_max; ++y) {
      for (std::uint32_t x = cell.x_min; x < cell.x_max; ++x, ++pixel) {
        for (std::uint32_t i = 0; i < settings_.samples; ++i) {
          const PixelSample sample = render_sample(context, x, y, i, row.data());
          film.add(sums, pixel, i, sample, row.data());
        }
      }
    }
    sums.samples = settings_.samples;
    film.merge({&cell, 1}, sums);
  }
  for (const std::string& pass : settings_.passes) {
    std::vector<float> expected(find_pass(pass).channels * settings_.region.area());
    film.read(pass, settings_.region, expected.data());
    EXPECT_EQ(render(scene, settings_, pass), expected) << pass;
    const auto differs = [&](float value) { return value != expected.front(); };
    if (pass == "Debug Sample Count" || pass == "CryptoObject01") continue;  // the same everywhere
    if (pass == "Environment" && scene->world_is_uniform()) continue;
    if (pass == "Emission" && scene->tables().surfaces.empty()) continue;  // nothing shines
    if (!scene->has_catchers()) continue;
    EXPECT_TRUE(std::any_of(expected.begin(), expected.end(), differs)) << pass << " is empty";
  }
}

TEST_P(Equality, BatchesAgreeWithOneRayAfterAnother) {
  expect_batches_as_one_ray(telling_scene(), settings_);
}

TEST_P(Equality, BatchesAgreeWithOneRayWhereLampsAreAllTheLight) {
  expect_batches_as_one_ray(telling_scene(nullptr, {}, true), settings_);
}

TEST_P(Equality, BatchesAgreeWithOneRayInMotion) {
  expect_batches_as_one_ray(moving_scene(), settings_);
}

TEST_P(Equality, BatchesAgreeWithOneRayAfterAnotherThroughBounces) {
  settings_.samples = 3;
  for (const std::uint32_t bounces : {1u, 2u, 5u}) {  // of the last, paths end by roulette
    settings_.bounces = bounces;
    expect_batches_as_one_ray(telling_scene(), settings_);
    settings_.sample_clamp_direct = 0.5f;
    settings_.sample_clamp_indirect = 0.2f;
  }
  expect_batches_as_one_ray(moving_scene(), settings_);
}

TEST_P(Equality, ThroughBouncesThreadsTilesBuildersAndInstructionSetsDoNotShow) {
  settings_.bounces = 4;
  const auto scene = busy_scene();
  const auto expected = render(scene, settings_);
  settings_.threads = 1;
  settings_.tile_size = 24;
  EXPECT_EQ(render(scene, settings_), expected);
  EXPECT_EQ(render(busy_scene(Builder::kList), settings_), expected);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
  settings_.bounces = 3;
  EXPECT_NE(render(scene, settings_), expected);
}

/// Two materials of many lobes that ask much of their points: one with holes by lot, relief and
/// light of its own, one that lets light through.
std::vector<Material> many_lobes() {
  MadeProgram made;
  const auto third = MadeProgram::number(0.3);
  const auto place = made.each("multiply", made.input("position"), third);
  const auto share = made.each("multiply", place, place);
  const auto tilted = made.each("add", made.input("normal"), MadeProgram::color(0.2, 0.1, 0.0));
  const auto clear = made.each("multiply", made.input("object_normal"), third);
  const auto of = [&](const MadeProgram::Vec& emission, bool transmits) {
    Material material;
    material.camera = SurfaceProgram(made.program({emission, clear, MadeProgram::number(0.1), share,
                                                   tilted, MadeProgram::color(0.2, 0.3, 0.1)}),
                                     {{false, true}, {transmits, false}});
    material.clear = made.program({clear});
    return material;
  };
  return {of(place, false), of(MadeProgram::color(0, 0, 0), true)};
}

TEST_P(Equality, BatchesAgreeWithOneRayOnMaterials) {
  settings_.samples = 3;
  settings_.bounces = 3;
  expect_batches_as_one_ray(telling_scene(nullptr, many_lobes()), settings_);
}

TEST_P(Equality, OfMaterialsThreadsTilesAndInstructionSetsDoNotShow) {
  settings_.bounces = 2;
  const auto scene = telling_scene(nullptr, many_lobes());
  const auto expected = render(scene, settings_);
  EXPECT_NE(render(telling_scene(), settings_), expected);
  settings_.threads = 1;
  settings_.tile_size = 24;
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
}

TEST_P(Equality, BatchesAgreeWithOneRayThroughCutOuts) {
  const Lottery lottery(0.6);
  expect_batches_as_one_ray(telling_scene(&lottery), settings_);
  expect_batches_as_one_ray(moving_scene(Builder::kLinear, &lottery), settings_);
  EXPECT_GT(lottery.asked(), 10000u);
}

TEST_P(Equality, OfCutOutsThreadsTilesBuildersAndInstructionSetsDoNotShow) {
  const Lottery lottery(0.6);
  const auto scene = moving_scene(Builder::kLinear, &lottery);
  const auto expected = render(scene, settings_);
  EXPECT_NE(render(moving_scene(), settings_), expected);
  settings_.threads = 1;
  settings_.tile_size = 24;
  EXPECT_EQ(render(moving_scene(Builder::kSah, &lottery), settings_), expected);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
}

TEST_P(Equality, OfMotionThreadsTilesBuildersAndInstructionSetsDoNotShow) {
  const auto scene = moving_scene();
  const auto expected = render(scene, settings_);
  settings_.threads = 1;
  settings_.tile_size = 24;
  EXPECT_EQ(render(scene, settings_), expected);
  EXPECT_EQ(render(moving_scene(Builder::kList), settings_), expected);
  EXPECT_EQ(render(moving_scene(Builder::kSah), settings_), expected);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
}

TEST_P(Equality, ThreadsTilesOrderAndRepetitionDoNotShow) {
  const auto scene = busy_scene();
  const auto expected = render(scene, settings_);
  EXPECT_EQ(render(scene, settings_), expected);
  for (const std::uint32_t threads : {1u, 3u, 7u}) {
    settings_.threads = threads;
    EXPECT_EQ(render(scene, settings_), expected) << threads << " threads";
  }
  for (const std::uint32_t tile : {8u, 13u, 256u}) {
    settings_.tile_size = tile;
    EXPECT_EQ(render(scene, settings_), expected) << "tiles of " << tile;
  }
  settings_.use_progressive = false;
  EXPECT_EQ(render(scene, settings_), expected) << "tile by tile";
}

TEST_P(Equality, BuildersDoNotShow) {
  const auto expected = render(busy_scene(), settings_);
  EXPECT_EQ(render(busy_scene(Builder::kPrincipalAxis), settings_), expected);
  EXPECT_EQ(render(busy_scene(Builder::kList), settings_), expected);
}

TEST_P(Equality, InstructionSetsDoNotShow) {
  const auto scene = busy_scene();
  const auto expected = render(scene, settings_);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_EQ(render(scene, settings_), expected) << name;
  }
  force_instruction_set("");
}

TEST_P(Equality, ABorderIsTheCropOfTheWhole) {
  const auto scene = busy_scene();
  const auto whole = render(scene, settings_);
  settings_.has_region = true;
  settings_.region = {37, 11, 101, 64};
  const auto part = render(scene, settings_);
  std::size_t i = 0;
  for (std::uint32_t y = 11; y < 64; ++y) {
    for (std::uint32_t k = 4 * 37; k < 4 * 101; ++k, ++i) {
      ASSERT_EQ(part[i], whole[4 * 150 * y + k]) << "row " << y;
    }
  }
  EXPECT_EQ(i, part.size());
}

TEST_P(Equality, SampleRangesAddUp) {
  const auto scene = busy_scene();
  settings_.samples = 8;
  const auto whole = render(scene, settings_);
  settings_.samples = 4;
  const auto first = render(scene, settings_);
  settings_.sample_offset = 4;
  const auto second = render(scene, settings_);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    ASSERT_NEAR(whole[i], 0.5 * (double{first[i]} + second[i]), 1e-6 * (1.0 + whole[i]));
  }
  EXPECT_NE(first, second);
}

TEST_P(Equality, CancelAndResumeDoNotShow) {
  const auto scene = busy_scene();
  settings_.samples = 48;
  const auto expected = render(scene, settings_);
  EXPECT_EQ(testing::render_with_breaks(scene, settings_), expected);
}

INSTANTIATE_TEST_SUITE_P(Methods, Equality,
                         ::testing::Values(Method::kAmbientOcclusion, Method::kWorldLight),
                         [](const auto& p) {
                           return p.param == Method::kWorldLight ? "WorldLight"
                                                                 : "AmbientOcclusion";
                         });

TEST(Seed, ChangesTheNoiseAndNothingElse) {
  const auto scene = busy_scene();
  Settings settings = small_settings(Method::kAmbientOcclusion);
  const auto one = render(scene, settings);
  settings.seed = 6;
  const auto other = render(scene, settings);
  EXPECT_NE(one, other);
  const Estimate a = estimate(one), b = estimate(other);
  EXPECT_NEAR(a.mean, b.mean, 0.005);
}

}  // namespace
}  // namespace komorebi::testing
