// Whether normals are interpolated in the world or in the mesh's own space, by arithmetic in
// doubles, and which of it a scene asks for.
#include <gtest/gtest.h>

#include "bvh/traverse.h"
#include "support/moving.h"

namespace komorebi::testing {
namespace {

const Vec3d kCorner[3] = {{0.0, 0.0, 0.0}, {1.0, 0.1, 0.2}, {0.2, 0.9, -0.1}};
const Vec3d kNormal[3] = {{-0.6, 0.0, 0.8}, {0.48, -0.36, 0.8}, {0.0, 0.8, 0.6}};
constexpr double kU = 0.3, kV = 0.45;

/// One triangle whose corners have these normals.
Polygons bent_triangle() {
  Polygons p;
  for (const Vec3d& corner : kCorner) p.vertex(corner);
  p.face({0, 1, 2});
  for (const Vec3d& n : kNormal) {
    for (int c = 0; c < 3; ++c) p.corner2normal.push_back(static_cast<float>(n[c]));
  }
  return p;
}

Mat4d affine(const Vec3d& x, const Vec3d& y, const Vec3d& z) {
  return Mat4d({x, 0.0}, {y, 0.0}, {z, 0.0}, {3.0, -2.0, 1.0, 1.0});
}

const Mat4d kStretched = affine({1.0, 0, 0}, {0, 0.5, 0}, {0, 0, 1.4});
const Mat4d kMirrored = affine({-1.3, 0.2, 0}, {0, 0.6, 0}, {0, 0, 1.1});
const Mat4d kSheared = affine({1.0, 0, 0.1}, {0.9, 1.0, 0.4}, {0.2, 0, 1.0});

/// What the two rules say; the matrix acts on directions.
Vec3d in_world(const Mat4d& matrix, const Vec3d (&normal)[3] = kNormal) {
  const Mat3d turn = glm::transpose(glm::inverse(Mat3d(matrix)));
  Vec3d sum(0.0);
  const double weight[3] = {1.0 - kU - kV, kU, kV};
  for (int k = 0; k < 3; ++k) {
    const Vec3d n = turn * normal[k];
    if (n != Vec3d(0.0)) sum += weight[k] * glm::normalize(n);
  }
  return glm::normalize(sum);
}
Vec3d in_own_space(const Mat4d& matrix) {
  const Vec3d n = (1.0 - kU - kV) * kNormal[0] + kU * kNormal[1] + kV * kNormal[2];
  return glm::normalize(glm::transpose(glm::inverse(Mat3d(matrix))) * n);
}

/// Where a ray from above meets the triangle of instance 0 at (kU, kV).
SurfacePoint point_of(const Scene& scene, const Mat4d& matrix, float time = 0.0f,
                      double distance = 1.0) {
  const Vec3d local = kCorner[0] + kU * (kCorner[1] - kCorner[0]) + kV * (kCorner[2] - kCorner[0]);
  const Mat3d linear(matrix);
  const Vec3d outside =
      glm::normalize(glm::transpose(glm::inverse(linear)) *
                     glm::cross(kCorner[1] - kCorner[0], kCorner[2] - kCorner[0]));
  Ray ray;
  ray.origin = Vec3(Vec3d(matrix * glm::dvec4(local, 1.0)) + distance * outside - scene.origin());
  ray.direction = Vec3(-outside);
  ray.time = time;
  const Hit hit = intersect_scalar(scene.view(), ray);
  EXPECT_TRUE(hit.valid());
  EXPECT_NEAR(double{hit.u}, kU, 1e-4);
  const SurfacePoint point = surface_point(scene.view(), hit, ray);
  EXPECT_LT(glm::length(Vec3d(point.geometric_normal) - outside), 1e-6);
  return point;
}

double apart(const SurfacePoint& point, const Vec3d& normal) {
  return glm::length(Vec3d(point.normal) - normal);
}

std::shared_ptr<Scene> triangle_scene(const Mat4d& matrix, const Polygons& p = bent_triangle()) {
  return make_scene({{p.mesh(), matrix}}, camera_at({9, 0, 0}, {0, 0, 0}, 4, 4));
}

/// Puts mesh 0 somewhere else too.
void put_again(Scene& scene, std::uint32_t mask) {
  const InstanceInput instance{0, translated(50, 0, 0), 0, mask};
  scene.add_instances({&instance, 1}, "again");
}

TEST(StretchedNormals, OfAMeshUsedOnceAreInterpolatedInTheWorld) {
  for (const Mat4d& matrix : {kStretched, kMirrored, kSheared}) {
    const auto scene = committed(triangle_scene(matrix));
    ASSERT_GT(glm::length(in_world(matrix) - in_own_space(matrix)), 0.01);
    EXPECT_LT(apart(point_of(*scene, matrix), in_world(matrix)), 1e-6);
  }
}

TEST(StretchedNormals, OfASharedMeshAreInterpolatedInItsOwnSpace) {
  for (const Mat4d& matrix : {kStretched, kMirrored, kSheared}) {
    const auto scene = triangle_scene(matrix);
    put_again(*scene, kMaskAll);
    EXPECT_LT(apart(point_of(*committed(scene), matrix), in_own_space(matrix)), 1e-6);
  }
}

TEST(StretchedNormals, WhatNoRaySeesIsNoUser) {
  const auto scene = triangle_scene(kSheared);
  put_again(*scene, 0);
  EXPECT_LT(apart(point_of(*committed(scene), kSheared), in_world(kSheared)), 1e-6);
}

TEST(StretchedNormals, OfWhatMovesAreInterpolatedInItsOwnSpace) {
  auto scene = std::make_shared<Scene>();
  scene->set_camera(camera_at({9, 0, 0}, {0, 0, 0}, 4, 4));
  const auto way = [](double t) { return translated(0, 0, 0.5 * t) * kSheared; };
  add_moving(*scene, bent_triangle().mesh(), way, 3);
  EXPECT_LT(apart(point_of(*committed(scene), kSheared), in_own_space(kSheared)), 1e-5);
}

TEST(StretchedNormals, WhereShapesAreKeptBothRulesAreOne) {
  const Mat4d turned = glm::rotate(translated(3, -2, 1), 0.7, Vec3d(1, 2, -1));
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const Vec3d& size : {Vec3d(scale), Vec3d(-scale, scale, scale)}) {
      const Mat4d matrix = glm::scale(turned, size);
      const auto scene = committed(triangle_scene(matrix));
      EXPECT_EQ(scene->view().meshes[0].stretched, 0u);
      EXPECT_LT(apart(point_of(*scene, matrix, 0.0f, scale), in_world(matrix)), 1e-6);
      EXPECT_LT(glm::length(in_world(matrix) - in_own_space(matrix)), 1e-12);
    }
  }
  const Mat4d hardly = glm::scale(turned, Vec3d(1.0, 1.0, 1.0 + 1e-4));
  EXPECT_EQ(committed(triangle_scene(hardly))->view().meshes[0].stretched, 1u);
}

