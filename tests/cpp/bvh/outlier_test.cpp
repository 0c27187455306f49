// Something small in something vast: the linear tree must not pay for what lies far away.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "core/slab.h"
#include "support/test_scene.h"

namespace komorebi {
namespace {

using testing::TestScene;
using testing::TriangleMesh;

/// A wavy sheet of 2 · side² triangles, one metre wide.
TriangleMesh sheet(std::uint32_t side) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= side; ++y) {
    for (std::uint32_t x = 0; x <= side; ++x) {
      const float u = float(x) / float(side), v = float(y) / float(side);
      mesh.vtx2xyz.insert(mesh.vtx2xyz.end(),
                          {u, v, 0.1f * std::sin(9.0f * u) * std::cos(7.0f * v)});
    }
  }
  // In no order, for one that is known from the file would hide codes that part nothing.
  std::vector<std::uint32_t> quads(side * side);
  std::iota(quads.begin(), quads.end(), 0u);
  std::shuffle(quads.begin(), quads.end(), std::mt19937(8));
  for (const std::uint32_t quad : quads) {
    const std::uint32_t x = quad % side, y = quad / side;
    const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
    mesh.tri2vtx.insert(mesh.tri2vtx.end(), {a, a + 1, b, a + 1, b + 1, b});
  }
  return mesh;
}

void add_triangle(TriangleMesh& mesh, const Vec3& at, float size) {
  const auto first = static_cast<std::uint32_t>(mesh.vtx2xyz.size() / 3);
  mesh.vtx2xyz.insert(mesh.vtx2xyz.end(),
                      {at.x, at.y, at.z, at.x + size, at.y, at.z, at.x, at.y + size, at.z});
  mesh.tri2vtx.insert(mesh.tri2vtx.end(), {first, first + 1, first + 2});
}

constexpr int kRays = 2000;

/// Nodes and leaves that rays over the sheet open, all boxes that they meet counted: the work of
/// any-hit rays that escape. It does not depend on the machine.
double visits(const TriangleMesh& mesh) {
  TestScene scene(2);
  scene.add_mesh(mesh);
  const MeshTree& tree = scene.tree(0);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> number(0.0f, 1.0f);
  std::size_t count = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vec3 origin(number(random), number(random), 0.3f * number(random) - 0.1f);
    const Vec3 direction(number(random) - 0.5f, number(random) - 0.5f, number(random) - 0.3f);
    const SlabRay ray = make_slab_ray(origin, direction, Vec3(1e-6f));
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
      const WideNode& node = tree.nodes[stack.back()];
      stack.pop_back();
      ++count;
      for (int k = 0; k < node.child_count(); ++k) {
        if (slab_interval(ray, node.box(k), Interval{0.0f, 3.0f}).is_empty()) continue;
        if (k < node.inner_count()) {
          stack.push_back(node.child_node(k));
        } else {
          ++count;
        }
      }
    }
  }
  return static_cast<double>(count);
}

TEST(Outlier, OneTriangleTenKilometresAwayCostsNothing) {
  const TriangleMesh plain = sheet(300);
  const double without = visits(plain);
  for (const float size : {0.01f, 5000.0f}) {
    TriangleMesh with = plain;
    add_triangle(with, Vec3(1e4f, -3e3f, 200.0f), size);
    EXPECT_LT(visits(with), 1.2 * without) << "a triangle of " << size << " m";
  }
  TriangleMesh many = plain;
  for (int i = 0; i < 2000; ++i) {  // a hundredth of the triangles, everywhere
    add_triangle(many, 1e4f * Vec3(std::sin(float(i)), std::cos(1.7f * float(i)), 0.3f), 1.0f);
  }
  EXPECT_LT(visits(many), 1.2 * without);
}

TEST(Outlier, FineDetailInALargeSceneIsToldApart) {
  // A statue on a plain: most of the cells are empty, the codes must still part its triangles.
  const TriangleMesh statue = sheet(200);
  const double alone = visits(statue);
  TriangleMesh plain = statue;
  for (std::uint32_t i = 0; i < 90000; ++i) {
    add_triangle(plain,
                 Vec3(10.0f * float(i % 300) - 1500.0f, 10.0f * float(i / 300) - 1500.0f, -5.0f),
                 9.0f);
  }
  // Three nodes more a ray lead from the plain to the statue, on grids that grow with the plain.
  EXPECT_LT(visits(plain), 1.1 * alone + 4.0 * kRays);
}

}  // namespace
}  // namespace komorebi
