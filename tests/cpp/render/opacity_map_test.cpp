// The filter of leaves says the same with its map and without, hit by hit and ray by ray.
#include "render/opacity_map.h"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "bvh/traverse.h"
#include "core/path_key.h"
#include "render/material_filter.h"
#include "support/leaf_picture.h"
#include "support/materials.h"
#include "support/moving.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

/// Cut out by a picture's alpha times a number, at an attribute moved a little.
Material leaf(double solid, double turned, const TextureSampling& how = {}) {
  const auto picture = leaf_picture(97, 64, TexelType::kByte, 4, {}, shared_pool());
  const auto built = [&](bool whole, bool asks_for_ray) {
    MadeProgram made;
    const auto uv = made.attribute("uv:");
    const auto place =
        made.op({"transform",
                 {},
                 {float(1 - turned), float(turned), 0, 0, float(-turned), 1, 0, 0.125f, 0, 0, 1, 0},
                 {},
                 "",
                 nullptr},
                3, {{uv[0], uv[1], uv[2]}});
    const std::vector<float> numbers = {float(how.interpolation), float(how.extension), 1};
    const auto texel =
        made.op({"image", {}, numbers, {}, "", picture}, 4, {{place[0], place[1]}, made.number(0)});
    auto alpha = made.each("multiply", {texel[3]}, made.number(solid));
    if (asks_for_ray) {
      const auto near = made.each("less_than", made.input("ray_length", 1), made.number(2));
      alpha = made.each("multiply", alpha, near);
    }
    const auto clear = made.each("subtract", made.number(1), alpha);
    const MadeProgram::Vec through = {clear[0], clear[0], clear[0]};
    if (!whole) return made.program({through});
    const auto green = made.each("multiply", {texel[0], texel[1], texel[2]}, alpha);
    return made.program({made.color(0, 0, 0), through, made.number(0), green});
  };
  Material material;
  material.camera = SurfaceProgram(built(true, turned > 0.5), {{false, false}});
  material.clear = built(false, false);
  return material;
}

/// Cards of two sizes of picture, a ball with faces of two materials, one of them opaque, and a
/// pane that lets a third through.
std::shared_ptr<Scene> garden(std::vector<Material> materials) {
  auto scene = std::make_shared<Scene>();
  const std::vector<float> card_uv = {0, 0, 1, 0, 1, 1, 0, 1};
  const Polygons card = quad({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0});
  MeshInput input = card.input("card");
  input.attributes = {{"uv:", AttributeDomain::kCorner, 2, card_uv}};
  const auto add = [&](const MeshInput& mesh) {
    return scene->add_mesh(Mesh::build(mesh, Builder::kLinear, shared_pool(), Cancel()));
  };
  const std::uint32_t cards = add(input);
  const Polygons ball = sphere(9, Vec3d(0), 0.7, true);
  std::vector<float> ball_uv;
  for (std::size_t v = 0; v < ball.vtx2xyz.size(); v += 3) {
    ball_uv.insert(ball_uv.end(), {3.0f * ball.vtx2xyz[v], 2.0f * ball.vtx2xyz[v + 2]});
  }
  std::vector<std::int32_t> slots(ball.face_offsets.size() - 1);
  for (std::size_t f = 0; f < slots.size(); ++f) slots[f] = static_cast<std::int32_t>(f % 3);
  input = ball.input("ball");
  input.attributes = {{"uv:", AttributeDomain::kVertex, 2, ball_uv}};
  input.face2material = slots;
  const std::uint32_t balls = add(input), bare = scene->add_mesh(card.mesh());
  std::mt19937 random(4);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<InstanceInput> instances;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Vec3d at(number(random), number(random), number(random));
    const Mat4d turn = glm::rotate(glm::translate(Mat4d(1.0), 1.5 * at), 3.0 * number(random),
                                   Vec3d(number(random), number(random), 1.0));
    const std::uint32_t mesh = i % 6 == 0 ? balls : i % 6 == 1 ? bare : cards;
    instances.push_back({mesh, turn, 0, kMaskAll, 0, i % 4});
  }
  scene->add_instances(instances, "test");
  SceneTables tables;
  tables.materials.resize(materials.size());
  tables.slot_begin = {0, 3, 4, 5, 6};
  tables.slots = {0, 3, 1, 1, 2, 0};
  scene->set_tables(std::move(tables));
  scene->set_surfaces(std::move(materials), {});
  scene->set_camera(camera_at({4, 0, 0}, {0, 0, 0}, 8, 8));
  return committed(scene);
}

std::vector<Material> materials(const TextureSampling& how = {}) {
  return {leaf(1.0, 0.0, how), leaf(0.7, 0.3, how), leaf(1.0, 0.6, how),
          even_material({0.5, 0.5, 0.5})};
}

/// How many answers the map gave.
struct Share {
  int asked = 0, known = 0;
};

