// Named arrays on meshes, curves and points: what a hit finds of them.
#include "core/attribute.h"

#include <gtest/gtest.h>

#include <limits>

#include "bvh/traverse.h"
#include "support/made_curves.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

glm::vec4 at(const Mesh& mesh, const char* name, std::uint32_t primitive, float u, float v) {
  const MeshView view = mesh.view();
  const AttributeView* attribute = find_attribute(view, name);
  if (attribute == nullptr) {
    ADD_FAILURE() << name;
    return {};
  }
  return attribute_at(view, *attribute, primitive, u, v);
}

std::shared_ptr<const Mesh> built(const MeshInput& input, const Mesh* same = nullptr) {
  return Mesh::build(input, Builder::kLinear, shared_pool(), Cancel(), same);
}

/// A linear function of the place, of a vertex, a corner and, at its middle, a face.
constexpr double kSlopes[3] = {0.5, -2.0, 3.0};
float slope(const float* p) {
  return float(1.0 + kSlopes[0] * double{p[0]} + kSlopes[1] * double{p[1]} +
               kSlopes[2] * double{p[2]});
}

TEST(Attributes, AreThemselvesBetweenCornersForEveryHit) {
  const Polygons ball = sphere(9, Vec3d(0.0), 1.0, false);
  const std::size_t faces = ball.face_offsets.size() - 1;
  std::vector<float> by_vertex, by_corner, by_face;
  for (std::size_t v = 0; v < ball.vtx2xyz.size(); v += 3) {
    by_vertex.push_back(slope(&ball.vtx2xyz[v]));
  }
  for (const std::int32_t v : ball.corner2vtx) {  // the place itself, and its sign
    const float* p = &ball.vtx2xyz[3 * std::size_t(v)];
    by_corner.insert(by_corner.end(), {p[0], p[1], p[2], -1.0f});
  }
  for (std::size_t f = 0; f < faces; ++f) by_face.insert(by_face.end(), {float(f), 7.0f});
  MeshInput input = ball.input();
  input.attributes = {{"slope", AttributeDomain::kVertex, 1, by_vertex},
                      {"place", AttributeDomain::kCorner, 4, by_corner},
                      {"face", AttributeDomain::kFace, 2, by_face}};
  const auto mesh = built(input);
  EXPECT_TRUE(mesh->attributes()->warnings().empty());
  const auto again = built(input, mesh.get());
  const auto other_tree = mesh->rebuilt(Builder::kSah, shared_pool(), Cancel());
  const auto flat =
      mesh->flattened(glm::scale(Mat4d(1.0), Vec3d(1, 1, 0)), shared_pool(), Cancel());
  const auto scene = committed(make_scene({{mesh}}, camera_at({3, 0, 0}, {0, 0, 0}, 8, 8)));
  int met = 0;
  for (int i = 0; i < 400; ++i) {
    Ray ray;
    ray.origin = Vec3(-scene->origin());
    ray.direction = Vec3(std::sin(float(i)), std::cos(1.7f * float(i)), std::sin(0.3f * float(i)));
    const Hit hit = intersect_scalar(scene->view(), ray);
    if (!hit.valid()) continue;
    ++met;
    const Vec3 p = hit.t * ray.direction;
    const float xyz[3] = {p.x, p.y, p.z};
    for (const auto& same : {mesh, again, other_tree, flat}) {
      const auto place = at(*same, "place", hit.primitive, hit.u, hit.v);
      EXPECT_LT(glm::length(Vec3(place) - p), 1e-5f);
      EXPECT_NEAR(place.w, -1.0f, 1e-6f);
      const auto sloping = at(*same, "slope", hit.primitive, hit.u, hit.v);
      EXPECT_NEAR(sloping.x, slope(xyz), 1e-5f);
      EXPECT_EQ(Vec3(sloping), Vec3(sloping.x));
      EXPECT_EQ(sloping.w, 1.0f);
      EXPECT_EQ(at(*same, "face", hit.primitive, hit.u, hit.v),
                glm::vec4(float(hit.primitive / 2), 7.0f, 0.0f, 1.0f));
    }
  }
  EXPECT_GT(met, 300);
  EXPECT_EQ(find_attribute(mesh->view(), "slop"), nullptr);
  EXPECT_EQ(find_attribute(mesh->view(), "slopes"), nullptr);
}

