// Meshes at the limits: nothing, one, a million alike, slivers, no area, one plane.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "bvh/validate.h"
#include "support/ray_kinds.h"
#include "support/test_scene.h"

namespace komorebi {
namespace {

using testing::RayMaker;
using testing::TestScene;
using testing::TriangleMesh;

constexpr Builder kBuilders[] = {Builder::kLinear, Builder::kSah, Builder::kPrincipalAxis,
                                 Builder::kList};

TriangleMesh soup(const std::vector<Vec3>& corners) {
  TriangleMesh mesh;
  for (const Vec3& p : corners) {
    mesh.tri2vtx.push_back(static_cast<std::uint32_t>(mesh.vtx2xyz.size() / 3));
    mesh.vtx2xyz.insert(mesh.vtx2xyz.end(), {p.x, p.y, p.z});
  }
  return mesh;
}

std::unique_ptr<TestScene> scene_of(const TriangleMesh& mesh, Builder builder) {
  auto scene = std::make_unique<TestScene>(2);
  scene->add_mesh(mesh, builder);
  scene->add_instance(0);
  scene->commit(builder);
  EXPECT_EQ(validate(scene->tree(0), mesh.vtx2xyz, mesh.tri2vtx), "");
  return scene;
}

/// All kernels give brute force's hits; returns how many rays hit.
int expect_same_hits(const TestScene& scene, int ray_count) {
  RayMaker maker(scene.mesh(0), scene.tree(0).bounds, 3);
  const testing::RayList rays = maker.make_list(static_cast<std::uint32_t>(ray_count));
  std::vector<Hit> hits(rays.size());
  int found = 0;
  for (const std::string& isa : built_instruction_sets()) {
    force_instruction_set(isa);
    intersect(scene.view(), rays.span(), hits.data());
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      const Hit expected = intersect_brute_force(scene.view(), rays[i]);
      EXPECT_EQ(std::memcmp(&expected, &hits[i], sizeof(Hit)), 0) << isa << ", ray " << i;
      found += expected.valid() ? 1 : 0;
    }
  }
  force_instruction_set("");
  return found;
}

TEST(BadMesh, NothingIsNeverHit) {
  for (const Builder builder : kBuilders) {
    const auto scene = scene_of(TriangleMesh{}, builder);
    EXPECT_EQ(scene->tree(0).nodes.size(), 0u);
    EXPECT_EQ(expect_same_hits(*scene, 70), 0);
  }
  TestScene none;
  none.commit();
  EXPECT_FALSE(intersect_scalar(none.view(), Ray{}).valid());
  Hit hit;
  const testing::RayList one = RayMaker(TriangleMesh{}, Aabb{}, 1).make_list(1);
  intersect(none.view(), one.span(), &hit);
  EXPECT_FALSE(hit.valid());
}

TEST(BadMesh, OneTriangle) {
  const TriangleMesh mesh = soup({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
  for (const Builder builder : kBuilders) {
    const auto scene = scene_of(mesh, builder);
    EXPECT_EQ(scene->tree(0).depth, 1u);
    EXPECT_GT(expect_same_hits(*scene, 700), 0);
  }
}

TEST(BadMesh, AMillionAlike) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 1000000; ++i) {
    corners.insert(corners.end(), {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
  }
  const TriangleMesh mesh = soup(corners);
  for (const Builder builder : kBuilders) {
    const auto scene = scene_of(mesh, builder);
    EXPECT_LE(scene->tree(0).depth, 20u);
    Ray ray;
    ray.origin = Vec3(0.25f, 0.25f, 1.0f);
    ray.direction = Vec3(0, 0, -1);
    const Hit hit = intersect_scalar(scene->view(), ray);
    EXPECT_EQ(hit.primitive, 0u) << "equal t: the smallest index wins";
    EXPECT_EQ(hit.t, 1.0f);
    EXPECT_TRUE(occluded_scalar(scene->view(), ray));
    ray.self_instance = ray.self_primitive = 0;
    EXPECT_EQ(intersect_scalar(scene->view(), ray).primitive, 1u);
  }
}

TEST(BadMesh, TrianglesWithoutAreaKeepTheirPlaceAndAreNeverHit) {
  const Vec3 a(0, 0, 0), b(0.1f, 0.3f, 0.7f), c(2 * 0.1f, 2 * 0.3f, 2 * 0.7f);
  const TriangleMesh mesh = soup({a, a, a,                                        // a point
                                  a, b, c,                                        // a line
                                  Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),    // index 2
                                  Vec3(1, 2, 3), Vec3(5, 5, 5), Vec3(1, 2, 3)});  // folded
  for (const Builder builder : kBuilders) {
    const auto scene = scene_of(mesh, builder);
    EXPECT_EQ(scene->tree(0).degenerate_count, 3u);
    Ray ray;
    ray.origin = Vec3(0.25f, 0.25f, 1.0f);
    ray.direction = Vec3(0, 0, -1);
    EXPECT_EQ(intersect_scalar(scene->view(), ray).primitive, 2u);
    for (int i = 0; i < 100; ++i) {  // straight at the line
      Ray at_line;
      at_line.origin = Vec3(1.0f, -0.5f, 0.1f * static_cast<float>(i));
      at_line.direction = c * (0.01f * static_cast<float>(i)) - at_line.origin;
      const Hit hit = intersect_scalar(scene->view(), at_line);
      EXPECT_TRUE(!hit.valid() || hit.primitive == 2u);
    }
    expect_same_hits(*scene, 700);
  }
  const auto only_points = scene_of(soup({a, a, a, b, b, b}), Builder::kLinear);
  EXPECT_EQ(only_points->tree(0).degenerate_count, 2u);
  EXPECT_EQ(expect_same_hits(*only_points, 70), 0);
}

TEST(BadMesh, Slivers) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 3000; ++i) {
    const float x = static_cast<float>(i) * 1e-3f;
    corners.insert(corners.end(), {Vec3(x, 0, 0), Vec3(x + 1e-7f, 1000, 0), Vec3(x, 1000, 1e-6f)});
  }
  for (const Builder builder : kBuilders) expect_same_hits(*scene_of(soup(corners), builder), 700);
}

