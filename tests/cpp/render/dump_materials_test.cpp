// Dumps of scenes with materials: programs, textures, attributes, what is cut out.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "io/array_file.h"
#include "render/dump.h"
#include "support/made_curves.h"
#include "support/materials.h"
#include "support/scenes.h"
#include "texture/texture.h"

namespace komorebi::testing {
namespace {

class DumpMaterials : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() / "komorebi_dump_materials.komorebi").string();
  }
  void TearDown() override { std::remove(path_.c_str()); }
  std::string bytes() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string path_;
};

std::shared_ptr<const Texture> picture(unsigned red) {
  Texels texels;
  texels.width = texels.height = 4;
  texels.channels = 4;
  texels.data.reset(new std::byte[64]);
  for (unsigned i = 0; i < 64; ++i) {
    texels.data[i] = std::byte(i % 4 == 3 ? 255 : i % 4 == 0 ? red : 3 * i);
  }
  TextureColor color;
  color.srgb = true;
  return std::make_shared<const Texture>("picture", std::move(texels), color, shared_pool());
}

/// Asks for attributes, instances' random numbers, tiles of a picture and a ramp; a quarter of it
/// is let through, and light passes to the other side.
Material coloured(const std::string& attribute) {
  MadeProgram made;
  const auto tiles = std::make_shared<const Texture>(
      "tiles", std::vector<Texture::Tile>{{1001, picture(200)}, {1002, picture(20)}});
  const auto found = made.attribute(attribute), random = made.input("object_random", 1);
  const auto at = made.each("multiply", {found[0], found[1]}, MadeProgram::number(2));
  const auto texel = made.op({"image", {}, {0, 0, 0}, {}, "", tiles}, 4, {at, made.number(0)});
  const auto ramp =
      made.op({"ramp", {}, {0}, {0, 0.25f, 0.5f, 1, 1, 1, 0, 1}, "", nullptr}, 4, {{found[2]}});
  const auto color = made.each("add", {texel[0], texel[1], texel[2]}, {ramp[0], ramp[1], ramp[2]});
  Material material;
  material.camera = SurfaceProgram(made.program({made.color(0, 0, 0),
                                                 made.color(0.25, 0.25, 0.25),
                                                 made.number(0),
                                                 color,
                                                 made.input("normal"),
                                                 {random[0], random[0], found[1]}}),
                                   {{false, true}, {true, false}});
  material.bounce = even_material({0.5, 0.25, 0.125}).camera;
  material.clear = MadeProgram().program({made.color(0.25, 0.25, 0.25)});
  return material;
}

std::vector<float> rows(std::size_t count) {
  std::vector<float> made;
  for (std::size_t i = 0; i < 3 * count; ++i) made.push_back(static_cast<float>(i % 17) / 17.0f);
  return made;
}

