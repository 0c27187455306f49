// Two levels: instances moved, mirrored, sheared, flattened; masks; ten thousand of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "bvh/validate.h"
#include "support/ray_kinds.h"
#include "support/test_scene.h"

namespace komorebi {
namespace {

using testing::RayList;
using testing::TestScene;
using testing::TriangleMesh;

/// A closed bumpy ball of 2 · rings · 2 rings triangles.
TriangleMesh ball(std::uint32_t rings) {
  TriangleMesh mesh;
  const std::uint32_t around = 2 * rings;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const double theta = M_PI * i / rings, phi = 2 * M_PI * j / around;
      const double r = 1 + 0.1 * std::sin(5 * theta) * std::cos(3 * phi);
      mesh.vtx2xyz.push_back(float(r * std::sin(theta) * std::cos(phi)));
      mesh.vtx2xyz.push_back(float(r * std::sin(theta) * std::sin(phi)));
      mesh.vtx2xyz.push_back(float(r * std::cos(theta)));
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      const std::uint32_t a = i * around + j, b = i * around + (j + 1) % around;
      mesh.tri2vtx.insert(mesh.tri2vtx.end(), {a, b, a + around, b, b + around, a + around});
    }
  }
  return mesh;
}

RayList random_rays(std::uint32_t count, float radius) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  RayList rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    Ray ray;
    const Vec3 target = radius * Vec3(number(random), number(random), number(random));
    ray.origin = 2.0f * radius * Vec3(number(random), number(random), number(random));
    ray.direction = target - ray.origin;
    if (i % 5 == 0) ray.direction = Vec3(0, 0, i % 2 == 0 ? 1.0f : -1.0f);
    rays.push_back(ray);
  }
  return rays;
}

std::uint32_t expect_same_hits(const TestScene& scene, const RayList& rays) {
  std::vector<Hit> expected, hits(rays.size());
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    expected.push_back(intersect_brute_force(scene.view(), rays[i]));
    found += expected.back().valid() ? 1u : 0u;
  }
  for (const std::string& isa : built_instruction_sets()) {
    force_instruction_set(isa);
    intersect(scene.view(), rays.span(), hits.data());
    std::vector<std::uint32_t> bits((rays.size() + 31) / 32);
    occluded(scene.view(), rays.span(), bits.data());
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(std::memcmp(&expected[i], &hits[i], sizeof(Hit)), 0) << isa << ", ray " << i;
      EXPECT_EQ((bits[i / 32] >> (i % 32)) & 1u, expected[i].valid() ? 1u : 0u);
    }
  }
  force_instruction_set("");
  return found;
}

std::vector<Aabb> world_boxes(const TestScene& scene) {
  std::vector<Aabb> boxes;
  for (const InstanceView& instance : scene.instances()) boxes.push_back(instance.world_bounds);
  return boxes;
}

Mat3d random_matrix(std::mt19937& random, double flatten) {
  std::normal_distribution<double> number;
  Mat3d m;
  for (int i = 0; i < 9; ++i) m[i / 3][i % 3] = number(random);
  m[2] *= flatten;
  return m;
}

TEST(Instances, MirroredShearedAndFlattenedAgreeWithBruteForce) {
  for (const Builder builder :
       {Builder::kLinear, Builder::kSah, Builder::kPrincipalAxis, Builder::kList}) {
    TestScene scene(2);
    scene.add_mesh(ball(8), builder);
    scene.add_mesh(TriangleMesh{}, builder);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-10.0f, 10.0f);
    for (int i = 0; i < 60; ++i) {
      const double flatten = i % 3 == 0 ? 1e-5 : i % 3 == 1 ? 1.0 : -1.0;
      scene.add_instance(0, random_matrix(random, flatten),
                         Vec3(number(random), number(random), number(random)));
    }
    scene.add_instance(1);              // nothing in it
    scene.add_instance(0, Mat3d(0.0));  // singular
    scene.commit(builder);
    EXPECT_EQ(validate(scene.instance_tree(), world_boxes(scene)), "");
    EXPECT_TRUE(scene.instances()[60].world_bounds.is_empty());
    EXPECT_TRUE(scene.instances()[61].world_bounds.is_empty());
    EXPECT_EQ(scene.instance_tree().leaf2instance.size(), 60u);
    EXPECT_GT(expect_same_hits(scene, random_rays(500, 12.0f)), 100u);
  }
}

TEST(Instances, HitWhatTheirOwnTransformedTrianglesWould) {
  // Against a single mesh with the triangles moved in double: t agrees up to float distance.
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  for (const double flatten : {1.0, -1.0, 1e-3}) {
    const Mat3d matrix = random_matrix(random, flatten);
    const Vec3 position(4.0f, -3.0f, 2.0f);
    TestScene instanced, moved;
    TriangleMesh mesh = ball(16);
    instanced.add_mesh(mesh);
    instanced.add_instance(0, matrix, position);
    instanced.commit();
    for (std::size_t i = 0; i < mesh.vtx2xyz.size(); i += 3) {
      const Vec3d p = matrix * Vec3d(mesh.vtx2xyz[i], mesh.vtx2xyz[i + 1], mesh.vtx2xyz[i + 2]) +
                      Vec3d(position);
      for (std::size_t k = 0; k < 3; ++k) mesh.vtx2xyz[i + k] = float(p[static_cast<int>(k)]);
    }
    moved.add_mesh(mesh);
    moved.add_instance(0);
    moved.commit();
    int compared = 0, differ = 0;
    for (int i = 0; i < 3000; ++i) {
      Ray ray;
      ray.origin = 20.0f * Vec3(number(random), number(random), number(random));
      ray.direction =
          position + 2.0f * Vec3(number(random), number(random), number(random)) - ray.origin;
      const Hit a = intersect_scalar(instanced.view(), ray);
      const Hit b = intersect_scalar(moved.view(), ray);
      if (!a.valid() && !b.valid()) continue;
      ++compared;
      // Near a silhouette, or where the surface is met at a glancing angle, rounding shows.
      if (a.valid() != b.valid() || std::abs(a.t - b.t) > 1e-4f) ++differ;
    }
    EXPECT_GT(compared, 300);
    EXPECT_LE(differ, compared / 200) << "flattened by " << flatten;
  }
}

