#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "bvh/choose_builder.h"
#include "bvh/traverse.h"
#include "bvh/triangle_cluster.h"
#include "bvh/validate.h"
#include "bvh/wide_tree.h"
#include "parallel/scratch.h"
#include "support/sah_reference.h"
#include "support/shared_meshes.h"

namespace komorebi {
namespace {

using testing::TriangleMesh;

constexpr Builder kFast[] = {Builder::kLinear, Builder::kSah};

/// Loose triangles of the given size in a cube of side 2.
TriangleMesh random_triangles(std::size_t count, float size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    mesh.tri2vtx.push_back(static_cast<std::uint32_t>(i));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t first = mesh.vtx2xyz.size() - 3 * (i % 3);
      const float around = i % 3 == 0 ? 0.0f : mesh.vtx2xyz[first];
      mesh.vtx2xyz.push_back(i % 3 == 0 ? number(random) : around + size * number(random));
    }
  }
  return mesh;
}

MeshTree build(const TriangleMesh& mesh, Builder builder, unsigned threads = 2) {
  ThreadPool pool(threads);
  const Cancel cancel;
  return build_mesh_tree(mesh.vtx2xyz, mesh.tri2vtx, builder, pool, cancel);
}

WideTree build_wide(const TriangleMesh& mesh, Builder builder) {
  const Items items{mesh.vtx2xyz, mesh.tri2vtx, {}, {kClusterTriangles, kClusterVertices}};
  ThreadPool pool(2);
  const Cancel cancel;
  return build_wide_tree(items, builder, pool, cancel);
}

void expect_same_bytes(const MeshTree& a, const MeshTree& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  ASSERT_EQ(a.clusters.size(), b.clusters.size());
  EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(WideNode)), 0);
  EXPECT_EQ(std::memcmp(a.clusters.data(), b.clusters.data(), a.clusters.size()), 0);
  EXPECT_EQ(a.depth, b.depth);
}

TEST(Builders, AreValidForAnyNumberOfTriangles) {
  for (const Builder builder : kFast) {
    for (const std::size_t count : {0u, 1u, 2u, 3u, 8u, 9u, 100u, 1024u, 1025u, 20011u}) {
      const TriangleMesh mesh = random_triangles(count, 0.1f);
      const MeshTree tree = build(mesh, builder);
      EXPECT_EQ(validate(tree, mesh.vtx2xyz, mesh.tri2vtx), "") << count << " triangles";
    }
  }
}

TEST(Builders, AreValidWhereAreasOverflow) {
  for (const float size : {1e18f, 1e30f, 1e38f, 3e38f}) {
    TriangleMesh mesh = random_triangles(5000, 0.1f);
    for (float& x : mesh.vtx2xyz) x = std::clamp(x, -1.0f, 1.0f) * size;
    for (const Builder builder : kFast) {
      const MeshTree tree = build(mesh, builder);
      EXPECT_EQ(validate(tree, mesh.vtx2xyz, mesh.tri2vtx), "") << size;
    }
  }
}

TEST(Builders, GiveTheSameBytesForAnyNumberOfThreads) {
  KOMOREBI_SHARED_FILE(bunny, "data/meshes/bunny_hr.obj");
  KOMOREBI_SHARED_FILE(sponza, "data/meshes/sponza_dabrovic.ply");
  std::vector<TriangleMesh> meshes{random_triangles(100000, 0.02f), random_triangles(50000, 1e-6f),
                                   testing::read_mesh(bunny), testing::read_mesh(sponza)};
  for (const TriangleMesh& mesh : meshes) {
    for (const Builder builder : kFast) {
      const MeshTree one = build(mesh, builder, 1);
      EXPECT_EQ(validate(one, mesh.vtx2xyz, mesh.tri2vtx), "");
      for (const unsigned threads : {2u, 3u, 7u}) {
        expect_same_bytes(one, build(mesh, builder, threads));
      }
      release_scratch();
      expect_same_bytes(one, build(mesh, builder, 2));
    }
  }
}

TEST(Builders, LeaveNoByteOfAFullLeafUnwritten) {
  // An octahedron is one leaf of eight triangles, whose memory other builds have written to.
  TriangleMesh mesh;
  mesh.vtx2xyz = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1};
  mesh.tri2vtx = {0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2, 1, 0, 5, 3, 1, 5, 4, 3, 5, 0, 4, 5};
  for (const Builder builder : kFast) {
    release_scratch();
    const MeshTree first = build(mesh, builder);
    EXPECT_EQ(ClusterView(first.clusters.data()).triangle_count(), 8u);
    for (const float size : {0.05f, 0.1f, 0.2f}) {
      build(random_triangles(20000, size), builder);
      expect_same_bytes(first, build(mesh, builder));
    }
  }
}