std::shared_ptr<Scene> scene() {
  const Polygons ball = sphere(8, {0, 0, 1}, 1.0, true);
  const std::size_t corners = ball.input().corner2vtx.size();
  const auto by_vertex = rows(ball.input().vtx2xyz.size() / 3), by_corner = rows(corners);
  const auto by_face = rows(ball.input().face_offsets.size() - 1);
  MeshInput input = ball.input("ball");
  input.attributes = {{"vertex", AttributeDomain::kVertex, 3, by_vertex},
                      {"corner", AttributeDomain::kCorner, 3, by_corner},
                      {"face", AttributeDomain::kFace, 3, by_face}};
  const auto ball_mesh = Mesh::build(input, Builder::kLinear, shared_pool(), Cancel());

  Curves fur = made_fur(30, 3, 0.5, 0.02, 2.0, CurveShape::kThick);
  fur.key({0, 0, 0}, 0.1);  // a curve without a segment
  fur.end_curve();
  const std::size_t curves = fur.input("fur").curve_offsets.size() - 1;
  const auto by_key = rows(fur.radius.size()), by_curve = rows(curves);
  std::vector<std::int32_t> slots(curves);
  for (std::size_t i = 0; i < curves; ++i) slots[i] = static_cast<std::int32_t>(i % 2);
  CurvesInput strands = fur.input("fur");
  strands.curve2material = slots;
  strands.attributes = {{"vertex", AttributeDomain::kVertex, 3, by_key},
                        {"face", AttributeDomain::kFace, 3, by_curve}};
  const auto hair = Mesh::build(strands, Builder::kLinear, shared_pool(), Cancel());

  PointsInput spheres{"points", {}, {}};
  const std::vector<float> at = {0, 0, 0, 1, 0, 0}, radius = {0.4f, 0.3f}, by_point = rows(2);
  spheres.point2xyz = at;
  spheres.point2radius = radius;
  spheres.attributes = {{"vertex", AttributeDomain::kVertex, 3, by_point}};
  const auto points = Mesh::build(spheres, Builder::kLinear, shared_pool(), Cancel());

  auto made = std::make_shared<Scene>();
  const auto there = [](double x, double y) {
    return glm::translate(Mat4d(1.0), Vec3d(x, y, 0.4));
  };
  const InstanceInput instances[] = {
      {made->add_mesh(ball_mesh), Mat4d(1.0), 0, kMaskAll, 0, 0},
      {0, there(-2.2, 0), 1, kMaskAll, 0, 1},
      {0, there(2.2, 0), 0, kMaskAll, 0, 2},
      {made->add_mesh(hair), there(0, -2), 0, kMaskAll, 0, 3},
      {made->add_mesh(points), there(1.5, -2), 0, kMaskAll, 0, 0},
      {made->add_mesh(quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh()), Mat4d(1.0), 0, kMaskAll, 0,
       4}};
  made->add_instances(instances, "test");
  SceneTables tables;
  tables.objects.resize(2);
  tables.objects[1].color = Vec3(0.5f, 0.25f, 0.75f);
  tables.materials.resize(4);
  tables.materials[1].pass_index = 3.0f;
  tables.slot_begin = {0, 1, 2, 3, 5, 6};
  tables.slots = {0, 1, 2, 0, 2, 3};
  made->set_tables(std::move(tables));
  made->set_surfaces(
      {coloured("vertex"), coloured("corner"), coloured("face"), even_material({0.3, 0.6, 0.2})},
      {0.1f, 0.9f, 0.5f, 0.2f, 0.8f, 0.4f});
  MadeProgram sky;
  const auto up = sky.input("position");
  made->set_world_color(Vec3(0.8f));
  made->set_world_program(sky.program({up}), 2.0f);
  made->set_camera(camera_at({1, -7, 4}, {0, 0, 0.5}, 60, 40));
  return made;
}

Settings settings() {
  Settings s;
  s.method = Method::kWorldLight;
  s.samples = 4;
  s.bounces = 2;
  return s;
}

TEST_F(DumpMaterials, RenderTheSamePicture) {
  const auto original = committed(scene());
  const std::vector<float> picture = render(original, settings());
  auto clay = scene();
  clay->set_surfaces(std::vector<Material>(4), {});
  EXPECT_NE(render(committed(clay), settings()), picture);
  write_dump(path_, *original, settings());
  const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
  EXPECT_EQ(render(committed(read.scene), read.settings), picture);
}

TEST_F(DumpMaterials, OfADumpAreTheSameFile) {
  write_dump(path_, *scene(), settings());
  const std::string first = bytes();
  const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
  write_dump(path_, *read.scene, read.settings);
  EXPECT_EQ(bytes(), first);
}

TEST_F(DumpMaterials, ThatAreDamagedAreRefused) {
  write_dump(path_, *scene(), settings());
  const ArrayFile good = ArrayFile::read(path_);
  const std::vector<std::uint32_t> none;
  for (const char* name : {"texture/0/header", "program/0/sizes", "program/1/operands",
                           "program/1/numbers", "material/lobes", "texture/2/tiles"}) {
    ASSERT_TRUE(good.has(name)) << name;
    ArrayFile bad = good;
    if (std::string(name) == "program/1/numbers") {
      bad.put<float>(name, {}, {0});
    } else if (std::string(name) == "texture/2/tiles") {
      const std::uint32_t itself[] = {1001, 3};
      bad.put<std::uint32_t>(name, itself, {1, 2});
    } else if (std::string(name) == "material/lobes") {
      bad.put<std::uint8_t>(name, {}, {0, 2});
    } else {
      bad.put<std::uint32_t>(name, none, {0});
    }
    bad.write(path_);
    EXPECT_ANY_THROW(read_dump(path_, shared_pool(), Cancel())) << name;
  }
}

}  // namespace
}  // namespace komorebi::testing