TEST(Instances, AFlatFloorFarFromItsOriginHasNoHoles) {
  // Thin boxes in both spaces, seen from far away: the two intervals must still meet.
  TriangleMesh floor;
  floor.vtx2xyz = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  floor.tri2vtx = {0, 1, 2, 0, 2, 3};
  std::mt19937 random(9);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  for (int trial = 0; trial < 40; ++trial) {
    TestScene scene;
    scene.add_mesh(floor);
    const Mat3d matrix = random_matrix(random, trial % 2 == 0 ? 1.0 : 1e-4);
    const Vec3 position = 1000.0f * Vec3(number(random), number(random), number(random));
    scene.add_instance(0, matrix, position);
    scene.commit();
    int missed = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3d local(0.98 * number(random), 0.98 * number(random), 0.0);
      const Vec3 target = Vec3(matrix * local + Vec3d(position));
      Ray ray;
      ray.origin = target + 5000.0f * Vec3(number(random), number(random), number(random));
      ray.direction = target - ray.origin;
      // Not along the floor, where a target rounded to float may be missed for good.
      const Vec3d normal = glm::normalize(glm::cross(matrix[0], matrix[1]));
      if (std::abs(glm::dot(normal, glm::normalize(Vec3d(ray.direction)))) < 0.1) continue;
      missed += intersect_scalar(scene.view(), ray).valid() ? 0 : 1;
    }
    EXPECT_EQ(missed, 0) << "trial " << trial;
  }
}

TEST(Instances, MaskAndSelfAreRespected) {
  TestScene scene;
  scene.add_mesh(ball(8));
  scene.add_instance(0, Mat3d(1.0), Vec3(0.0f), kMaskCamera);
  scene.add_instance(0, Mat3d(1.0), Vec3(0, 0, -5), kMaskShadow);
  scene.commit();
  Ray ray;
  ray.origin = Vec3(0.11f, 0.07f, 9.0f);
  ray.direction = Vec3(0, 0, -1);
  EXPECT_EQ(intersect_scalar(scene.view(), ray).instance, 0u);
  ray.mask = kMaskShadow;
  const Hit behind = intersect_scalar(scene.view(), ray);
  EXPECT_EQ(behind.instance, 1u);
  ray.self_instance = 1;
  ray.self_primitive = behind.primitive;
  const Hit next = intersect_scalar(scene.view(), ray);
  EXPECT_EQ(next.instance, 1u);
  EXPECT_NE(next.primitive, behind.primitive);
  ray.self_instance = 0;  // the same triangle of another instance is no excuse
  EXPECT_EQ(intersect_scalar(scene.view(), ray).primitive, behind.primitive);
  ray.mask = kMaskDiffuse;
  EXPECT_FALSE(intersect_scalar(scene.view(), ray).valid());
  testing::RayList rays;
  for (const std::uint32_t mask : {kMaskCamera, kMaskShadow, kMaskDiffuse, kMaskAll}) {
    ray.mask = mask;
    rays.push_back(ray);
  }
  EXPECT_EQ(expect_same_hits(scene, rays), 3u);
}

TEST(Instances, IntervalIsOpenAtBothEnds) {
  TestScene scene;
  TriangleMesh mesh;
  mesh.vtx2xyz = {-1, -1, 0, 3, -1, 0, -1, 3, 0};
  mesh.tri2vtx = {0, 1, 2};
  scene.add_mesh(mesh);
  scene.add_instance(0);
  scene.commit();
  Ray ray;
  ray.origin = Vec3(0, 0, 2);
  ray.direction = Vec3(0, 0, -1);
  EXPECT_EQ(intersect_scalar(scene.view(), ray).t, 2.0f);
  ray.t_max = 2.0f;
  EXPECT_FALSE(intersect_scalar(scene.view(), ray).valid());
  ray.t_max = std::nextafter(2.0f, 3.0f);
  EXPECT_TRUE(intersect_scalar(scene.view(), ray).valid());
  ray.t_min = 2.0f;
  EXPECT_FALSE(intersect_scalar(scene.view(), ray).valid());
  ray.t_min = std::nextafter(2.0f, 1.0f);
  EXPECT_TRUE(intersect_scalar(scene.view(), ray).valid());
}

TEST(Instances, TenThousandOfOneMesh) {
  TestScene scene(2);
  scene.add_mesh(ball(4));
  std::mt19937 random(2);
  std::uniform_real_distribution<float> number(-100.0f, 100.0f);
  for (int i = 0; i < 10000; ++i) {
    scene.add_instance(0, random_matrix(random, 1.0),
                       Vec3(number(random), number(random), number(random)));
  }
  scene.commit();
  EXPECT_EQ(validate(scene.instance_tree(), world_boxes(scene)), "");
  EXPECT_LT(scene.instance_tree().byte_count(), std::size_t{10000} * 100);
  EXPECT_GT(expect_same_hits(scene, random_rays(60, 100.0f)), 20u);
}

}  // namespace
}  // namespace komorebi
