#include "render/dump.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>

#include "io/array_file.h"
#include "support/made_curves.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

class Dump : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = (std::filesystem::temp_directory_path() /
             ("komorebi_dump_" + std::string(test->name()) + ".komorebi"))
                .string();
  }
  void TearDown() override { std::remove(path_.c_str()); }

  static std::shared_ptr<Scene> scene() {
    const auto ball = sphere(12, {4000, 0, 1}, 1.0, true).mesh();
    const auto ground = quad({3990, -9, 0}, {20, 0, 0}, {0, 18, 0}).mesh();
    Curves fur = made_fur(30, 3, 0.5, 0.02, 2.0, CurveShape::kThick);
    for (int alone = 0; alone < 2; ++alone) {  // curves of one key are kept, though not drawn
      fur.key({0, 0, 0}, 0.1);
      fur.end_curve();
    }
    fur.shape = CurveShape::kRibbon;
    CurvesInput input = fur.input("fur");
    input.subdivisions = 1;
    const auto hair = Mesh::build(input, Builder::kLinear, shared_pool(), Cancel());
    const std::vector<float> at = {0, 0, 0, 1, 0, 0}, radius = {0.2f, 0.1f};
    const auto points =
        Mesh::build(PointsInput{"two", at, radius}, Builder::kLinear, shared_pool(), Cancel());
    const Mat4d there = glm::translate(Mat4d(1.0), Vec3d(4001, 0, 1.5));
    auto made = make_scene(
        {{ground}, {ball, glm::scale(Mat4d(1.0), Vec3d(1, -1, 1))}, {hair, there}, {points, there}},
        camera_at({4005, -4, 3}, {4000, 0, 0.5}, 40, 30));
    std::vector<float> texels(3 * 16 * 8, 0.25f);
    texels[100] = 50.0f;
    const Mat3d turn(glm::rotate(Mat4d(1.0), 0.5, Vec3d(0, 0, 1)));
    made->set_world_environment(std::make_shared<Environment>("sky", 16, 8, texels), 1.5, turn);
    return made;
  }

  static Settings settings() {
    Settings s;
    s.method = Method::kWorldLight;
    s.samples = 4;
    s.clay_color = Vec3(0.7f, 0.6f, 0.5f);
    s.bounces = 2;
    s.world_max_bounces = 1;
    s.use_fast_gi = true;
    s.fast_gi_method = FastGiMethod::kAdd;
    s.fast_gi_bounces = 5;
    s.fast_gi_distance = 0.75f;
    s.fast_gi_factor = 0.5f;
    s.sample_clamp_direct = 3.0f;
    s.sample_clamp_indirect = 0.25f;
    s.has_region = true;
    s.region = {2, 3, 38, 27};
    return s;
  }

  std::string bytes() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

  std::string path_;
};

TEST_F(Dump, RendersTheSamePicture) {
  const auto original = committed(scene());
  write_dump(path_, *original, settings());
  const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
  EXPECT_EQ(render(committed(read.scene), read.settings), render(original, settings()));
}

TEST_F(Dump, KeepsShadowTerminators) {
  const auto with = [](float cutoff, float frequency) {
    auto made = scene();
    SceneTables tables;
    tables.objects.resize(1);
    tables.objects[0].terminator_cutoff = cutoff;
    tables.objects[0].terminator_frequency = frequency;
    made->set_tables(tables);
    return committed(made);
  };
  const auto plain = render(with(0.0f, 1.0f), settings());
  for (const auto& [cutoff, frequency] : {std::pair(0.4f, 1.0f), {0.0f, 1.3f}, {0.4f, 1.3f}}) {
    const auto original = with(cutoff, frequency);
    const auto picture = render(original, settings());
    write_dump(path_, *original, settings());
    const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
    EXPECT_EQ(render(committed(read.scene), read.settings), picture);
    EXPECT_NE(picture, plain);
  }
}

