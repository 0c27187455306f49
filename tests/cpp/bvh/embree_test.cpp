// Hit by hit against Embree, a tracer that is not ours. Its robust triangle test rounds otherwise
// than ours, so rays that pass within float distance of a silhouette, or meet two surfaces that
// close together, may be answered otherwise; all else may not.
#include <gtest/gtest.h>

#include <cmath>

#include "support/embree_scene.h"
#include "support/ray_kinds.h"
#include "support/shared_meshes.h"
#include "support/test_scene.h"

namespace komorebi {
namespace {

using testing::EmbreeScene;
using testing::RayList;
using testing::RayMaker;
using testing::TestScene;
using testing::TriangleMesh;

Vec3d corner(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t which) {
  const float* p = &mesh.vtx2xyz[3 * std::size_t{mesh.tri2vtx[3 * std::size_t{triangle} + which]}];
  return Vec3d(p[0], p[1], p[2]);
}

/// Whether `ray` comes within `distance` of triangle `t`'s edges, in double: closest approach of
/// the ray's line to each edge.
bool passes_an_edge(const TriangleMesh& mesh, std::uint32_t t, const Ray& ray, double distance) {
  const Vec3d o(ray.origin), d = glm::normalize(Vec3d(ray.direction));
  for (std::size_t k = 0; k < 3; ++k) {
    // In the plane across the ray, the distance of the origin to a segment.
    const auto across = [&](const Vec3d& p) { return (p - o) - glm::dot(p - o, d) * d; };
    const Vec3d a = across(corner(mesh, t, k)), b = across(corner(mesh, t, (k + 1) % 3));
    const double length2 = glm::dot(b - a, b - a);
    const double s = length2 > 0 ? std::clamp(-glm::dot(a, b - a) / length2, 0.0, 1.0) : 0.0;
    if (glm::length(a + s * (b - a)) <= distance) return true;
  }
  return false;
}

/// The plain ray–triangle intersection in double (Möller, Trumbore 1997): barycentrics of the
/// point where the ray's line meets the plane, and the sine of the angle between the two.
struct Oracle {
  double u, v, sine;
  bool inside() const { return u >= 0 && v >= 0 && u + v <= 1; }
};

Oracle meet(const TriangleMesh& mesh, std::uint32_t triangle, const Ray& ray) {
  const Vec3d a = corner(mesh, triangle, 0), d(ray.direction);
  const Vec3d b = corner(mesh, triangle, 1) - a, c = corner(mesh, triangle, 2) - a;
  const Vec3d across = glm::cross(d, c), from_a = Vec3d(ray.origin) - a;
  const double determinant = glm::dot(b, across);
  const double area = glm::length(glm::cross(b, c));
  return {glm::dot(from_a, across) / determinant, glm::dot(d, glm::cross(from_a, b)) / determinant,
          std::abs(determinant) / (area * glm::length(d))};
}

/// How often the two tracers named different triangles, and why.
struct Disagreements {
  std::uint32_t as_near = 0;       ///< both hit, within float distance of each other
  std::uint32_t past_an_edge = 0;  ///< the nearer triangle's edge is within float distance
  std::uint32_t theirs_wrong = 0;  ///< double precision says that Embree's triangle is not met
  std::uint32_t not_aimed = 0;     ///< of the last two, by rays not aimed at edges or planes
};

/// Counts the reason; false if there is none.
bool explain(const TriangleMesh& mesh, const Ray& ray, const Hit& ours, const Hit& theirs,
             double close, bool aimed, Disagreements* found) {
  if (ours.valid() && theirs.valid()) {
    const double sine =
        std::min(meet(mesh, ours.primitive, ray).sine, meet(mesh, theirs.primitive, ray).sine);
    const double apart = std::abs(double(ours.t) - double(theirs.t));
    // A distance across a plane is 1/sine longer along the ray.
    if (apart * glm::length(Vec3d(ray.direction)) <= close / std::max(sine, 1e-3)) {
      ++found->as_near;
      return true;
    }
  }
  const bool ours_nearer = ours.valid() && (!theirs.valid() || ours.t < theirs.t);
  const std::uint32_t nearer = ours_nearer ? ours.primitive : theirs.primitive;
  if (!aimed) ++found->not_aimed;
  if (passes_an_edge(mesh, nearer, ray, close)) {
    ++found->past_an_edge;
    return true;
  }
  if (!ours_nearer && !meet(mesh, nearer, ray).inside()) {
    ++found->theirs_wrong;
    return true;
  }
  return false;
}

class AgainstEmbree : public ::testing::TestWithParam<std::string> {};

TEST_P(AgainstEmbree, HitByHit) {
  KOMOREBI_SHARED_FILE(path, "data/meshes/" + GetParam());
  const TriangleMesh original = testing::read_mesh(path);
  for (const float scale : {1e-3f, 1.0f, 1e3f}) {
    if (original.triangle_count() > 300000 && scale != 1.0f) continue;
    const TriangleMesh mesh = testing::scaled(original, scale);
    TestScene scene(2);
    scene.add_mesh(mesh);
    scene.add_instance(0);
    scene.commit();
    const EmbreeScene embree(mesh);
    RayMaker maker(mesh, scene.tree(0).bounds, 2);
    RayList rays;
    std::vector<int> kinds;
    for (int i = 0; i < 21000; ++i) {
      const int kind = i % RayMaker::kKinds;
      Ray ray = maker.make(kind);
      if (ray.t_min < 0) ray.t_min = 0;  // Embree has no rays that go backwards,
      if (kind == 5) continue;           // and those that begin on a surface are a coin's toss
      rays.push_back(ray);
      kinds.push_back(kind);
    }
    std::vector<Hit> hits(rays.size());
    intersect(scene.view(), rays.span(), hits.data());

    Disagreements found;
    std::uint32_t hit_count = 0;
    const float size = max_abs(scene.tree(0).bounds);
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      const Ray ray = rays[i];
      const Hit theirs = embree.intersect(ray);
      hit_count += hits[i].valid() ? 1u : 0u;
      if (hits[i].primitive == theirs.primitive) continue;
      // Float distance: some ulps of the largest coordinates in play.
      const double close = 4e-6 * double(max_of(size, max_abs(ray.origin)));
      ASSERT_TRUE(
          explain(mesh, ray, hits[i], theirs, close, kinds[i] != 0 && kinds[i] != 6, &found))
          << "scale " << scale << ", ray " << i << ": ours " << hits[i].primitive << " at "
          << hits[i].t << ", Embree's " << theirs.primitive << " at " << theirs.t;
    }
    std::printf(
        "%s x %g: %u rays, %u hits; other triangle: %u as near, %u past an edge, %u where "
        "Embree is wrong; %u of the last two by rays not aimed there\n",
        GetParam().c_str(), double(scale), rays.size(), hit_count, found.as_near,
        found.past_an_edge, found.theirs_wrong, found.not_aimed);
    EXPECT_LE(found.theirs_wrong, rays.size() / 1000);
    EXPECT_LE(found.not_aimed, 6u);
    if (mesh.triangle_count() > 0) {
      EXPECT_GT(hit_count, rays.size() / 8) << "the rays do not test anything";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, AgainstEmbree, ::testing::ValuesIn(testing::shared_meshes()),
                         [](const auto& test) { return testing::test_name(test.param); });

}  // namespace
}  // namespace komorebi
