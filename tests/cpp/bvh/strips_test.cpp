// Strips: what builders handle as one item (bvh/strip.h).
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "bvh/morton_order.h"
#include "bvh/strip.h"
#include "bvh/traverse.h"
#include "core/triangle.h"
#include "support/shared_data.h"
#include "support/shared_meshes.h"

namespace komorebi {
namespace {

using testing::TriangleMesh;

/// side² squares of two triangles that follow each other, each square after its left neighbour.
/// With `degenerate`, a triangle without area stands between the two.
TriangleMesh squares(std::uint32_t side, bool degenerate) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= side; ++y) {
    for (std::uint32_t x = 0; x <= side; ++x) {
      mesh.vtx2xyz.insert(mesh.vtx2xyz.end(), {float(x), float(y), 0.0f});
    }
  }
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
      mesh.tri2vtx.insert(mesh.tri2vtx.end(), {a, b, d});
      if (degenerate) mesh.tri2vtx.insert(mesh.tri2vtx.end(), {a, d, a});
      mesh.tri2vtx.insert(mesh.tri2vtx.end(), {a, d, c});
    }
  }
  return mesh;
}

std::vector<std::uint32_t> strips_of(const TriangleMesh& mesh, unsigned threads) {
  const Items items{mesh.vtx2xyz, mesh.tri2vtx, {}, {kClusterTriangles, kClusterVertices}};
  ThreadPool pool(threads);
  const Cancel cancel;
  const MortonOrder order = order_by_morton(items, {}, pool, cancel);
  std::vector<std::uint32_t> strips(order.count);
  for (std::uint32_t i = 0; i < order.count; ++i) strips[i] = order.strip(i);
  return strips;
}

/// Every triangle with an area is in one strip, and a strip fits into a leaf.
void expect_whole(const TriangleMesh& mesh, const std::vector<std::uint32_t>& strips) {
  const Items items{mesh.vtx2xyz, mesh.tri2vtx, {}, {kClusterTriangles, kClusterVertices}};
  std::vector<int> times(items.count(), 0);
  for (const std::uint32_t strip : strips) {
    std::set<std::uint32_t> vertices;
    for (std::uint32_t k = 0; k < strip_count(strip); ++k) {
      const std::size_t triangle = strip_first(strip) + k;
      ASSERT_LT(triangle, items.count());
      ++times[triangle];
      for (std::size_t c = 0; c < 3; ++c) vertices.insert(mesh.tri2vtx[3 * triangle + c]);
    }
    EXPECT_LE(vertices.size(), strip_count(strip) == 2 ? 4u : kClusterVertices);
  }
  for (std::size_t i = 0; i < items.count(); ++i) {
    ASSERT_EQ(times[i], items.is_left_out(i) ? 0 : 1) << "triangle " << i;
  }
}

TEST(Strips, JoinTheTrianglesOfSquares) {
  const TriangleMesh mesh = squares(100, false);
  const std::vector<std::uint32_t> strips = strips_of(mesh, 2);
  expect_whole(mesh, strips);
  EXPECT_EQ(strips.size(), 100u * 100u);
}

TEST(Strips, EndAtWhatIsLeftOut) {
  const TriangleMesh mesh = squares(100, true);
  const std::vector<std::uint32_t> strips = strips_of(mesh, 2);
  expect_whole(mesh, strips);
  EXPECT_EQ(strips.size(), 2u * 100u * 100u);
}

TEST(Strips, AreTheSameOnEveryInstructionSetAndForAnyNumberOfThreads) {
  std::vector<TriangleMesh> meshes{squares(37, false), squares(5, true)};
  for (const char* const name : {"dragon_vrip_res3.ply.gz", "motorBike.obj.gz"}) {
    const auto path = testing::shared_folder() / "data/meshes" / name;
    if (std::filesystem::exists(path)) meshes.push_back(testing::read_mesh(path));
  }
  for (const TriangleMesh& mesh : meshes) {
    const std::vector<std::uint32_t> expected = strips_of(mesh, 1);
    expect_whole(mesh, expected);
    for (const std::string& set : built_instruction_sets()) {
      force_instruction_set(set);
      EXPECT_EQ(strips_of(mesh, 3), expected) << set;
    }
    force_instruction_set("");
  }
}

}  // namespace
}  // namespace komorebi
