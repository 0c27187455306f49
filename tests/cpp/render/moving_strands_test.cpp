// Curves and points that change their shape while the shutter is open: the trees against brute
// force at each ray's time, sets that stand still where those are then, and coverage in closed
// form.
#include <gtest/gtest.h>

#include <cmath>

#include "support/made_curves.h"
#include "support/moving.h"

namespace komorebi::testing {
namespace {

Vec3d wave(const Vec3d& p, double t) {
  return p + Vec3d(1.5 * t * t, 0.4 * std::sin(7.0 * p.x + 5.0 * t), std::max(0.0, t - 0.4));
}
double swell(double r, double t) {
  return r * (0.5 + t);
}

std::shared_ptr<const Mesh> curves_of(const Curves& like, const MovedKeys& moved,
                                      Builder builder = Builder::kLinear) {
  CurvesInput input = like.input("hair");
  input.key2xyz = moved.rest_xyz;
  input.key2radius = moved.rest_radius;
  input.motion = moved.motion();
  return Mesh::build(input, builder, shared_pool(), Cancel());
}

std::shared_ptr<const Mesh> points_of(const MovedKeys& moved, Builder builder = Builder::kLinear) {
  return Mesh::build(PointsInput{"cloud", moved.rest_xyz, moved.rest_radius, moved.motion()},
                     builder, shared_pool(), Cancel());
}

/// The keys of some fur as a cloud, of which every fifth point is there only for a part of the time
/// and every seventh never.
MovedKeys cloud_of(const Curves& fur, int others) {
  Curves wide = fur;
  for (std::size_t i = 0; i < wide.radius.size(); ++i) wide.radius[i] = i % 7 ? 0.1f : 0.0f;
  const std::size_t count = wide.radius.size();
  MovedKeys moved(wide.xyz, wide.radius, others, wave, swell);
  for (std::size_t i = 0; i < moved.radius.size(); ++i) {
    if (i % count % 5 == 0 && i < count) moved.radius[i] = 0.0f;
  }
  return moved;
}

TEST(MovingStrands, AgreeWithBruteForceForEveryBuilderAndKernel) {
  for (const Builder builder : {Builder::kLinear, Builder::kSah, Builder::kList}) {
    for (const CurveShape shape : {CurveShape::kRibbon, CurveShape::kThick}) {
      const int others = shape == CurveShape::kRibbon ? 2 : 6;
      const Curves fur = made_fur(120, 4, 0.6, 0.04, 3.0, shape);
      const auto waving =
          curves_of(fur, MovedKeys(fur.xyz, fur.radius, others, wave, swell), builder);
      const auto drift = [](const Vec3d& p, double t) { return p + Vec3d(1e-4 * t); };
      const auto keep = [](double r, double) { return r; };
      const auto calm =
          curves_of(fur, MovedKeys(fur.xyz, fur.radius, others, drift, keep), builder);
      const auto cloud = points_of(cloud_of(fur, others), builder);
      EXPECT_TRUE(waving->deforms() && cloud->deforms());
      EXPECT_EQ(calm->view().time_tree_count, 1u);
      EXPECT_GT(waving->view().time_tree_count, 2u);
      EXPECT_GT(cloud->view().time_tree_count, 2u);
      Mat4d sheared = translated(2, -3, 1);
      sheared[1] -= 0.7 * sheared[0];
      sheared[2] *= -1.0;
      auto scene = make_scene({{waving},
                               {calm, sheared},
                               {cloud, translated(-3, 2, 0)},
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
      EXPECT_GT(expect_brute_force(*scene, random_rays(1200, centre, 4.0f)), 150u);
    }
  }
}

struct Compared {
  int met = 0, other = 0;
};
/// Of one scene at a time and another that stands still: the same hits and the same surfaces.
Compared compare(const std::shared_ptr<Scene>& moving, const std::shared_ptr<Scene>& still,
                 float time, bool exactly) {
  Compared result;
  EXPECT_EQ(moving->origin(), still->origin());
  const RayList rays = random_rays(4000, Vec3(0.0f), 2.0f);
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    Ray a = rays[i], b = rays[i];
    a.origin -= Vec3(moving->origin());
    b.origin -= Vec3(still->origin());
    a.time = time;
    a.self_instance = b.self_instance = kNone;
    const Hit hit = intersect_scalar(moving->view(), a), same = intersect_scalar(still->view(), b);
    if (exactly) {
      EXPECT_EQ(std::memcmp(&hit, &same, sizeof(Hit)), 0) << i;
    }
    if (!hit.valid() && !same.valid()) continue;
    ++result.met;
    if (hit.primitive != same.primitive) {
      ++result.other;  // at a silhouette
      continue;
    }
    const SurfacePoint p = surface_point(moving->view(), hit, a);
    const SurfacePoint q = surface_point(still->view(), same, b);
    EXPECT_LT(glm::length(p.normal - q.normal), exactly ? 1e-7f : 0.02f);
    EXPECT_LT(glm::length(p.position - q.position), exactly ? 1e-7f : 1e-4f);
  }
  return result;
}

TEST(MovingStrands, AreAtEachTimeTheStrandsOfThatTime) {
  const CameraDesc camera = camera_at({9, 0, 0}, {0, 0, 0}, 10, 10);
  for (const CurveShape shape : {CurveShape::kRibbon, CurveShape::kThick}) {
    const Curves fur = made_fur(400, 4, 0.6, 0.03, 3.0, shape);
    const MovedKeys moved(fur.xyz, fur.radius, 4, wave, swell), in_cloud = cloud_of(fur, 4);
    // Two corners that hold all of it, so that every scene has the same origin.
    const auto alone = [&](const std::shared_ptr<const Mesh>& mesh) {
      return committed(make_scene(
          {{mesh}, {box(Vec3d(-9), Vec3d(-8)).mesh()}, {box(Vec3d(8), Vec3d(9)).mesh()}}, camera));
    };
    const auto hair = alone(curves_of(fur, moved)), cloud = alone(points_of(in_cloud));
    Compared sum;
    for (int step = 0; step <= 12; ++step) {
      const double time = step / 12.0;  // sets are at every third
      const Curves still = moved.still(fur, 4, time), points = in_cloud.still(fur, 4, time);
      const auto built = [&](const auto& input) {
        return alone(Mesh::build(input, Builder::kLinear, shared_pool(), Cancel()));
      };
      const bool exactly = step % 3 == 0;
      for (const Compared& c :
           {compare(hair, built(still.input()), static_cast<float>(time), exactly),
            compare(cloud, built(PointsInput{"still", points.xyz, points.radius}),
                    static_cast<float>(time), exactly)}) {
        sum.met += c.met;
        sum.other += c.other;
      }
    }
    EXPECT_GT(sum.met, 4000);
    EXPECT_LE(sum.other, sum.met / 500);
  }
}

TEST(MovingStrands, ThatStandStillAreHitAsThoseThatCannotMove) {
  const Curves fur = made_fur(300, 4, 0.6, 0.03, 3.0, CurveShape::kThick);
  const MovedKeys moved(
      fur.xyz, fur.radius, 2, [](const Vec3d& p, double) { return p; },
      [](double r, double) { return r; });
  CurvesInput input = fur.input("still");
  const auto plain = Mesh::build(input, Builder::kSah, shared_pool(), Cancel());
  input.motion.positions = moved.xyz;  // and radii as they are at rest
  const auto same = Mesh::build(input, Builder::kSah, shared_pool(), Cancel());
  EXPECT_FALSE(plain->deforms());
  EXPECT_EQ(plain->view().time_trees, nullptr);
  EXPECT_EQ(same->view().time_tree_count, 1u);
  EXPECT_GE(same->byte_count(), plain->byte_count() + 2 * 16 * fur.radius.size());
  const CameraDesc camera = camera_at({9, 0, 0}, {0, 0, 0}, 10, 10);
  const auto a = committed(make_scene({{same}}, camera));
  const auto b = committed(make_scene({{plain}}, camera));
  EXPECT_GT(compare(a, b, 0.3f, false).met, 300);
  EXPECT_EQ(compare(a, b, 0.3f, false).other, 0);
}

TEST(MovingStrands, ABarThatPassesCoversATrapezoid) {
  for (const CurveShape shape : {CurveShape::kRibbon, CurveShape::kThick}) {
    Curves bar;
    bar.shape = shape;
    for (int i = 0; i < 5; ++i) bar.key({0, -0.8 + 0.4 * i, 0}, 0.2);
    bar.end_curve();
    const MovedKeys moved(
        bar.xyz, bar.radius, 2, [](const Vec3d& p, double t) { return p + Vec3d(t - 0.5, 0, 0); },
        [](double r, double) { return r; });
    const auto alpha = coverage(make_scene({{curves_of(bar, moved)}}, from_above(40)), 40, 20);
    for (std::uint32_t x = 0; x < 40; ++x) {
      EXPECT_NEAR(alpha[x], trapezoid(-1.0 + 0.05 * x), 6e-3) << x;
    }
  }
}

TEST(MovingStrands, RefuseWhatDoesNotFit) {
  const Curves fur = made_fur(3, 4, 0.6, 0.03, 3.0, CurveShape::kThick);
  const std::vector<float> xyz(6 * fur.radius.size(), 0.5f), radius(2 * fur.radius.size(), 0.5f);
  const auto build = [&](std::span<const float> positions, std::span<const float> radii,
                         std::span<const float> steps) {
    CurvesInput curves = fur.input("hair");
    PointsInput points{"cloud", fur.xyz, fur.radius};
    curves.motion = points.motion = {positions, radii, steps};
    EXPECT_NO_THROW(curves_of(fur, MovedKeys(fur.xyz, fur.radius, 2, wave, swell)));
    bool both = true, any = false;
    for (const bool as_curves : {true, false}) {
      try {
        as_curves ? Mesh::build(curves, Builder::kLinear, shared_pool(), Cancel())
                  : Mesh::build(points, Builder::kLinear, shared_pool(), Cancel());
        any = true;
      } catch (const std::invalid_argument&) {
        both = false;
      }
    }
    EXPECT_EQ(both, any);
    return both;
  };
  const auto changed = [](std::vector<float> values, float value) {
    values[7] = value;
    return values;
  };
  EXPECT_TRUE(build(xyz, radius, {}));
  EXPECT_TRUE(build(xyz, {}, {}));
  EXPECT_TRUE(build({}, {}, xyz));
  EXPECT_FALSE(build(std::span(xyz).first(xyz.size() / 2), {}, {}));
  EXPECT_FALSE(build(std::span(xyz).first(xyz.size() - 3), {}, {}));
  EXPECT_FALSE(build(xyz, std::span(radius).first(radius.size() - 1), {}));
  EXPECT_FALSE(build({}, radius, {}));
  EXPECT_FALSE(build(xyz, {}, xyz));
  EXPECT_FALSE(build({}, {}, std::span(xyz).first(3)));
  EXPECT_FALSE(build(changed(xyz, NAN), {}, {}));
  EXPECT_FALSE(build(xyz, changed(radius, -1.0f), {}));
  EXPECT_FALSE(build({}, {}, changed(xyz, INFINITY)));
}

}  // namespace
}  // namespace komorebi::testing
