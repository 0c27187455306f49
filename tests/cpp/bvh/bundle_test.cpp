// Rays of common points are answered as single rays are, by every instruction set, to the bit:
// against brute force, for bundles of all sizes, instances of all kinds, masks and bad rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/bundle_list.h"
#include "support/ray_kinds.h"
#include "support/ray_list.h"
#include "support/shared_meshes.h"
#include "support/test_scene.h"

namespace komorebi {
namespace {

using testing::BundleList;
using testing::RayList;
using testing::RayMaker;
using testing::TestScene;
using testing::TriangleMesh;

constexpr std::uint32_t kSizes[] = {0, 1, 2, 3, 7, 16, 31, 32, 33, 64, 100};

/// Bundles of all sizes at points where RayMaker's rays begin: one of its rays, and others in all
/// directions, some along axes and some of finite length.
BundleList make_bundles(const TriangleMesh& mesh, const Aabb& box, unsigned seed,
                        std::uint32_t mask = kMaskAll) {
  RayMaker maker(mesh, box, seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  BundleList bundles(mask);
  for (const std::uint32_t size : kSizes) {
    for (int kind = 0; kind < RayMaker::kKinds; ++kind) {
      const Ray first = maker.make(kind);
      bundles.add_point(first);
      for (std::uint32_t i = 0; i < size; ++i) {
        Vec3 direction(number(random), number(random), number(random));
        if (i == 0) direction = first.direction;
        if (i % 7 == 3) direction[static_cast<int>(i % 3)] = i % 2 == 0 ? 0.0f : -0.0f;
        if (i % 11 == 5) direction *= 1e-3f;
        bundles.add_ray(direction, i % 3 == 1 ? std::abs(number(random)) * 2.0f : first.t_max);
      }
    }
  }
  return bundles;
}

/// Compares all kernels' answers with those of `expected(ray)`; returns how many are blocked.
template <class Expected>
std::uint32_t expect_answers(const SceneView& scene, const RayBundles& bundles,
                             const Expected& expected) {
  std::uint32_t blocked = 0;
  std::vector<bool> wanted;
  for (std::uint32_t p = 0; p < bundles.point_count; ++p) {
    for (std::uint32_t i = bundles.first_ray[p]; i < bundles.first_ray[p + 1]; ++i) {
      wanted.push_back(expected(bundles.ray(p, i)));
      blocked += wanted.back() ? 1u : 0u;
    }
  }
  const std::size_t words = (wanted.size() + 31) / 32;
  for (const std::string& isa : built_instruction_sets()) {
    force_instruction_set(isa);
    std::vector<std::uint32_t> bits(words + 1, 0xdeadbeefu);
    occluded(scene, bundles, bits.data());
    EXPECT_EQ(bits[words], 0xdeadbeefu) << isa << " writes too far";
    for (std::size_t i = 0; i < 32 * words; ++i) {
      const bool got = (bits[i / 32] >> (i % 32)) & 1u;
      EXPECT_EQ(got, i < wanted.size() && wanted[i]) << isa << ", ray " << i;
      if (::testing::Test::HasFailure()) return blocked;
    }
  }
  force_instruction_set("");
  return blocked;
}

std::uint32_t expect_brute_force(const SceneView& scene, const RayBundles& bundles) {
  return expect_answers(scene, bundles,
                        [&](const Ray& ray) { return occluded_brute_force(scene, ray); });
}

class Bundles : public ::testing::TestWithParam<std::string> {};

TEST_P(Bundles, OnMesh) {
  KOMOREBI_SHARED_FILE(path, "data/meshes/" + GetParam());
  const TriangleMesh original = testing::read_mesh(path);
  for (const float scale : {1e-3f, 1.0f, 1e3f}) {
    if (original.triangle_count() > 100000 && scale != 1.0f) continue;
    SCOPED_TRACE("scale " + std::to_string(scale));
    const TriangleMesh mesh = testing::scaled(original, scale);
    TestScene scene(2);
    scene.add_mesh(mesh);
    scene.add_instance(0);
    scene.commit();
    const BundleList bundles = make_bundles(mesh, scene.tree(0).bounds, 4);
    const bool small = mesh.triangle_count() < 2000;
    const std::uint32_t blocked = expect_answers(scene.view(), bundles.view(), [&](const Ray& ray) {
      return small ? occluded_brute_force(scene.view(), ray) : occluded_scalar(scene.view(), ray);
    });
    if (mesh.triangle_count() > 100) {
      EXPECT_GT(blocked, 30u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, Bundles, ::testing::ValuesIn(testing::shared_meshes()),
                         [](const auto& test) { return testing::test_name(test.param); });

/// A bumpy sheet of 2 · 12 · 12 triangles.
TriangleMesh sheet() {
  TriangleMesh mesh;
  for (int y = 0; y <= 12; ++y) {
    for (int x = 0; x <= 12; ++x) {
      mesh.vtx2xyz.insert(mesh.vtx2xyz.end(), {float(x) / 6 - 1, float(y) / 6 - 1,
                                               0.1f * std::sin(float(x)) * std::cos(float(y))});
    }
  }
  for (std::uint32_t v = 0; v < 12 * 13; ++v) {
    if (v % 13 == 12) continue;
    mesh.tri2vtx.insert(mesh.tri2vtx.end(), {v, v + 1, v + 14, v, v + 14, v + 13});
  }
  return mesh;
}

TEST(BundlesOfInstances, MirroredShearedAndFlattenedWithMasks) {
  TestScene scene(2);
  const TriangleMesh mesh = sheet();
  scene.add_mesh(mesh);
  scene.add_mesh(TriangleMesh{});
  std::mt19937 random(1);
  std::normal_distribution<double> number;
  for (int i = 0; i < 40; ++i) {
    Mat3d m;
    for (int k = 0; k < 9; ++k) m[k / 3][k % 3] = number(random);
    m[2] *= i % 3 == 0 ? 1e-5 : i % 3 == 1 ? 1.0 : -1.0;
    const Vec3 position(Vec3d(4 * number(random), 4 * number(random), 4 * number(random)));
    scene.add_instance(0, m, position, i % 4 == 0 ? kMaskCamera : kMaskShadow | kMaskDiffuse);
  }
  scene.add_instance(1);
  scene.add_instance(0, Mat3d(0.0));
  scene.commit();
  std::uint32_t blocked[4];
  int k = 0;
  for (const std::uint32_t mask : {kMaskAll, kMaskCamera, kMaskShadow, RayMask{}}) {
    const BundleList bundles = make_bundles(mesh, Aabb{Vec3(-6.0f), Vec3(6.0f)}, 8, mask);
    blocked[k++] = expect_brute_force(scene.view(), bundles.view());
  }
  EXPECT_GT(blocked[2], 50u);
  EXPECT_GT(blocked[0], blocked[2]);
  EXPECT_GT(blocked[1], 20u);
  EXPECT_EQ(blocked[3], 0u);
}

TEST(BundlesOfInstances, SpansOfRaysThatShareNothing) {
  TestScene scene(2);
  const TriangleMesh mesh = sheet();
  scene.add_mesh(mesh);
  for (int i = 0; i < 12; ++i) {
    scene.add_instance(0, Mat3d(1.0), Vec3(0, 0, 0.5f * float(i)),
                       i % 3 == 0   ? kMaskAll
                       : i % 3 == 1 ? kMaskCamera
                                    : kMaskShadow);
  }
  scene.commit();
  RayMaker maker(mesh, Aabb{Vec3(-1, -1, -1), Vec3(1, 1, 7)}, 3);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(0.0f, 1.0f);
  RayList rays;
  for (std::uint32_t i = 0; i < 1501; ++i) {
    Ray ray = maker.make(static_cast<int>(i) % RayMaker::kKinds);
    ray.mask = i % 5 == 0   ? kMaskAll
               : i % 5 < 3  ? kMaskCamera
               : i % 5 == 3 ? kMaskShadow
                            : RayMask{};
    if (i % 4 == 1) ray.t_min = number(random);
    if (i % 4 == 2) ray.t_max = 3.0f * number(random);
    if (i % 7 == 0) ray.self_instance = i % 12, ray.self_primitive = i % 288;
    rays.push_back(ray);
  }
  std::vector<bool> wanted;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    wanted.push_back(occluded_brute_force(scene.view(), rays[i]));
  }
  EXPECT_GT(std::count(wanted.begin(), wanted.end(), true), 200);
  EXPECT_GT(std::count(wanted.begin(), wanted.end(), false), 200);
  for (const std::string& isa : built_instruction_sets()) {
    force_instruction_set(isa);
    for (const std::uint32_t size : {1u, 31u, 256u, 257u, rays.size()}) {
      for (std::uint32_t first = 0; first < rays.size(); first += size) {
        const std::uint32_t count = std::min(size, rays.size() - first);
        std::vector<std::uint32_t> bits((count + 31) / 32 + 1, 0xdeadbeefu);
        occluded(scene.view(), rays.span(first, count), bits.data());
        EXPECT_EQ(bits.back(), 0xdeadbeefu) << isa << " writes too far";
        for (std::uint32_t i = 0; i < 32 * ((count + 31) / 32); ++i) {
          const bool got = (bits[i / 32] >> (i % 32)) & 1u;
          ASSERT_EQ(got, i < count && wanted[first + i]) << isa << ", ray " << first + i;
        }
      }
    }
  }
  force_instruction_set("");
}

TEST(BundlesOfInstances, TheirOwnTriangleIsNotHit) {
  TestScene scene(2);
  scene.add_mesh(sheet());
  scene.add_instance(0);
  scene.add_instance(0, Mat3d(1.0), Vec3(0, 0, 1));
  scene.commit();
  BundleList bundles;
  for (std::uint32_t instance = 0; instance < 2; ++instance) {
    for (std::uint32_t triangle = 0; triangle < 200; ++triangle) {
      const TriangleMesh& mesh = scene.mesh(0);
      Ray ray;
      for (std::size_t corner = 0; corner < 3; ++corner) {  // from the middle of the triangle
        const float* p = &mesh.vtx2xyz[3 * std::size_t{mesh.tri2vtx[3 * triangle + corner]}];
        ray.origin += Vec3(p[0], p[1], p[2] + float(instance)) / 3.0f;
      }
      ray.self_instance = instance;
      ray.self_primitive = triangle;
      bundles.add_point(ray);
      for (int i = 0; i < 8; ++i) {
        const float phi = 0.7f * float(i) + float(triangle);
        bundles.add_ray(Vec3(std::cos(phi), std::sin(phi), i % 2 == 0 ? 0.2f : 3.0f), kFloatMax);
      }
    }
  }
  EXPECT_GT(expect_brute_force(scene.view(), bundles.view()), 500u);
}

TEST(BundlesOfInstances, OfOneOfManyAndOfNone) {
  for (const int instances : {0, 1, 2, 300}) {
    TestScene scene;
    const TriangleMesh mesh = sheet();
    scene.add_mesh(mesh);
    for (int i = 0; i < instances; ++i) {
      scene.add_instance(0, Mat3d(1.0), Vec3(float(i % 17), float(i % 13), float(i % 11)));
    }
    scene.commit();
    const BundleList bundles = make_bundles(mesh, Aabb{Vec3(-2.0f), Vec3(14.0f)}, 9);
    const std::uint32_t blocked = expect_brute_force(scene.view(), bundles.view());
    EXPECT_EQ(blocked > 0, instances > 0);
  }
}

TEST(BundlesOfInstances, RaysMayStandAnywhere) {
  TestScene scene;
  const TriangleMesh mesh = sheet();
  scene.add_mesh(mesh);
  for (int i = 0; i < 3; ++i) scene.add_instance(0, Mat3d(1.0), Vec3(float(i)));
  scene.commit();
  const BundleList list = make_bundles(mesh, Aabb{Vec3(-1.0f), Vec3(3.0f)}, 10);
  const RayBundles in_order = list.view();
  std::vector<std::uint32_t> place(in_order.ray_count());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
  std::shuffle(place.begin(), place.end(), std::mt19937(4));
  std::vector<float> x(place.size()), y(place.size()), z(place.size()), t_max(place.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) {
    x[place[i]] = in_order.direction_x[i];
    y[place[i]] = in_order.direction_y[i];
    z[place[i]] = in_order.direction_z[i];
    t_max[place[i]] = in_order.t_max[i];
  }
  RayBundles shuffled = in_order;
  shuffled.place = place.data();
  shuffled.direction_x = x.data(), shuffled.direction_y = y.data();
  shuffled.direction_z = z.data(), shuffled.t_max = t_max.data();
  for (std::uint32_t i = 0; i < place.size(); ++i) {
    ASSERT_EQ(shuffled.ray(0, i).direction, in_order.ray(0, i).direction);
  }
  EXPECT_EQ(expect_brute_force(scene.view(), shuffled), expect_brute_force(scene.view(), in_order));
}

TEST(BundlesOfInstances, NumbersThatAreNoneHitNothing) {
  TestScene scene;
  scene.add_mesh(sheet());
  scene.add_instance(0);
  scene.commit();
  BundleList bundles;
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(), -1e38f, 0.0f, 1e-42f};
  for (const float x : bad) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool in_origin : {true, false}) {
        Ray ray;
        ray.origin = Vec3(0.2f, 0.3f, 3.0f);
        if (in_origin) ray.origin[axis] = x;
        bundles.add_point(ray);
        for (int i = 0; i < 5; ++i) {
          Vec3 direction(0.1f * float(i), 0.05f, -1.0f);
          if (!in_origin && i != 2) direction[axis] = x;
          bundles.add_ray(direction, i == 4 ? x : kFloatMax);
        }
      }
    }
  }
  expect_brute_force(scene.view(), bundles.view());
}

}  // namespace
}  // namespace komorebi
