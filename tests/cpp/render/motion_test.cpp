// Instances that move: the tree against brute force at each ray's time, still instances that stand
// where the moving ones pass, and coverage in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "support/moving.h"

namespace komorebi::testing {
namespace {

std::vector<Way> ways(const Vec3d& at) {
  const Mat4d place = glm::translate(Mat4d(1.0), at);
  const Vec3d axis = glm::normalize(Vec3d(1, 2, -1));
  return {
      [=](double t) { return glm::rotate(place, 6.0 * t, axis); },
      [=](double t) { return glm::translate(place, Vec3d(9 * t - 4, 7 * t - 3, -5 * t)); },
      [=](double t) { return glm::scale(glm::translate(place, Vec3d(2, 0, 1)), Vec3d(2 * t)); },
      [=](double t) {
        Mat4d m = glm::rotate(glm::translate(place, Vec3d(-2, t, 1)), -2.0 * t, Vec3d(0, 0, 1));
        m[1] += 0.8 * m[0];
        return glm::scale(m, Vec3d(-1, 0.7 + t, 1e-3));
      },
      [=](double t) { return glm::translate(place, Vec3d(0, 0, 3e-6 * t)); },
      [=](double) { return place; },
  };
}

TEST(MovingInstances, AgreeWithBruteForceForEveryBuilderAndKernel) {
  for (const double far : {0.0, 3e5}) {
    for (const Builder builder : {Builder::kLinear, Builder::kSah, Builder::kList}) {
      const auto ball = sphere(9, {0.3, 0, 0}, 1.5, false).mesh(builder);
      const auto flat = quad({40, -1, 0}, {2, 0, 0}, {0, 2, 0}).mesh(builder);  // off its origin
      const Vec3d at(far, -far, 0.1 * far);
      auto scene = make_scene({{ball, glm::translate(Mat4d(1.0), at + Vec3d(1, -3, 0))}},
                              camera_at(at + Vec3d(9, 0, 0), at, 10, 10));
      for (const int count : {3, 7}) {
        for (const Way& way : ways(at)) add_moving(*scene, ball, way, count);
      }
      add_moving(
          *scene, flat,
          [&](double t) {
            return glm::rotate(glm::translate(Mat4d(1.0), at), 1.0 * t, Vec3d(0, 0, 1)) *
                   translated(-40, 0, 0);
          },
          5);
      committed(scene);
      const Vec3 centre(at - scene->origin());
      EXPECT_GT(expect_brute_force(*scene, random_rays(1500, centre, 6.0f)), 300u);
    }
  }
}

TEST(MovingInstances, HitWhatAStillOneHitsThatStandsThere) {
  // Against instances placed by GLM's own slerp, at the time of the rays.
  const auto ball = sphere(16, {0.5, 0, 0}, 1.0, false).mesh();
  const glm::dquat from = glm::angleAxis(0.3, glm::normalize(Vec3d(1, 0, 1)));
  const glm::dquat to = glm::angleAxis(2.6, glm::normalize(Vec3d(0, 1, 1)));
  const auto pose = [&](double t) {
    Mat4d m = glm::mat4_cast(glm::slerp(from, to, t));
    m = m * glm::scale(Mat4d(1.0), glm::mix(Vec3d(1, 2, 0.5), Vec3d(2, 1, 1), t));
    m[3] = glm::dvec4(3.0 * t, -t, 1.0, 1.0);
    return m;
  };
  const CameraDesc camera = camera_at({9, -4, 3}, {1, 0, 1}, 10, 10);
  auto moving = make_scene({}, camera);
  const std::vector<Mat4d> poses = {pose(0.0), pose(0.5), pose(1.0)};
  const InstanceInput instance{moving->add_mesh(ball), poses[1]};
  moving->add_moving_instances({&instance, 1}, poses, "moving");
  committed(moving);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  int compared = 0, differ = 0;
  double most = 0.0;
  for (const double t : {0.0, 0.21, 0.5, 0.77, 1.0}) {
    const auto still = committed(make_scene({{ball, pose(t)}}, camera));
    for (int i = 0; i < 1000; ++i) {
      const Vec3 eye = Vec3(9.0f * number(random), 9.0f * number(random), 9.0f);
      const Vec3 target(1.5f + 2.0f * number(random), 2.0f * number(random), 1.0f);
      Ray a, b;
      a.origin = eye - Vec3(moving->origin());
      b.origin = eye - Vec3(still->origin());
      a.direction = b.direction = (target - eye) / glm::length(target - eye);
      a.time = static_cast<float>(t);
      const Hit hit = intersect_scalar(moving->view(), a),
                other = intersect_scalar(still->view(), b);
      if (!hit.valid() && !other.valid()) continue;
      ++compared;
      if (hit.valid() != other.valid()) {
        ++differ;  // at the silhouette
      } else {
        const SurfacePoint p = surface_point(moving->view(), hit, a);
        const SurfacePoint q = surface_point(still->view(), other, b);
        if (hit.primitive != other.primitive) continue;
        most = std::max(most, double(glm::length(p.geometric_normal - q.geometric_normal)));
        if (glm::dot(p.geometric_normal, a.direction) > -0.2f) continue;
        EXPECT_LT(
            glm::length(Vec3d(p.position) + moving->origin() - Vec3d(q.position) - still->origin()),
            2e-3);
      }
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LE(differ, compared / 200);
  EXPECT_LT(most, 2e-3);
}

TEST(MovingInstances, ASquareThatPassesCoversATrapezoid) {
  auto scene = make_scene({}, from_above(40));
  add_moving(
      *scene, quad({-0.2, -0.5, 0}, {0.4, 0, 0}, {0, 1, 0}).mesh(),
      [](double t) { return translated(1.0 * t - 0.5, 0, 0); }, 3);
  const auto alpha = coverage(scene, 40, 20);
  for (std::uint32_t x = 0; x < 40; ++x) {
    EXPECT_NEAR(alpha[x], trapezoid(-1.0 + 0.05 * x), 6e-3) << x;
  }
}

TEST(MovingInstances, ABarThatTurnsCoversByTheArcsOfItsWidth) {
  auto scene = make_scene({}, from_above(400));
  add_moving(
      *scene, quad({-0.95, -0.1, 0}, {1.9, 0, 0}, {0, 0.2, 0}).mesh(),
      [](double t) { return glm::rotate(Mat4d(1.0), glm::pi<double>() * t + 0.4, Vec3d(0, 0, 1)); },
      3);
  const auto alpha = coverage(scene, 400, 200);
  int compared = 0;
  for (std::uint32_t x = 0; x < 400; ++x) {
    const double r = glm::length(glm::dvec2(-1.0 + 0.005 * (x + 0.5), 0.0025));
    if (std::abs(r - 0.1) < 0.01 || std::abs(r - 0.95) < 0.01) continue;  // edges cross the pixel
    const double arc = r < 0.1 ? 1.0 : 2.0 * std::asin(0.1 / r) / glm::pi<double>();
    EXPECT_NEAR(alpha[x], r > 0.95 ? 0.0 : arc, 6e-3) << r;
    ++compared;
  }
  EXPECT_GT(compared, 300);
}

TEST(MovingInstances, ABallThatComesNearGrows) {
  const std::vector<float> at = {0, 0, 0}, radius = {0.5f};
  auto scene = make_scene({}, camera_at({0, -10, 0}, {0, 0, 0}, 200, 200));
  add_moving(
      *scene,
      Mesh::build(PointsInput{"ball", at, radius}, Builder::kLinear, shared_pool(), Cancel()),
      [](double t) { return translated(0, -6.0 * t, 0); }, 3);
  const auto alpha = coverage(scene, 200, 100);
  for (std::uint32_t x = 0; x < 200; ++x) {
    const glm::dvec2 tangent = glm::dvec2(double(x) + 0.5 - 100.0, 0.5) * (0.36 / 100.0);
    const double slope = glm::length(tangent);
    const double sine = slope / std::sqrt(1.0 + slope * slope);
    const double nearest = std::clamp((0.5 / sine - 4.0) / 6.0, 0.0, 1.0);  // share of the way
    EXPECT_NEAR(alpha[x], nearest, 6e-3) << x;
  }
}

TEST(MovingInstances, RefuseWhatIsNoMotion) {
  Scene scene;
  const auto mesh = scene.add_mesh(box(Vec3d(-1), Vec3d(1)).mesh());
  const InstanceInput instance{mesh};
  const auto refused = [&](const std::vector<Mat4d>& poses) {
    EXPECT_THROW(scene.add_moving_instances({&instance, 1}, poses, "x"), std::invalid_argument);
  };
  refused({});
  refused({Mat4d(1.0)});
  refused({Mat4d(1.0), Mat4d(1.0)});
  refused({Mat4d(1.0), translated(1, 0, 0), Mat4d(1.0)});
  refused({translated(NAN, 0, 0), Mat4d(1.0), Mat4d(1.0)});
  EXPECT_EQ(scene.instance_count(), 0u);
}

TEST(MovingInstances, StandStillWhenTheirPosesDo) {
  const CameraDesc camera = camera_at({4, -6, 3}, {0, 0, 0}, 40, 30);
  const auto ball = sphere(9, Vec3d(0), 1.0, true).mesh();
  auto scene = make_scene({}, camera);
  add_moving(
      *scene, ball, [](double) { return translated(0.1, 0.2, 0.3); }, 3);
  EXPECT_EQ(render(committed(scene), Settings{}),
            render(committed(make_scene({{ball, translated(0.1, 0.2, 0.3)}}, camera)), Settings{}));
  EXPECT_FALSE(scene->view().moves);
}

TEST(Instances, TakeAtMostAHundredAndFiftyBytes) {
  const auto mesh = sphere(4, Vec3d(0), 0.4, false).mesh();
  Scene scene;
  const std::uint32_t index = scene.add_mesh(mesh);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(0.0, 6.0);
  std::vector<InstanceInput> row(1000);
  for (int y = 0; y < 1000; ++y) {
    for (int x = 0; x < 1000; ++x) {
      row[static_cast<std::size_t>(x)] = {
          index, glm::rotate(translated(x, y, number(random)), number(random), Vec3d(0, 0, 1))};
    }
    scene.add_instances(row, "many");
  }
  scene.commit(shared_pool(), Cancel(), false);
  EXPECT_EQ(scene.instance_count(), 1000000u);
  EXPECT_EQ(scene.triangle_count(), 1000000u * mesh->triangle_count());
  EXPECT_LE(double(scene.byte_count()) / 1e6, 150.0);
  EXPECT_THROW(scene.inputs(), std::invalid_argument);
}

}  // namespace
}  // namespace komorebi::testing