TEST_F(Dump, OfADumpIsTheSameFile) {
  write_dump(path_, *scene(), settings());
  const std::string first = bytes();
  const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
  write_dump(path_, *read.scene, read.settings);
  EXPECT_EQ(bytes(), first);
}

TEST_F(Dump, KeepsLensPanoramaAndEye) {
  const auto original = scene();
  CameraDesc camera = original->camera_desc();
  camera.lens = {0.1, 5, 0.3, 1.2, 4.0};
  camera.stereo = {-0.03, 2.0, 1.0, 1.2};
  const auto check = [&] {
    original->set_camera(camera);
    write_dump(path_, *original, settings());
    const std::string first = bytes();
    const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
    EXPECT_EQ(read.scene->camera_desc().lens.ratio, 1.2);
    EXPECT_EQ(read.scene->camera_desc().stereo.pole_merge_angle_to, 1.2);
    EXPECT_EQ(read.scene->camera_desc().panorama.polynomial[4],
              camera.kind == CameraKind::kPanorama ? 0.5 : 0.0);
    write_dump(path_, *read.scene, read.settings);
    EXPECT_EQ(bytes(), first);
  };
  check();
  camera.kind = CameraKind::kPanorama;
  camera.world_from_camera[3] = glm::dvec4(4005, -4, 3, 1);
  camera.panorama.kind = PanoramaKind::kFisheyePolynomial;
  camera.panorama.polynomial[4] = 0.5;
  check();
}

TEST_F(Dump, KeepsMotion) {
  const auto original = scene();
  CameraDesc camera = original->camera_desc();
  const Mat4d rest =
      glm::inverse(glm::lookAt(Vec3d(4005, -4, 3), Vec3d(4000, 0, 0.5), Vec3d(0, 0, 1)));
  for (const double t : {-0.1, 0.0, 0.2}) {
    camera.motion.poses.push_back(glm::translate(Mat4d(1.0), Vec3d(t, 0, 0)) * rest);
  }
  camera.motion.zoom_open = 1.2;
  camera.shutter = {{0.5f, 1.0f, 0.25f}, true, 0.3};
  original->set_camera(camera);
  const auto wave = deforming(sphere(8, {4000, 0, 1}, 1.0, true), 2,
                              [](const Vec3d& p, double t) { return p + Vec3d(t, 0.5 * t, 0.0); });
  std::vector<Mat4d> poses;
  for (int i = 0; i < 5; ++i) poses.push_back(glm::translate(Mat4d(1.0), Vec3d(0.0, 0.3 * i, 0.0)));
  const InstanceInput waving{original->add_mesh(wave), poses[2]};
  original->add_moving_instances({&waving, 1}, poses, "waving");
  const InstanceInput still{0, glm::translate(Mat4d(1.0), Vec3d(0, 0, -1))};
  original->add_instances({&still, 1}, "still");
  write_dump(path_, *original, settings());
  const std::string first = bytes();
  const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
  write_dump(path_, *read.scene, read.settings);
  EXPECT_EQ(bytes(), first);
  EXPECT_EQ(render(committed(read.scene), read.settings), render(committed(original), settings()));
  EXPECT_TRUE(original->view().moves);
}

TEST_F(Dump, KeepsWhatTheVectorPassCompares) {
  const auto original = scene();
  CameraDesc camera = original->camera_desc();
  camera.shutter.still = true;
  original->set_camera(camera);
  const Polygons ball = sphere(8, {4000, 0, 1}, 1.0, true);
  std::vector<float> steps(ball.vtx2xyz);
  steps.insert(steps.end(), ball.vtx2xyz.begin(), ball.vtx2xyz.end());
  for (std::size_t i = 0; i < steps.size(); i += 2) steps[i] += 0.25f;
  MeshInput input = ball.input("bending");
  input.step_positions = steps;
  const InstanceInput bending{
      original->add_mesh(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel()))};
  original->add_instances({&bending, 1}, "bending");
  Settings with_vector = settings();
  with_vector.passes = {"Combined", "Vector"};
  write_dump(path_, *original, with_vector);
  const std::string first = bytes();
  const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
  write_dump(path_, *read.scene, read.settings);
  EXPECT_EQ(bytes(), first);
  const auto vectors = render(committed(original), with_vector, "Vector");
  EXPECT_EQ(render(committed(read.scene), with_vector, "Vector"), vectors);
  EXPECT_TRUE(std::ranges::any_of(vectors, [](float x) { return x != 0.0f; }));
}

