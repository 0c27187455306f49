// Meshes that deform: the trees against brute force at each ray's time, still meshes of that time,
// and coverage in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "support/moving.h"

namespace komorebi::testing {
namespace {

Vec3d wave(const Vec3d& p, double t) {
  return p + Vec3d(2.0 * t * t, 0.4 * std::sin(7.0 * p.x + 5.0 * t), std::max(0.0, t - 0.4));
}

TEST(DeformingMeshes, AgreeWithBruteForceForEveryBuilderAndKernel) {
  for (const Builder builder : {Builder::kLinear, Builder::kSah, Builder::kList}) {
    for (const int others : {2, 6}) {
      const auto waving = deforming(sphere(12, Vec3d(0), 1.5, false), others, wave, builder);
      const auto calm = deforming(
          sphere(12, Vec3d(0), 1.5, false), others,
          [](const Vec3d& p, double t) { return p + Vec3d(1e-3 * t); }, builder);
      const auto collapsing = deforming(
          sphere(7, {30, 0, 0}, 1.5, false), others,
          [](const Vec3d& p, double t) { return p * Vec3d(1, 1, 1.0 - t) - Vec3d(30, 0, 0); },
          builder);
      EXPECT_TRUE(waving->deforms());
      EXPECT_EQ(calm->view().time_tree_count, 1u);
      EXPECT_GT(waving->view().time_tree_count, 2u);
      Mat4d sheared = translated(2, -3, 1);
      sheared[1] -= 0.7 * sheared[0];
      sheared[2] *= -1.0;
      auto scene = make_scene({{waving},
                               {calm, sheared},
                               {collapsing, translated(-3, 2, 0)},
                               {waving, translated(0, 4, -3)},
                               {waving, glm::scale(translated(3, 1, 0), Vec3d(1, 1, 0))}},
                              camera_at({9, 0, 0}, {0, 0, 0}, 10, 10));
      add_moving(
          *scene, waving,
          [](double t) {
            return glm::rotate(translated(-2, -2, 3.0 * t), 4.0 * t, Vec3d(0, 1, 0));
          },
          5);
      committed(scene);
      const Vec3 centre(-scene->origin());
      EXPECT_GT(expect_brute_force(*scene, random_rays(1500, centre, 5.0f)), 300u);
    }
  }
}

TEST(DeformingMeshes, AreAtEachTimeTheMeshOfThatTime) {
  const Polygons rest = sphere(24, Vec3d(0), 1.5, true);
  const auto deforms = deforming(rest, 4, wave);
  const CameraDesc camera = camera_at({9, 0, 0}, {0, 0, 0}, 10, 10);
  const auto scene = committed(make_scene({{deforms}}, camera));
  int compared = 0, differ = 0;
  for (int step = 0; step <= 8; ++step) {
    // Halfway between two of them positions and normals are the means.
    const int from = step / 2, to = (step + 1) / 2;
    Polygons still = rest;
    for (std::size_t v = 0; v < still.vtx2xyz.size(); v += 3) {
      const Vec3d p(rest.vtx2xyz[v], rest.vtx2xyz[v + 1], rest.vtx2xyz[v + 2]);
      const Vec3d q = 0.5 * (wave(p, 0.25 * from) + wave(p, 0.25 * to));
      for (std::size_t c = 0; c < 3; ++c) still.vtx2xyz[v + c] = float(q[int(c)]);
    }
    for (std::size_t n = 0; n < still.corner2normal.size(); n += 3) {
      const Vec3d r(rest.corner2normal[n], rest.corner2normal[n + 1], rest.corner2normal[n + 2]);
      const Vec3d m = 0.5 * (glm::normalize(r + Vec3d(0, 0.125 * from, 0)) +
                             glm::normalize(r + Vec3d(0, 0.125 * to, 0)));
      for (std::size_t c = 0; c < 3; ++c) still.corner2normal[n + c] = float(m[int(c)]);
    }
    const auto other = committed(make_scene({{still.mesh()}}, camera));
    const RayList rays = random_rays(800, Vec3(0.0f), 3.0f);
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      Ray a = rays[i], b = rays[i];
      a.self_instance = b.self_instance = kNone;
      a.origin -= Vec3(scene->origin());
      b.origin -= Vec3(other->origin());
      a.time = 0.125f * float(step);
      const Hit hit = intersect_scalar(scene->view(), a), same = intersect_scalar(other->view(), b);
      if (!hit.valid() && !same.valid()) continue;
      ++compared;
      if (hit.primitive != same.primitive) {
        ++differ;  // on an edge
        continue;
      }
      const SurfacePoint p = surface_point(scene->view(), hit, a);
      const SurfacePoint q = surface_point(other->view(), same, b);
      EXPECT_LT(glm::length(p.normal - q.normal), 1e-4f);
      EXPECT_LT(glm::length(p.geometric_normal - q.geometric_normal), 1e-3f);
      EXPECT_NEAR(hit.t, same.t, 1e-4f);
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LE(differ, compared / 100);
}

TEST(DeformingMeshes, ASquareThatPassesCoversATrapezoid) {
  const auto square = deforming(quad({-0.2, -0.5, 0}, {0.4, 0, 0}, {0, 1, 0}), 2,
                                [](const Vec3d& p, double t) { return p + Vec3d(t - 0.5, 0, 0); });
  auto scene = make_scene({{square}}, from_above(40));
  EXPECT_TRUE(scene->meshes()[0]->deforms());
  const auto alpha = coverage(scene, 40, 20);
  for (std::uint32_t x = 0; x < 40; ++x) {
    EXPECT_NEAR(alpha[x], trapezoid(-1.0 + 0.05 * x), 6e-3) << x;
  }
}

TEST(DeformingMeshes, RefuseWhatDoesNotFit) {
  const Polygons ball = sphere(4, Vec3d(0), 1.0, true);
  const auto refused = [](const MeshInput& input) {
    EXPECT_THROW(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel()),
                 std::invalid_argument);
  };
  std::vector<float> twice(2 * ball.vtx2xyz.size(), 0.5f);
  std::vector<float> normals(2 * ball.corner2normal.size(), 0.5f);
  MeshInput input = ball.input();
  input.motion_positions = std::span(twice).first(ball.vtx2xyz.size());
  refused(input);  // an even number of all
  input.motion_positions = twice;
  input.motion_normals = std::span(normals).first(6);
  refused(input);
  input.motion_normals = normals;
  EXPECT_EQ(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel())->vertex_count(),
            ball.vtx2xyz.size() / 3);
  EXPECT_THROW(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel(), ball.mesh().get()),
               std::invalid_argument);
  twice[5] = NAN;
  refused(input);
}

}  // namespace
}  // namespace komorebi::testing