TEST(Builders, GiveTheSameBytesOnEveryInstructionSet) {
  KOMOREBI_SHARED_FILE(bunny, "data/meshes/bunny_hr.obj");
  const std::string best = active_instruction_set();
  for (const TriangleMesh& mesh : {random_triangles(20000, 0.05f), testing::read_mesh(bunny)}) {
    for (const Builder builder : kFast) {
      const MeshTree expected = build(mesh, builder);
      for (const std::string& set : built_instruction_sets()) {
        force_instruction_set(set);
        expect_same_bytes(expected, build(mesh, builder));
      }
      force_instruction_set("");
    }
  }
  EXPECT_EQ(best, active_instruction_set());
}

TEST(Builders, BoundTheDepthOfAMillionEqualTriangles) {
  TriangleMesh mesh;
  mesh.vtx2xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  for (std::uint32_t i = 0; i < 3000000; ++i) mesh.tri2vtx.push_back(i % 3);
  for (const Builder builder : kFast) {
    const MeshTree tree = build(mesh, builder);
    EXPECT_EQ(validate(tree, mesh.vtx2xyz, mesh.tri2vtx), "");
    EXPECT_LE(tree.depth, 20u) << "log2 of an eighth of a million, and some";
  }
}

TEST(Builders, KeepQualityBesideAnOutlier) {
  // One triangle so far away that all others are in one cell of a plain grid.
  KOMOREBI_SHARED_FILE(spot, "data/meshes/spot.obj");
  TriangleMesh mesh = testing::read_mesh(spot);
  const Aabb bounds = build(mesh, Builder::kSah).bounds;
  const auto cost = [&](Builder builder) {
    return testing::wide_cost_within(build_wide(mesh, builder), bounds);
  };
  const double alone[] = {cost(Builder::kLinear), cost(Builder::kSah)};
  EXPECT_GT(alone[0], alone[1]) << "the better builder costs less";
  for (const float x : {1e7f, 1e7f + 1, 1e7f}) {
    mesh.tri2vtx.push_back(static_cast<std::uint32_t>(mesh.vtx2xyz.size() / 3));
    mesh.vtx2xyz.insert(mesh.vtx2xyz.end(),
                        {x, x == 1e7f ? 1.0f : 0.0f, float(mesh.tri2vtx.size())});
  }
  for (const Builder builder : kFast) {
    const MeshTree tree = build(mesh, builder);
    EXPECT_EQ(validate(tree, mesh.vtx2xyz, mesh.tri2vtx), "");
  }
  EXPECT_LE(cost(Builder::kLinear), 1.02 * alone[0]);
  EXPECT_LE(cost(Builder::kSah), 1.02 * alone[1]);
}

TEST(Builders, LeaveOutWhatHasNoArea) {
  TriangleMesh mesh = random_triangles(5000, 0.1f);
  for (std::size_t i = 0; i < mesh.tri2vtx.size(); i += 9) mesh.tri2vtx[i] = mesh.tri2vtx[i + 1];
  for (const Builder builder : kFast) {
    const MeshTree tree = build(mesh, builder);
    EXPECT_EQ(validate(tree, mesh.vtx2xyz, mesh.tri2vtx), "");
    EXPECT_EQ(tree.degenerate_count, 1667u);
  }
  for (std::uint32_t& v : mesh.tri2vtx) v = 0;
  for (const Builder builder : kFast) {
    const MeshTree tree = build(mesh, builder);
    EXPECT_EQ(validate(tree, mesh.vtx2xyz, mesh.tri2vtx), "");
    EXPECT_TRUE(tree.nodes.empty());
  }
}

TEST(Builders, SurviveTheLargestAndSmallestNumbers) {
  for (const float scale : {1e-30f, 1e-15f, 1e15f, 1e25f, 1e37f}) {
    const TriangleMesh mesh = testing::scaled(random_triangles(3000, 0.1f), scale);
    for (const Builder builder : kFast) {
      EXPECT_EQ(validate(build(mesh, builder), mesh.vtx2xyz, mesh.tri2vtx), "") << scale;
    }
  }
}