TEST(Attributes, OfTrianglesThatBlenderHasCut) {
  Polygons pentagon;  // its corner 0 belongs to the last triangle alone
  for (int i = 0; i < 5; ++i) pentagon.vertex({std::cos(1.2 * i), std::sin(1.2 * i), 0});
  pentagon.face({0, 1, 2, 3, 4});
  const std::vector<std::int32_t> tri2corner = {1, 2, 3, 1, 3, 4, 1, 4, 0}, tri2face = {0, 0, 0};
  const std::vector<float> corners = {10, 11, 12, 13, 14}, face = {3};
  MeshInput input = pentagon.input();
  input.tri2corner = tri2corner;
  input.tri2face = tri2face;
  input.attributes = {{"corner", AttributeDomain::kCorner, 1, corners},
                      {"face", AttributeDomain::kFace, 1, face}};
  const auto mesh = built(input);
  for (std::uint32_t t = 0; t < 3; ++t) {
    EXPECT_EQ(at(*mesh, "corner", t, 0, 0).x, corners[std::size_t(tri2corner[3 * t])]);
    EXPECT_EQ(at(*mesh, "corner", t, 1, 0).x, corners[std::size_t(tri2corner[3 * t + 1])]);
    EXPECT_EQ(at(*mesh, "corner", t, 0, 1).x, corners[std::size_t(tri2corner[3 * t + 2])]);
    EXPECT_EQ(at(*mesh, "face", t, 0.2f, 0.3f).x, 3.0f);
  }
}

TEST(Attributes, OfCurvesAndPoints) {
  Curves curves;
  std::vector<float> by_key, by_curve;
  for (const int keys : {2, 4, 3}) {
    for (int k = 0; k < keys; ++k) {
      by_key.push_back(float(10 * keys + k));
      curves.key(Vec3d(keys, k, 0), 0.1);
    }
    curves.end_curve();
    by_curve.insert(by_curve.end(), {float(keys), 0.0f, 1.0f});
  }
  CurvesInput input = curves.input();
  input.attributes = {{"key", AttributeDomain::kVertex, 1, by_key},
                      {"curve", AttributeDomain::kFace, 3, by_curve}};
  const auto mesh = Mesh::build(input, Builder::kLinear, shared_pool(), Cancel());
  const float of_segment[] = {20, 40, 41, 42, 30, 31};
  ASSERT_EQ(mesh->primitive_count(), 6u);
  for (std::uint32_t s = 0; s < 6; ++s) {
    EXPECT_EQ(at(*mesh, "key", s, 0.25f, 0.9f).x, of_segment[s] + 0.25f);
    EXPECT_EQ(at(*mesh, "curve", s, 0.5f, 0.0f).x, std::floor(of_segment[s] / 10.0f));
  }
  PointsInput cloud{"cloud", curves.xyz, curves.radius};
  cloud.attributes = {{"key", AttributeDomain::kVertex, 1, by_key}};
  const auto points = Mesh::build(cloud, Builder::kLinear, shared_pool(), Cancel());
  for (std::uint32_t p = 0; p < 9; ++p) EXPECT_EQ(at(*points, "key", p, 0, 0).x, by_key[p]);
}

TEST(Attributes, WhatIsNotFiniteIsCountedAndWhatDoesNotFitRefused) {
  const Polygons square = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  MeshInput input = square.input("sheet");
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> bad = {1, inf, 2, std::numeric_limits<float>::quiet_NaN()};
  input.attributes = {{"hot", AttributeDomain::kVertex, 1, bad}};
  const auto mesh = built(input);
  ASSERT_EQ(mesh->attributes()->warnings().size(), 1u);
  EXPECT_EQ(mesh->attributes()->warnings()[0],
            "mesh \"sheet\": attribute \"hot\" has 2 numbers that are not finite and taken for 0");
  EXPECT_EQ(at(*mesh, "hot", 0, 1, 0).x, 0.0f);
  EXPECT_EQ(at(*mesh, "hot", 0, 0, 1).x, 2.0f);
  const auto refused = [&](const std::vector<AttributeInput>& attributes, const char* sentence) {
    input.attributes = attributes;
    try {
      built(input);
      ADD_FAILURE() << sentence;
    } catch (const std::invalid_argument& error) {
      EXPECT_STREQ(error.what(), sentence);
    }
  };
  refused({{"x", AttributeDomain::kFace, 1, bad}},
          "mesh \"sheet\": attribute \"x\" must have one row a face");
  refused({{"x", AttributeDomain::kVertex, 2, bad}},
          "mesh \"sheet\": attribute \"x\" must have one row a vertex");
  refused({{"x", AttributeDomain::kVertex, 5, bad}},
          "mesh \"sheet\": attribute \"x\" must have one to four components");
  refused({{"x", AttributeDomain::kVertex, 1, bad}, {"x", AttributeDomain::kCorner, 1, bad}},
          "mesh \"sheet\": attribute \"x\" comes twice");
}

}  // namespace
}  // namespace komorebi::testing
