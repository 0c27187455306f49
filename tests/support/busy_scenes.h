#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "support/lottery.h"
#include "support/made_curves.h"
#include "support/materials.h"
#include "support/scenes.h"

/// Scenes in which all that a renderer knows is met.
namespace komorebi::testing {

inline std::shared_ptr<const Environment> gradient_map() {
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
inline std::shared_ptr<Scene> busy_scene(Builder builder = Builder::kLinear) {
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

inline Settings small_settings(Method method) {
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
inline void add_lamps(Scene& scene) {
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
inline std::shared_ptr<Scene> telling_scene(const Lottery* lottery = nullptr,
                                            std::vector<Material> surfaces = {},
                                            bool dark = false) {
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
  MadeProgram varying;
  tables.value_programs = {
      varying.program({varying.input("normal"), varying.input("backfacing", 1)}), nullptr};
  tables.world_values = varying.program({varying.input("incoming"), MadeProgram::number(0.5)});
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
inline std::shared_ptr<Scene> moving_scene(Builder builder = Builder::kLinear,
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

/// Two materials of many lobes that ask much of their points: one with holes by lot, relief and
/// light of its own, one that lets light through. To bounces both reflect by their cones' width.
inline std::vector<Material> many_lobes() {
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
    const auto width = made.footprint(made.input("position"));
    const auto wide =
        made.each("add", share, made.each("multiply", MadeProgram::color(1, 2, 3), width));
    material.bounce = SurfaceProgram(made.program({emission, clear, MadeProgram::number(0.1), wide,
                                                   tilted, MadeProgram::color(0.2, 0.3, 0.1)}),
                                     {{false, true}, {transmits, false}});
    material.clear = made.program({clear});
    return material;
  };
  return {of(place, false), of(MadeProgram::color(0, 0, 0), true)};
}

}  // namespace komorebi::testing