TEST(BadMesh, AFlatGridIsClosed) {
  // A plane of 100 × 100 quads: a ray down at any of its vertices, edges or diagonals hits it.
  TriangleMesh mesh;
  for (int y = 0; y <= 100; ++y) {
    for (int x = 0; x <= 100; ++x) {
      mesh.vtx2xyz.insert(mesh.vtx2xyz.end(), {0.1f * float(x), 0.1f * float(y), 0.3f});
    }
  }
  for (std::uint32_t y = 0; y < 100; ++y) {
    for (std::uint32_t x = 0; x < 100; ++x) {
      const std::uint32_t v = y * 101 + x;
      mesh.tri2vtx.insert(mesh.tri2vtx.end(), {v, v + 1, v + 102, v, v + 102, v + 101});
    }
  }
  for (const Builder builder : kBuilders) {
    const auto scene = scene_of(mesh, builder);
    int missed = 0;
    for (int i = 0; i < (builder == Builder::kList ? 300 : 20000); ++i) {
      Ray ray;
      const int a = (i * 7919) % 199 + 1, b = (i * 104729) % 199 + 1;  // half steps: all edges
      const Vec3 target(0.05f * float(a), 0.05f * float(b), 0.3f);
      ray.origin = i % 2 == 0 ? Vec3(target.x, target.y, 7.0f) : Vec3(3.3f, -4.1f, 5.9f);
      ray.direction = target - ray.origin;
      missed += intersect_scalar(scene->view(), ray).valid() ? 0 : 1;
    }
    EXPECT_EQ(missed, 0);
    expect_same_hits(*scene, 140);
  }
}

TEST(BadMesh, NumbersThatAreNoneHangNothing) {
  TriangleMesh mesh = soup(
      {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)});
  mesh.vtx2xyz[4] = std::nanf("");
  const auto scene = scene_of(mesh, Builder::kLinear);
  EXPECT_EQ(scene->tree(0).degenerate_count, 1u);
  for (int i = 0; i < 64; ++i) {  // rays that are none either
    const float bad = i % 2 == 0 ? std::nanf("") : INFINITY;
    Ray ray;
    ray.origin = Vec3(0.2f, 0.2f, 3.0f);
    ray.direction = Vec3(0, 0, -1);
    (i % 4 < 2 ? ray.origin : ray.direction)[i / 4 % 3] = bad;
    if (i >= 48) ray.direction = Vec3(0.0f);
    EXPECT_FALSE(intersect_scalar(scene->view(), ray).valid());
    EXPECT_FALSE(intersect_brute_force(scene->view(), ray).valid());
    testing::RayList rays;
    rays.push_back(ray);
    Hit hit;
    intersect(scene->view(), rays.span(), &hit);
    EXPECT_FALSE(hit.valid());
  }
}

}  // namespace
}  // namespace komorebi