Share expect_same(const Scene& scene) {
  MaterialFilter with, without;
  with.bind(scene, shared_pool(), Cancel());
  without.bind(scene, shared_pool(), Cancel(), false);
  const SceneView& view = scene.view();
  std::mt19937 random(8);
  std::uniform_real_distribution<float> number(0.0f, 1.0f);
  Share share;
  std::vector<HitQuery> queries;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    HitQuery query;
    query.hit.instance = static_cast<std::uint32_t>(random() % view.instance_count);
    const InstanceView& instance = view.instances[query.hit.instance];
    if (!instance.filtered) continue;
    query.hit.primitive =
        static_cast<std::uint32_t>(random() % view.meshes[instance.mesh].triangle_count);
    float u = number(random), v = number(random);
    if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
    if (i % 5 == 0) u = std::round(u * 16.0f) / 16.0f;
    if (i % 7 == 0) v = i % 2 ? 0.0f : 1.0f - u;
    if (i % 501 == 0) u = -1e-7f;
    query.hit.u = u;
    query.hit.v = v;
    query.hit.t = 3.0f * number(random);
    // Lots of all sizes: some of those that the map leaves alone, too.
    query.ray.path_key = path_key(i,
                                  i % 3 == 0   ? kDimensionPixel
                                  : i % 3 == 1 ? vertex_dimension(1, kVertexScatter)
                                               : vertex_dimension(0, kVertexLobe),
                                  0);
    share.known += with.opacity_map()->at(instance, query.hit) != OpacityMap::Cell::kUnknown;
    queries.push_back(query);
  }
  share.asked = static_cast<int>(queries.size());
  const auto count = static_cast<std::uint32_t>(queries.size());
  const std::unique_ptr<bool[]> a(new bool[count]), b(new bool[count]);
  with.hit_filter().accepts(&with, queries.data(), count, a.get());
  without.hit_filter().accepts(&without, queries.data(), count, b.get());
  int wrong = 0, accepted = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    wrong += a[i] != b[i];
    accepted += a[i];
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(accepted, share.asked / 5);
  EXPECT_LT(accepted, 4 * share.asked / 5);
  return share;
}

TEST(OpacityMap, AgreesWithProgramsHitByHit) {
  for (const auto interpolation :
       {Interpolation::kClosest, Interpolation::kLinear, Interpolation::kCubic}) {
    for (const auto extension :
         {Extension::kRepeat, Extension::kExtend, Extension::kClip, Extension::kMirror}) {
      const auto scene = garden(materials({interpolation, extension, true}));
      const Share share = expect_same(*scene);
      EXPECT_GT(share.known, share.asked / 4);
      EXPECT_LT(share.known, share.asked);
    }
  }
}

TEST(OpacityMap, KeepsEveryHit) {
  const auto scene = garden(materials());
  MaterialFilter without;
  without.bind(*scene, shared_pool(), Cancel(), false);
  SceneView by_programs = scene->view();
  by_programs.filter = without.hit_filter();
  RayList rays;
  const RayList made = random_rays(3000, Vec3(-scene->origin()), 1.8f);
  for (std::uint32_t i = 0; i < made.size(); ++i) {
    Ray ray = made[i];
    ray.path_key = path_key(i, i % 2 ? kDimensionPixel : vertex_dimension(0, kVertexLobe), 0);
    rays.push_back(ray);
  }
  for (const std::string& isa : built_instruction_sets()) {
    force_instruction_set(isa);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint32_t> bits((rays.size() + 31) / 32);
    intersect(scene->view(), rays.span(), hits.data());
    occluded(scene->view(), rays.span(), bits.data());
    int met = 0;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      const Hit expected = intersect_brute_force(by_programs, rays[i]);
      EXPECT_EQ(std::memcmp(&expected, &hits[i], sizeof(Hit)), 0) << isa << " " << i;
      EXPECT_EQ(bits[i / 32] >> (i % 32) & 1u, expected.valid()) << isa << " " << i;
      met += expected.valid();
    }
    EXPECT_GT(met, 800);
  }
  force_instruction_set("");
}

TEST(OpacityMap, SharesCellsOfTrianglesThatAreAlike) {
  const auto scene = garden(materials());
  MaterialFilter filter;
  filter.bind(*scene, shared_pool(), Cancel());
  // Two triangles of cards, with three materials; one of bare ones each; the rest are the ball's.
  const std::size_t ball = scene->view().meshes[1].triangle_count;
  EXPECT_LT(filter.opacity_map()->pattern_count(), 3 * (2 + 1 + ball));
  EXPECT_GT(filter.opacity_map()->pattern_count(), 3 * (2 + 1) + ball / 3);
  EXPECT_LT(filter.opacity_map()->byte_count(), 2'000'000u);
  EXPECT_GE(scene->byte_count(), filter.byte_count());
}

TEST(OpacityMap, OfClearAndOfOpaqueMaterialsNeedsNoPrograms) {
  const auto scene = garden({even_material({0, 0, 0}, Vec3d(0), 1.0), even_material({1, 1, 1}),
                             even_material({1, 1, 1}, Vec3d(0), 0.5), even_material({1, 1, 1})});
  MaterialFilter filter;
  filter.bind(*scene, shared_pool(), Cancel());
  Hit hit;
  hit.u = hit.v = 0.25f;
  for (std::uint32_t i = 0; i < scene->view().instance_count; ++i) {
    const InstanceView& instance = scene->view().instances[i];
    if (!instance.filtered || instance.mesh == 1) continue;
    hit.primitive = 0;
    const auto found = filter.opacity_map()->at(instance, hit);
    const auto expected = instance.material_slots % 3 == 0 ? OpacityMap::Cell::kClear
                          : instance.material_slots == 2   ? OpacityMap::Cell::kUnknown
                                                           : OpacityMap::Cell::kSolid;
    EXPECT_EQ(found, expected) << i;
  }
}

}  // namespace
}  // namespace komorebi::testing
