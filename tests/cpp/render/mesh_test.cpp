#include "render/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "support/scenes.h"

namespace komorebi::testing {
namespace {

/// The sentence with which a mesh is refused; empty if it is taken.
std::string refusal(const MeshInput& input) {
  try {
    Mesh::build(input, Builder::kLinear, shared_pool(), Cancel());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(MeshCheck, NamesTheMeshAndTheCount) {
  Polygons p = box(Vec3d(-1), Vec3d(1));
  EXPECT_EQ(refusal(p.input("Cube")), "");

  Polygons nan = p;
  nan.vtx2xyz[4] = std::numeric_limits<float>::quiet_NaN();
  nan.vtx2xyz[9] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(refusal(nan.input("Tree.003")), "mesh \"Tree.003\": 2 vertices are not finite");

  Polygons stray = p;
  stray.corner2vtx[5] = 8;
  EXPECT_EQ(refusal(stray.input("Cube")),
            "mesh \"Cube\": 1 corner names a vertex that is not there");
  stray.corner2vtx[5] = -1;
  EXPECT_NE(refusal(stray.input("Cube")), "");

  Polygons thin = p;
  thin.face_offsets[1] = 2;
  EXPECT_NE(refusal(thin.input("Cube")).find("fewer than three corners"), std::string::npos);
  thin.face_offsets = {0, 2147483647, -2147483647, 24};
  EXPECT_NE(refusal(thin.input("Cube")), "");
  thin.face_offsets = {0, 4};
  EXPECT_NE(refusal(thin.input("Cube")).find("number of corners, 24"), std::string::npos);

  Polygons pentagon;
  for (int i = 0; i < 5; ++i) pentagon.vertex({std::cos(1.2566 * i), std::sin(1.2566 * i), 0});
  pentagon.face({0, 1, 2, 3, 4});
  EXPECT_NE(refusal(pentagon.input()).find("more than four corners"), std::string::npos);
  MeshInput given = pentagon.input();
  const std::vector<std::int32_t> tri2corner{0, 1, 2, 0, 2, 3, 0, 3, 4}, tri2face{0, 0, 0};
  given.tri2corner = tri2corner;
  given.tri2face = tri2face;
  EXPECT_EQ(refusal(given), "");
  const std::vector<std::int32_t> bad_corner{0, 1, 2, 0, 2, 3, 0, 3, 5}, bad_face{0, 1, 0};
  given.tri2corner = bad_corner;
  EXPECT_NE(refusal(given).find("1 triangle corner is out of range"), std::string::npos);
  given.tri2corner = tri2corner;
  given.tri2face = bad_face;
  EXPECT_NE(refusal(given).find("names a face that is not there"), std::string::npos);
}

TEST(Mesh, EmptyIsFine) {
  const Polygons nothing;
  const auto mesh = nothing.mesh();
  EXPECT_EQ(mesh->triangle_count(), 0u);
  const auto scene = committed(make_scene({{mesh}}, camera_at({3, 0, 0}, Vec3d(0), 16, 16)));
  Settings settings;
  settings.samples = 1;
  for (const float v : render(scene, settings)) EXPECT_EQ(v, 1.0f);  // the white world
}

TEST(Mesh, MovesTowardsItsOriginOnlyIfThatIsExact) {
  const auto far = box(Vec3d(8192.0), Vec3d(8194.0)).mesh();
  EXPECT_EQ(far->origin(), Vec3d(8192.0));
  const auto around = box(Vec3d(-3.0), Vec3d(1e4)).mesh();
  EXPECT_EQ(around->origin(), Vec3d(0.0));
  const auto uneven = box(Vec3d(1e-4), Vec3d(1e5, 1.0, 1.0)).mesh();  // 1e5 − 1e-4 is no float
  EXPECT_EQ(uneven->origin(), Vec3d(0.0));
  EXPECT_EQ(uneven->view().vtx2xyz[0], 1e-4f);
}

TEST(Triangulate, FlipsTheDiagonalOfAConcaveQuad) {
  Polygons kite;  // corner 0 is the notch's tip: the diagonal 0–2 would lie outside
  kite.vertex({0, 0, 0});
  kite.vertex({2, -1, 0});
  kite.vertex({-1, 0, 0});
  kite.vertex({2, 1, 0});
  kite.face({0, 1, 2, 3});
  Polygons dart = kite;
  dart.corner2vtx = {1, 2, 3, 0};
  EXPECT_EQ(kite.mesh()->tri2corner(), (std::vector<std::int32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(dart.mesh()->tri2corner(), (std::vector<std::int32_t>{0, 1, 3, 1, 2, 3}));
}

TEST(Mesh, NormalsByVertexAreThoseByCorner) {
  const Polygons by_corner = sphere(12, Vec3d(0), 1.0, true);
  std::vector<float> vtx2normal(by_corner.vtx2xyz.size());
  for (std::size_t c = 0; c < by_corner.corner2vtx.size(); ++c) {
    const auto v = static_cast<std::size_t>(by_corner.corner2vtx[c]);
    std::copy_n(&by_corner.corner2normal[3 * c], 3, &vtx2normal[3 * v]);
  }
  MeshInput in = by_corner.input();
  in.corner2normal = {};
  in.vtx2normal = vtx2normal;
  const auto camera = camera_at({0, 0, 3}, Vec3d(0), 24, 24);
  Settings settings;
  settings.samples = 2;
  const auto picture = [&](const std::shared_ptr<const Mesh>& mesh) {
    return render(committed(make_scene({{mesh}}, camera)), settings);
  };
  const auto expected = picture(by_corner.mesh());
  EXPECT_EQ(picture(Mesh::build(in, Builder::kLinear, shared_pool(), Cancel())), expected);
  in.vtx2normal = {};
  EXPECT_NE(picture(Mesh::build(in, Builder::kLinear, shared_pool(), Cancel())), expected);
  std::fill(vtx2normal.begin(), vtx2normal.end(), std::numeric_limits<float>::quiet_NaN());
  const auto flat = picture(Mesh::build(in, Builder::kLinear, shared_pool(), Cancel()));
  in.vtx2normal = vtx2normal;
  EXPECT_EQ(picture(Mesh::build(in, Builder::kLinear, shared_pool(), Cancel())), flat);
}

TEST(Triangulate, MixedFacesKeepTheirOrder) {
  Polygons p = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  p.face({0, 1, 2});
  p.face({0, 1, 2, 3});
  EXPECT_EQ(p.mesh()->tri2corner(),
            (std::vector<std::int32_t>{0, 1, 2, 0, 2, 3, 4, 5, 6, 7, 8, 9, 7, 9, 10}));
  const std::vector<std::int32_t> materials{0, 3, 5};
  MeshInput in = p.input();
  in.face2material = materials;
  const auto mesh = Mesh::build(in, Builder::kLinear, shared_pool(), Cancel());
  const std::uint16_t* slots = mesh->view().tri2material;
  EXPECT_EQ(std::vector<int>(slots, slots + 5), (std::vector<int>{0, 0, 3, 5, 5}));
}

TEST(Mesh, DegenerateTrianglesKeepTheirIndex) {
  Polygons p = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  p.face({0, 1, 1});
  p.face({1, 2, 3});
  const auto mesh = p.mesh();
  EXPECT_EQ(mesh->triangle_count(), 4u);
  EXPECT_EQ(mesh->degenerate_count(), 1u);
  EXPECT_EQ(mesh->tri2corner()[9], 7);
}

TEST(Scene, FlatInstancesAreSeenAndLinesAreNot) {
  const auto ball = sphere(16, Vec3d(0), 1.0, false).mesh();
  const auto camera = camera_at({0, 0, 5}, Vec3d(0), 64, 64);
  const auto covered = [&](const Vec3d& scale) {
    const auto scene = make_scene({{ball, glm::scale(Mat4d(1.0), scale)}}, camera, Vec3(0.0f));
    committed(scene);
    Settings settings;
    settings.samples = 4;
    settings.film_transparent = true;
    double alpha = 0.0;
    const auto picture = render(scene, settings);
    for (std::size_t i = 3; i < picture.size(); i += 4) alpha += picture[i];
    return std::pair(alpha, scene->invisible_count());
  };
  const auto [round_area, none] = covered({1, 1, 1});
  const auto [flat_area, none_either] = covered({1, 1, 0});
  EXPECT_GT(flat_area, 0.9 * round_area * 24.0 / 25.0);  // the outline of the ball, seen from 5
  EXPECT_EQ(none + none_either, 0u);
  const auto [line_area, invisible] = covered({1, 0, 0});
  EXPECT_EQ(line_area, 0.0);
  EXPECT_EQ(invisible, 1u);
}

TEST(Scene, RefusesBadMatricesByName) {
  Scene scene;
  InstanceInput instance;
  instance.mesh = scene.add_mesh(quad(Vec3d(0), {1, 0, 0}, {0, 1, 0}).mesh());
  instance.world_from_object[3][1] = std::numeric_limits<double>::quiet_NaN();
  try {
    scene.add_instances({&instance, 1}, "Lamp post");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "instances of \"Lamp post\": 1 matrix is not finite or not affine");
  }
  EXPECT_THROW(scene.set_world_color(Vec3(-1.0f)), std::invalid_argument);
}

TEST(Scene, TenThousandCopiesStoreTheMeshOnce) {
  const auto ball = sphere(64, Vec3d(0), 1.0, false).mesh();
  Scene scene;
  std::vector<InstanceInput> copies(10000);
  const auto index = scene.add_mesh(ball);
  for (std::size_t i = 0; i < copies.size(); ++i) {
    const Vec3d at(3.0 * static_cast<double>(i % 100), 3.0 * static_cast<double>(i / 100), 0);
    copies[i] = {index, glm::translate(Mat4d(1.0), at), 0, kMaskAll, 0};
  }
  scene.add_instances(copies, "balls");
  scene.commit(shared_pool(), Cancel());
  EXPECT_LT(scene.byte_count(), ball->byte_count() + 10000 * 600);
  EXPECT_EQ(scene.triangle_count(), 10000ull * ball->triangle_count());
}

}  // namespace
}  // namespace komorebi::testing