TEST(Builders, CanBeCancelled) {
  ThreadPool pool(2);
  Cancel cancel;
  cancel.raise();
  const TriangleMesh mesh = random_triangles(1000, 0.1f);
  for (const Builder builder : kFast) {
    EXPECT_THROW(build_mesh_tree(mesh.vtx2xyz, mesh.tri2vtx, builder, pool, cancel), Cancelled);
  }
}

TEST(Builders, AreChosenByTheRaysToCome) {
  EXPECT_EQ(choose_builder(1000000, 1e5), Builder::kLinear);
  EXPECT_EQ(choose_builder(1000000, 1e9), Builder::kSah);
  EXPECT_EQ(choose_builder(0, 0.0), Builder::kLinear);
}

/// Many small things in a few rooms: walls of two triangles among spheres of two hundred.
TriangleMesh furnished_rooms() {
  TriangleMesh mesh;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> number(0.0f, 1.0f);
  const auto vertex = [&](float x, float y, float z) {
    mesh.vtx2xyz.insert(mesh.vtx2xyz.end(), {x, y, z});
    return static_cast<std::uint32_t>(mesh.vtx2xyz.size() / 3 - 1);
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.tri2vtx.insert(mesh.tri2vtx.end(), {a, b, c, a, c, d});
  };
  for (float z = 0.0f; z <= 9.0f; z += 3.0f) {
    quad(vertex(0, 0, z), vertex(12, 0, z), vertex(12, 12, z), vertex(0, 12, z));
  }
  for (float at = 0.0f; at <= 12.0f; at += 4.0f) {
    quad(vertex(at, 0, 0), vertex(at, 12, 0), vertex(at, 12, 9), vertex(at, 0, 9));
    quad(vertex(0, at, 0), vertex(12, at, 0), vertex(12, at, 9), vertex(0, at, 9));
  }
  for (int i = 0; i < 300; ++i) {
    const float radius = 0.05f + 0.3f * number(random) * number(random);
    const float x = 12.0f * number(random), y = 12.0f * number(random), z = 9.0f * number(random);
    constexpr std::uint32_t kRings = 10;
    const auto first = static_cast<std::uint32_t>(mesh.vtx2xyz.size() / 3);
    for (std::uint32_t k = 0; k < (kRings + 1) * kRings; ++k) {
      const float up = 3.14159f * static_cast<float>(k / kRings) / kRings;
      const float round = 6.28319f * static_cast<float>(k % kRings) / kRings;
      vertex(x + radius * std::sin(up) * std::cos(round),
             y + radius * std::sin(up) * std::sin(round), z + radius * std::cos(up));
    }
    for (std::uint32_t k = 0; k < kRings * kRings; ++k) {
      const std::uint32_t row = first + k / kRings * kRings, a = k % kRings, b = (a + 1) % kRings;
      quad(row + a, row + kRings + a, row + kRings + b, row + b);
    }
  }
  return mesh;
}

TEST(Builders, WallsAmongSmallThings) {
  const TriangleMesh mesh = furnished_rooms();
  const Items items{mesh.vtx2xyz, mesh.tri2vtx, {}, {kClusterTriangles, kClusterVertices}};
  const double reference = testing::SahReference(items).cost();
  EXPECT_LE(testing::wide_cost(build_wide(mesh, Builder::kSah)), 1.02 * reference);
}

class SahCost : public ::testing::TestWithParam<const char*> {};

TEST_P(SahCost, IsWithinTwoPercentOfTheReference) {
  KOMOREBI_SHARED_FILE(path, std::string("data/meshes/") + GetParam());
  const TriangleMesh mesh = testing::read_mesh(path);
  const Items items{mesh.vtx2xyz, mesh.tri2vtx, {}, {kClusterTriangles, kClusterVertices}};
  const double reference = testing::SahReference(items).cost();
  const double sah = testing::wide_cost(build_wide(mesh, Builder::kSah));
  const double linear = testing::wide_cost(build_wide(mesh, Builder::kLinear));
  EXPECT_LE(sah, 1.02 * reference);
  EXPECT_GT(linear, sah);
  std::printf("%s: linear %.3f, SAH %.3f of the reference's cost %.2f\n", GetParam(),
              linear / reference, sah / reference, reference);
}

INSTANTIATE_TEST_SUITE_P(Shared, SahCost,
                         ::testing::Values("bunny_hr.obj", "sponza_dabrovic.ply",
                                           "dragon_vrip_res2.ply.gz", "boat.obj",
                                           "motorBike.obj.gz", "dragon_vrip.ply.gz"),
                         [](const auto& mesh) { return testing::test_name(mesh.param); });

}  // namespace
}  // namespace komorebi
