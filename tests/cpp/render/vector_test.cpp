// The Vector pass: where points are a step of time before and after, in pixels, against doubles
// worked out by hand; and pictures that poses in time leave as they were.
#include "support/made_curves.h"
#include "support/vectors.h"

namespace komorebi::testing {
namespace {

TEST(VectorPass, FollowsObjectsThatMoveAndTurn) {
  const auto poses =
      looking({{0, -6, 1}, {0, -6, 1}, {0, -6, 1}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const auto at = [](double t) {
    return glm::rotate(translated(2.0 * t - 1.0, 0.3 * t, t * t - 0.25), 0.7 * t,
                       glm::normalize(Vec3d(1, 1, 0))) *
           glm::scale(Mat4d(1.0), Vec3d(1.0 + 0.2 * t, 1.0, -0.8));
  };
  for (const double far : {0.0, 2e4}) {  // with the whole scene moved away
    const Mat4d away = translated(far, -far, 0.0);
    auto scene = make_scene({}, still_at(away * poses[1]));
    add_moving(
        *scene, ball_mesh(), [&](double t) { return away * at(t); }, 3);
    const auto back = glm::inverse(away * at(0.5));
    expect_vectors(
        committed(scene), {away * poses[0], away * poses[1], away * poses[2]},
        [](const Vec3d& p, int) { return pinhole(p); },
        [&](const Vec3d& p, int time) {
          return Vec3d(away * at(time) * back * glm::dvec4(p, 1.0));
        },
        far > 0.0 ? 1e-2 : 2e-3);
  }
}

TEST(VectorPass, FollowsMeshesThatDeform) {
  const auto poses =
      looking({{0, -6, 1}, {0, -6, 1}, {0, -6, 1}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const auto bend = [](const Vec3d& p, int time) {
    return time == 0 ? p + Vec3d(0.4, 0.1, -0.2) : Vec3d(1.5 * p.x, p.y, 0.5 * p.z);
  };
  const Vec3d centre(30, 0, 0);  // the mesh is off its own origin
  const Polygons ball = sphere(12, centre, 1.0, true);
  std::vector<float> steps;
  for (int time = 0; time < 2; ++time) {
    for (std::size_t v = 0; v < ball.vtx2xyz.size(); v += 3) {
      const Vec3d p(ball.vtx2xyz[v], ball.vtx2xyz[v + 1], ball.vtx2xyz[v + 2]);
      const Vec3d moved = centre + bend(p - centre, time);
      for (int c = 0; c < 3; ++c) steps.push_back(static_cast<float>(moved[c]));
    }
  }
  MeshInput input = ball.input();
  input.step_positions = steps;
  const auto mesh = Mesh::build(input, Builder::kLinear, shared_pool(), Cancel());
  const auto project = [](const Vec3d& p, int) { return pinhole(p); };
  for (const auto& built : {mesh, mesh->rebuilt(Builder::kSah, shared_pool(), Cancel())}) {
    const auto scene = committed(make_scene({{built, translated(-30, 0, 0)}}, still_at(poses[1])));
    expect_vectors(scene, poses, project, bend);
  }
  // And with an object that moves.
  auto scene = make_scene({}, still_at(poses[1]));
  add_moving(
      *scene, mesh, [](double t) { return translated(-30 + t - 0.5, 0, 0); }, 3);
  expect_vectors(committed(scene), poses, project,
                 [&](const Vec3d& p, int time) { return bend(p, time) + Vec3d(time - 0.5, 0, 0); });
  // A mesh with a tree in time is compared at its first and last set.
  const auto in_time = deforming(ball, 2, [&](const Vec3d& p, double t) {
    return t == 0.5 ? p : centre + bend(p - centre, t > 0.5);
  });
  expect_vectors(committed(make_scene({{in_time, translated(-30, 0, 0)}}, still_at(poses[1]))),
                 poses, project, bend);
}

TEST(VectorPass, FollowsCurvesByTheirAxisAndSpheresByTheirCentre) {
  const auto camera =
      looking({{0, -6, 0}, {0, -6, 0}, {0, -6, 0}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  Curves bar;
  for (int i = 0; i < 5; ++i) bar.key({-1.2 + 0.6 * i, 0, 0}, 0.3);
  bar.end_curve();
  bar.shape = CurveShape::kThick;
  const std::vector<float> at = {0, 0, 0}, radius = {0.9f};
  const std::shared_ptr<const Mesh> meshes[] = {
      Mesh::build(bar.input("bar"), Builder::kLinear, shared_pool(), Cancel()),
      Mesh::build(PointsInput{"ball", at, radius}, Builder::kLinear, shared_pool(), Cancel())};
  for (const auto& mesh : meshes) {
    const bool is_bar = mesh == meshes[0];
    auto scene = make_scene({}, still_at(camera[1]));
    // Turned about the x axis alone, a point on the axis stays where the surface would not.
    const Vec3d step(0.3, 0.5, 0.2);
    const auto way = [&](double t) {
      return glm::rotate(translated(0, 0, 0) * glm::translate(Mat4d(1.0), (2 * t - 1) * step),
                         2.0 * t - 1.0, Vec3d(1, 0, 0));
    };
    add_moving(*scene, mesh, way, 3);
    committed(scene);
    Settings settings = with_vector();
    settings.samples = 1;
    const auto vectors = render(scene, settings, "Vector");
    const auto positions = render(scene, settings, "Position");
    const std::size_t middle = kSize / 2 * kSize + kSize / 2;
    // Of the thick bar the axis' point lies beside the surface's, at the same x.
    const Vec3d axis(is_bar ? double{positions[3 * middle]} : 0.0, 0, 0);
    const glm::dvec2 now = pinhole(Vec3d(axis.x, 0, -6));
    const auto moved = [&](double sign) {
      const Vec3d p = axis + sign * step;
      return pinhole(Vec3d(p.x, p.z, -6 - p.y));
    };
    EXPECT_NEAR(vectors[4 * middle], moved(-1).x - now.x, 2e-3);
    EXPECT_NEAR(vectors[4 * middle + 1], moved(-1).y - now.y, 2e-3);
    EXPECT_NEAR(vectors[4 * middle + 2], now.x - moved(1).x, 2e-3);
    EXPECT_NEAR(vectors[4 * middle + 3], now.y - moved(1).y, 2e-3);
  }
}

TEST(VectorPass, FollowsStrandsThatChangeTheirShape) {
  const auto camera =
      looking({{0, -6, 0}, {0, -6, 0}, {0, -6, 0}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  Curves bar;
  for (int i = 0; i < 5; ++i) bar.key({-1.2 + 0.6 * i, 0, 0}, 0.3);
  bar.end_curve();
  bar.shape = CurveShape::kThick;
  Curves ball;
  ball.key({0, 0, 0}, 0.9);
  // The way of x itself, so that a spline through keys at even steps is the map between them.
  const auto bend = [](const Vec3d& p, double t) {
    const double s = 2.0 * t - 1.0;
    return Vec3d((1.0 + 0.25 * s) * p.x + 0.3 * s, 0.5 * s, 0.2 * s * s);
  };
  const MovedKeys bars(bar.xyz, bar.radius, 2, bend, [](double r, double) { return r; });
  const MovedKeys balls(ball.xyz, ball.radius, 2, bend, [](double r, double) { return r; });
  for (const bool in_time : {false, true}) {  // steps alone, or a set with a tree in time
    for (const bool is_bar : {false, true}) {
      CurvesInput curves = bar.input("bar");
      PointsInput points{"ball", ball.xyz, ball.radius};
      const MovedKeys& moved = is_bar ? bars : balls;
      curves.motion = points.motion = in_time ? moved.motion() : RoundMotion{{}, {}, moved.xyz};
      const auto mesh = is_bar ? Mesh::build(curves, Builder::kLinear, shared_pool(), Cancel())
                               : Mesh::build(points, Builder::kLinear, shared_pool(), Cancel());
      const Mat4d away = translated(0.1, 0, 0);
      const auto scene = committed(make_scene({{mesh, away}}, still_at(camera[1])));
      Settings settings = with_vector();
      settings.samples = 1;
      const auto vectors = render(scene, settings, "Vector");
      const auto positions = render(scene, settings, "Position");
      const std::size_t middle = kSize / 2 * kSize + kSize / 2;
      const Vec3d axis(is_bar ? double{positions[3 * middle]} - 0.1 : 0.0, 0, 0);
      const auto at = [&](double t) {
        const Vec3d p = bend(axis, t) + Vec3d(0.1, 0, 0);
        return pinhole(Vec3d(p.x, p.z, -6 - p.y));
      };
      EXPECT_NEAR(vectors[4 * middle], at(0).x - at(0.5).x, 2e-3);
      EXPECT_NEAR(vectors[4 * middle + 1], at(0).y - at(0.5).y, 2e-3);
      EXPECT_NEAR(vectors[4 * middle + 2], at(0.5).x - at(1).x, 2e-3);
      EXPECT_NEAR(vectors[4 * middle + 3], at(0.5).y - at(1).y, 2e-3);
      EXPECT_GT(std::abs(vectors[4 * middle]), 1.0f);
    }
  }
}

TEST(VectorPass, IsTheMeanOverTheSamplesThatHit) {
  const auto poses =
      looking({{0, -6, 1}, {0, -6, 1}, {0, -6, 1}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  CameraDesc camera = still_at(poses[1]);
  camera.kind = CameraKind::kOrthographic;
  camera.clip_from_world = glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 50.0) * glm::inverse(poses[1]);
  auto scene = make_scene({}, camera);
  add_moving(
      *scene, ball_mesh(), [](double t) { return translated(2 * t - 1, 0, 0); }, 3);
  Settings settings = with_vector();
  settings.film_transparent = true;
  settings.samples = 16;
  const auto vectors = render(committed(scene), settings, "Vector");
  const auto picture = render(scene, settings);
  int edges = 0;
  for (std::size_t i = 0; i < kSize * kSize; ++i) {
    const float alpha = picture[4 * i + 3];
    edges += alpha > 0.0f && alpha < 1.0f;
    ASSERT_NEAR(vectors[4 * i], alpha > 0.0f ? -10.0 : 0.0, 1e-4) << alpha;
    ASSERT_NEAR(vectors[4 * i + 2], alpha > 0.0f ? -10.0 : 0.0, 1e-4) << alpha;
  }
  EXPECT_GT(edges, 20);
}

/// A scene of all that can move, or the same at rest.
std::shared_ptr<Scene> busy(bool moves) {
  const auto poses = looking({{-0.5, -6, 1.2}, {0, -6, 1}, {0.4, -6, 1}},
                             {{-0.2, 0, 0}, {0, 0, 0}, {0.5, 0, 0.2}});
  CameraDesc camera = still_at(poses[1]);
  camera.shutter.still = moves;
  if (moves) {
    camera.motion.poses = poses;
    camera.motion.zoom_open = 1.2;
  }
  const Polygons ball = sphere(12, {5, 0.3, 0}, 0.7, true);
  std::vector<float> steps(ball.vtx2xyz);
  steps.insert(steps.end(), ball.vtx2xyz.begin(), ball.vtx2xyz.end());
  for (float& x : steps) x += 0.37f;
  MeshInput input = ball.input();
  if (moves) input.step_positions = steps;
  auto scene = make_scene({{quad({-9, 4, -9}, {18, 0, 0}, {0, 0, 18}).mesh()}}, camera);
  const auto mesh = Mesh::build(input, Builder::kLinear, shared_pool(), Cancel());
  for (int i = 0; i < 5; ++i) {
    const Way way = [&](double t) {
      return glm::rotate(translated(-4.0 + 1.7 * t, 40.0 * (t - 0.5), 0.4 * i), 1.0 * i + 2.0 * t,
                         glm::normalize(Vec3d(1, i, 2)));
    };
    if (moves) {
      add_moving(*scene, mesh, way, 3);
    } else {
      const InstanceInput instance{scene->add_mesh(mesh), way(0.5)};
      scene->add_instances({&instance, 1}, "still");
    }
  }
  return committed(scene);
}

TEST(VectorPass, LeavesThePictureAsItIs) {
  const auto moving = busy(true), still = busy(false);
  Settings settings = with_vector();
  EXPECT_EQ(moving->origin(), still->origin());
  EXPECT_FALSE(moving->view().moves);
  for (const char* pass : {"Combined", "Position", "Depth", "Normal"}) {
    EXPECT_EQ(render(moving, settings, pass), render(still, settings, pass)) << pass;
  }
  const auto vectors = render(moving, settings, "Vector");
  EXPECT_GT(std::ranges::count_if(vectors, [](float x) { return x != 0.0f; }), 3000);
  for (const float value : render(still, settings, "Vector")) ASSERT_EQ(value, 0.0f);
}

TEST(VectorPass, IsBlackWhereMotionIsBlurred) {
  CameraDesc camera = camera_at({0, -6, 1}, {0, 0, 0}, kSize, kSize);
  auto scene = make_scene({}, camera);
  add_moving(
      *scene, ball_mesh(), [](double t) { return translated(2 * t - 1, 0, 0); }, 3);
  for (const float value : render(committed(scene), with_vector(), "Vector")) {
    ASSERT_EQ(value, 0.0f);
  }
}

TEST(VectorPass, RefusesWhatStandsForNothing) {
  Scene scene;
  CameraDesc camera = camera_at({0, -6, 1}, {0, 0, 0}, kSize, kSize);
  camera.shutter = {{0.5f, 1.0f}, false, 0.1, true};
  EXPECT_THROW(scene.set_camera(camera), std::invalid_argument);
  camera.shutter = {{}, true, 0.1, true};
  EXPECT_THROW(scene.set_camera(camera), std::invalid_argument);
  const Polygons ball = sphere(4, Vec3d(0), 1.0, false);
  const auto refused = [&](const std::vector<float>& steps, const std::vector<float>& motion) {
    MeshInput input = ball.input();
    input.step_positions = steps;
    input.motion_positions = motion;
    EXPECT_THROW(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel()),
                 std::invalid_argument);
  };
  std::vector<float> twice = ball.vtx2xyz;
  twice.insert(twice.end(), ball.vtx2xyz.begin(), ball.vtx2xyz.end());
  refused(ball.vtx2xyz, {});
  refused(twice, twice);
  twice[5] = NAN;
  refused(twice, {});
}

}  // namespace
}  // namespace komorebi::testing