TEST_F(Dump, KeepsStrandsInTime) {
  const Curves fur = made_fur(30, 3, 0.5, 0.05, 2.0, CurveShape::kThick);
  const MovedKeys moved(
      fur.xyz, fur.radius, 4, [](const Vec3d& p, double t) { return p + Vec3d(t, t * t, 0.0); },
      [](double r, double t) { return r * (1.0 + t); });
  std::vector<float> steps(moved.xyz.begin(),
                           moved.xyz.begin() + 6 * std::ptrdiff_t(fur.radius.size()));
  for (const bool still : {false, true}) {
    const auto original = scene();
    CameraDesc camera = original->camera_desc();
    camera.shutter.still = still;
    original->set_camera(camera);
    CurvesInput curves = fur.input("hair");
    PointsInput points{"cloud", fur.xyz, fur.radius};
    curves.motion = points.motion = still ? RoundMotion{{}, {}, steps} : moved.motion();
    for (const auto& mesh : {Mesh::build(curves, Builder::kSah, shared_pool(), Cancel()),
                             Mesh::build(points, Builder::kSah, shared_pool(), Cancel())}) {
      const InstanceInput there{original->add_mesh(mesh),
                                glm::translate(Mat4d(1.0), Vec3d(4001, -1, 1))};
      original->add_instances({&there, 1}, "strands");
    }
    Settings all = settings();
    all.passes = {"Combined", "Vector"};
    write_dump(path_, *original, all);
    const std::string first = bytes();
    const DumpedRender read = read_dump(path_, shared_pool(), Cancel());
    write_dump(path_, *read.scene, read.settings);
    EXPECT_EQ(bytes(), first);
    const auto picture = render(committed(original), all, still ? "Vector" : "Combined");
    EXPECT_EQ(render(committed(read.scene), all, still ? "Vector" : "Combined"), picture);
    EXPECT_TRUE(std::ranges::any_of(picture, [](float x) { return x != 0.0f; }));
    EXPECT_EQ(original->view().moves, !still);
  }
}

TEST_F(Dump, CutShortAnywhereIsRefused) {
  write_dump(path_, *scene(), settings());
  const std::string whole = bytes();
  for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 97) {
    write(whole.substr(0, length));
    EXPECT_THROW(read_dump(path_, shared_pool(), Cancel()), std::runtime_error) << length;
  }
  write(whole + "x");
  EXPECT_THROW(read_dump(path_, shared_pool(), Cancel()), std::runtime_error);
}

/// Damage of any kind gives a sentence or a scene, never a crash (the sanitizers watch).
TEST_F(Dump, DamagedFilesAreRefusedOrRender) {
  write_dump(path_, *scene(), settings());
  const std::string whole = bytes();
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string damaged = whole;
    for (int k = 0; k < 4; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    write(damaged);
    try {
      read_dump(path_, shared_pool(), Cancel()).scene->commit(shared_pool(), Cancel());
    } catch (const std::exception& error) {
      EXPECT_GT(std::string(error.what()).size(), 10u);
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST_F(Dump, NamesTheFileThatIsNotThere) {
  try {
    read_dump("/nowhere/scene.komorebi", shared_pool(), Cancel());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/scene.komorebi"), std::string::npos);
  }
}

}  // namespace
}  // namespace komorebi::testing
