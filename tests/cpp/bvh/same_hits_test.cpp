// Every builder, every instruction set, the specification and brute force give the same hits, to
// the bit, on real meshes and bad ones, at three scales.
#include <gtest/gtest.h>

#include <cstring>

#include "bvh/validate.h"
#include "support/ray_kinds.h"
#include "support/shared_meshes.h"
#include "support/test_scene.h"

namespace komorebi {
namespace {

using testing::RayList;
using testing::RayMaker;
using testing::TestScene;
using testing::TriangleMesh;

constexpr float kScales[] = {1e-3f, 1.0f, 1e3f};
constexpr std::size_t kBigMesh = 300000;  ///< above, two scales build the linear tree only
constexpr std::size_t kTestsPerSearch =
    12000000;  ///< triangle tests for one brute-force answer set

bool same(const Hit& a, const Hit& b) {
  return std::memcmp(&a, &b, sizeof(Hit)) == 0;
}

std::string describe(const Hit& hit) {
  char text[200];
  std::snprintf(text, sizeof(text), "t %a u %a v %a instance %d primitive %d", double(hit.t),
                double(hit.u), double(hit.v), int(hit.instance), int(hit.primitive));
  return text;
}

struct Answers {
  std::vector<Hit> hits;
  std::vector<std::uint32_t> occluded;
};

Answers brute_force(const SceneView& scene, const RayList& rays) {
  Answers answers{{}, std::vector<std::uint32_t>((rays.size() + 31) / 32, 0)};
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    answers.hits.push_back(intersect_brute_force(scene, rays[i]));
    if (occluded_brute_force(scene, rays[i])) answers.occluded[i / 32] |= 1u << (i % 32);
  }
  return answers;
}

Answers traced(const SceneView& scene, const RayList& rays, const std::string& isa) {
  force_instruction_set(isa);
  Answers answers{std::vector<Hit>(rays.size()),
                  std::vector<std::uint32_t>((rays.size() + 31) / 32, 0xffffffffu)};
  intersect(scene, rays.span(), answers.hits.data());
  occluded(scene, rays.span(), answers.occluded.data());
  force_instruction_set("");
  return answers;
}

/// The first `expected.hits.size()` rays of both agree.
void expect_same(const Answers& expected, const Answers& got, const std::string& what) {
  for (std::size_t i = 0; i < expected.hits.size(); ++i) {
    ASSERT_TRUE(same(expected.hits[i], got.hits[i]))
        << what << ", ray " << i << ":\n  expected " << describe(expected.hits[i])
        << "\n  got      " << describe(got.hits[i]);
    const bool covered = (got.occluded[i / 32] >> (i % 32)) & 1u;
    ASSERT_EQ(covered, expected.hits[i].valid()) << what << ", ray " << i << ", any hit";
  }
}

class SameHits : public ::testing::TestWithParam<std::string> {};

TEST_P(SameHits, OnMesh) {
  KOMOREBI_SHARED_FILE(path, "data/meshes/" + GetParam());
  const TriangleMesh original = testing::read_mesh(path);
  const std::size_t triangles = original.triangle_count();
  const auto few = static_cast<std::uint32_t>(
      std::clamp<std::size_t>(kTestsPerSearch / std::max<std::size_t>(triangles, 1), 14, 1400));
  const std::uint32_t many = 3500;
  std::size_t hit_count = 0;
  for (const float scale : kScales) {
    SCOPED_TRACE("scale " + std::to_string(scale));
    const TriangleMesh mesh = testing::scaled(original, scale);
    Answers searched, reference;
    RayList rays;
    for (const Builder builder :
         {Builder::kLinear, Builder::kSah, Builder::kPrincipalAxis, Builder::kList}) {
      if (triangles > kBigMesh && scale != 1.0f && builder != Builder::kLinear) continue;
      TestScene scene(2);
      scene.add_mesh(mesh, builder);
      scene.add_instance(0);
      scene.commit(builder);
      ASSERT_EQ(validate(scene.tree(0), mesh.vtx2xyz, mesh.tri2vtx), "");
      if (builder == Builder::kLinear) {
        rays = RayMaker(mesh, scene.tree(0).bounds, 1).make_list(many);
        RayList first;
        for (std::uint32_t i = 0; i < few; ++i) first.push_back(rays[i]);
        searched = brute_force(scene.view(), first);
        reference = traced(scene.view(), rays, "SCALAR");
        for (const Hit& hit : reference.hits) hit_count += hit.valid() ? 1u : 0u;
      }
      const bool list = builder == Builder::kList;  // as slow as brute force
      RayList asked;
      for (std::uint32_t i = 0; i < (list ? few / 4 : many); ++i) asked.push_back(rays[i]);
      for (const std::string& isa : built_instruction_sets()) {
        const Answers got = traced(scene.view(), asked, isa);
        const std::string what = "builder " + std::to_string(int(builder)) + ", " + isa;
        const std::size_t known = std::min(got.hits.size(), searched.hits.size());
        Answers brute{{searched.hits.begin(), searched.hits.begin() + std::ptrdiff_t(known)}, {}};
        expect_same(brute, got, what + " against brute force");
        Answers all{
            {reference.hits.begin(), reference.hits.begin() + std::ptrdiff_t(got.hits.size())}, {}};
        expect_same(all, got, what + " against the specification");
      }
    }
  }
  if (triangles > 0) {
    EXPECT_GT(hit_count, many / 4) << "the rays do not test anything";
  } else {
    EXPECT_EQ(hit_count, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, SameHits, ::testing::ValuesIn(testing::shared_meshes()),
                         [](const auto& test) { return testing::test_name(test.param); });

}  // namespace
}  // namespace komorebi