TEST(StretchedNormals, ANullNormalHasNoSay) {
  Polygons p = bent_triangle();
  Vec3d normals[3] = {kNormal[0], Vec3d(0.0), kNormal[2]};
  for (std::size_t c = 3; c < 6; ++c) p.corner2normal[c] = 0.0f;
  const auto scene = committed(triangle_scene(kSheared, p));
  EXPECT_LT(apart(point_of(*scene, kSheared), in_world(kSheared, normals)), 1e-6);
  std::fill(p.corner2normal.begin(), p.corner2normal.end(), 0.0f);
  const SurfacePoint flat = point_of(*committed(triangle_scene(kSheared, p)), kSheared);
  EXPECT_EQ(flat.normal, flat.geometric_normal);
}

TEST(StretchedNormals, OfAMeshThatDeformsGoToTheWorldBeforeTimeIsInterpolated) {
  const auto mesh = deforming(bent_triangle(), 2, [](const Vec3d& p, double) { return p; });
  const auto scene = committed(make_scene({{mesh, kSheared}}, camera_at({9, 0, 0}, {}, 4, 4)));
  const Mat3d turn = glm::transpose(glm::inverse(Mat3d(kSheared)));
  const double weight[3] = {1.0 - kU - kV, kU, kV};
  Vec3d sum(0.0);
  for (int k = 0; k < 3; ++k) {  // deforming() tilts them by half the time
    const Vec3d from = glm::normalize(turn * glm::normalize(kNormal[k] + Vec3d(0, 0.25, 0)));
    const Vec3d to = glm::normalize(turn * glm::normalize(kNormal[k] + Vec3d(0, 0.5, 0)));
    sum += weight[k] * (0.5 * from + 0.5 * to);
  }
  EXPECT_LT(apart(point_of(*scene, kSheared, 0.75f), glm::normalize(sum)), 1e-6);
}

TEST(StretchedNormals, AMeshScaledToAPlateIsFlat) {
  const Mat4d plate = glm::scale(Mat4d(1.0), Vec3d(1, 1, 0));
  const auto scene = committed(triangle_scene(plate));
  const InstanceView& instance = scene->view().instances[0];
  EXPECT_EQ(scene->view().meshes[instance.mesh].normals, nullptr);
  EXPECT_EQ(scene->view().meshes[instance.mesh].stretched, 0u);
}

}  // namespace
}  // namespace komorebi::testing
