// Curves and spheres: every builder, every instruction set and brute force give the same hits, to
// the bit; and hit by hit they are those of Embree's curves and of closed forms.
#include "core/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "bvh/traverse.h"
#include "render/scene.h"
#include "support/embree_curves.h"
#include "support/ray_list.h"

namespace komorebi {
namespace {

using testing::Curves;
using testing::EmbreeCurves;
using testing::made_fur;
using testing::RayList;

struct Numbers {
  explicit Numbers(unsigned seed) : random(seed) {}
  double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random);
  }
  Vec3d cube() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  std::mt19937 random;
};

struct Placed {
  std::shared_ptr<const Mesh> mesh;
  Mat4d matrix{1.0};
};

std::unique_ptr<Scene> placed(const std::vector<Placed>& parts) {
  static ThreadPool pool(2);
  auto scene = std::make_unique<Scene>();
  for (const Placed& part : parts) {
    const InstanceInput instance{scene->add_mesh(part.mesh), part.matrix, 0, kMaskAll, 0};
    scene->add_instances({&instance, 1}, "test");
  }
  scene->commit(pool, Cancel());
  return scene;
}

template <class Input>
std::shared_ptr<const Mesh> built(const Input& input, Builder builder = Builder::kSah) {
  static ThreadPool pool(2);
  return Mesh::build(input, builder, pool, Cancel());
}

/// A cloud of spheres, some large, some without a radius.
struct Cloud {
  std::vector<float> xyz, radius;
  explicit Cloud(std::uint32_t count) {
    Numbers numbers(5);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec3d at = numbers.cube();
      for (int c = 0; c < 3; ++c) xyz.push_back(static_cast<float>(at[c]));
      radius.push_back(static_cast<float>(i % 7 == 0 ? 0.0 : numbers.uniform(0.0, 0.1)));
    }
  }
  PointsInput input() const { return {"cloud", xyz, radius}; }
};

/// Rays through all of a scene around null of that size: from outside, from within, along an axis,
/// backwards, and leaving a hit.
RayList made_rays(const SceneView& scene, double size, std::uint32_t count) {
  Numbers numbers(9);
  RayList rays;
  Hit last;
  Vec3 last_point(0.0f);
  for (std::uint32_t i = 0; i < count; ++i) {
    Ray ray;
    const Vec3d to = 1.1 * size * numbers.cube();
    const Vec3d from =
        i % 3 == 0 ? 0.8 * size * numbers.cube() : 3.0 * size * glm::normalize(numbers.cube());
    ray.origin = Vec3(from);
    ray.direction = Vec3((i % 5 == 0 ? 1e-3 : 1.0) * (to - from));
    if (i % 11 == 0) ray.direction = Vec3(0, 0, i % 2 ? 1 : -1);
    if (i % 13 == 0) ray.t_min = -1.0f;
    if (i % 4 == 3 && last.valid()) {
      ray.origin = last_point;
      ray.self_instance = last.instance;
      ray.self_primitive = last.primitive;
    }
    rays.push_back(ray);
    const Hit hit = intersect_scalar(scene, ray);
    if (hit.valid()) {
      last = hit;
      last_point = ray.origin + hit.t * ray.direction;
    }
  }
  return rays;
}

/// Returns how many rays hit.
std::size_t expect_same_by_all(const SceneView& scene, const RayList& rays,
                               std::uint32_t searched) {
  std::vector<Hit> expected(rays.size());
  std::size_t met = 0;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    expected[i] = intersect_scalar(scene, rays[i]);
    met += expected[i].valid() ? 1u : 0u;
    if (i >= searched) continue;
    const Hit brute = intersect_brute_force(scene, rays[i]);
    EXPECT_EQ(std::memcmp(&brute, &expected[i], sizeof(Hit)), 0)
        << "brute force, ray " << i << ": " << brute.t << " " << brute.primitive << " "
        << expected[i].t << " " << expected[i].primitive;
    EXPECT_EQ(occluded_brute_force(scene, rays[i]), brute.valid());
  }
  for (const std::string& isa : built_instruction_sets()) {
    force_instruction_set(isa);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint32_t> bits(rays.size() / 32 + 1);
    intersect(scene, rays.span(), hits.data());
    occluded(scene, rays.span(), bits.data());
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(std::memcmp(&hits[i], &expected[i], sizeof(Hit)), 0) << isa << ", ray " << i;
      EXPECT_EQ(((bits[i / 32] >> (i % 32)) & 1u) != 0, expected[i].valid()) << isa << " " << i;
    }
  }
  force_instruction_set("");
  return met;
}

class RoundHits : public ::testing::TestWithParam<Builder> {};

TEST_P(RoundHits, AreTheSameByAll) {
  for (const CurveShape shape :
       {CurveShape::kRibbon, CurveShape::kThick, CurveShape::kThickLinear}) {
    const Curves fur = made_fur(300, 6, 0.5, 0.02, 3.0, shape);
    const auto mesh = built(fur.input(), GetParam());
    const auto cloud = built(Cloud(500).input(), GetParam());
    Mat4d turned = glm::rotate(Mat4d(1.0), 0.7, Vec3d(1, 2, 3));
    turned[3] = glm::dvec4(0.5, 0.2, 0.1, 1.0);
    Mat4d small = glm::scale(Mat4d(1.0), Vec3d(-0.4));
    Mat4d sheared(1.0);
    sheared[1][0] = 0.5;
    sheared[2][2] = 0.3;
    const auto scene = placed(
        {{mesh, turned}, {mesh, small}, {cloud, turned}, {mesh, sheared}, {cloud, Mat4d(1.0)}});
    const RayList rays = made_rays(scene->view(), 1.5, 2500);
    EXPECT_GT(expect_same_by_all(scene->view(), rays, GetParam() == Builder::kSah ? 300 : 60),
              800u);
  }
}

INSTANTIATE_TEST_SUITE_P(Builders, RoundHits,
                         ::testing::Values(Builder::kLinear, Builder::kSah, Builder::kList),
                         [](const auto& test) { return builder_name(test.param); });

/// How often ours and Embree's differ, of `count` rays from outside into fur.
struct Compared {
  std::uint32_t met = 0, other = 0, far_apart = 0, u_apart = 0, v_apart = 0;
};
Compared against_embree(const Curves& fur, double scale, std::uint32_t count) {
  const auto scene = placed({{built(fur.input())}});
  const EmbreeCurves embree(fur);
  const bool ribbon = fur.shape == CurveShape::kRibbon;
  Numbers numbers(4);
  Compared result;
  for (std::uint32_t i = 0; i < count; ++i) {
    Ray ray;
    const Vec3d from = 3.0 * scale * glm::normalize(numbers.cube());
    ray.origin = Vec3(from);
    ray.direction = Vec3(1.3 * scale * numbers.cube() - from);
    const Hit theirs = embree.intersect(ray, !ribbon);
    ray.origin = Vec3(Vec3d(ray.origin) - scene->origin());
    const Hit ours = intersect_scalar(scene->view(), ray);
    result.met += theirs.valid() ? 1u : 0u;
    if (ours.primitive != theirs.primitive) {
      ++result.other;
    } else if (ours.valid()) {
      result.far_apart += std::abs(ours.t - theirs.t) > 2e-5f ? 1u : 0u;
      result.u_apart += std::abs(ours.u - theirs.u) > 2e-3f ? 1u : 0u;
      if (ribbon) result.v_apart += std::abs(ours.v - theirs.v) > 0.02f ? 1u : 0u;
    }
  }
  return result;
}

TEST(CurveAgainstEmbree, Ribbons) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const Compared c = against_embree(
        testing::scaled_fur(made_fur(2000, 6, 0.5, 0.01, 3.0, CurveShape::kRibbon), scale), scale,
        20000);
    std::printf("x %g: %u met, %u other, %u t, %u u, %u v\n", scale, c.met, c.other, c.far_apart,
                c.u_apart, c.v_apart);
    EXPECT_GT(c.met, 5000u);
    EXPECT_LE(c.other, 20u);
    EXPECT_LE(c.far_apart, 5u);
    EXPECT_LE(c.u_apart, 20u);
    EXPECT_LE(c.v_apart, 20u);
  }
}

TEST(CurveAgainstEmbree, ThickCurves) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const Compared c = against_embree(
        testing::scaled_fur(made_fur(2000, 6, 0.5, 0.01, 3.0, CurveShape::kThick), scale), scale,
        20000);
    std::printf("x %g: %u met, %u other, %u t, %u u\n", scale, c.met, c.other, c.far_apart,
                c.u_apart);
    EXPECT_GT(c.met, 5000u);
    EXPECT_LE(c.other, 40u);
    EXPECT_LE(c.far_apart, 40u);
    EXPECT_LE(c.u_apart, 60u);
  }
}

TEST(CurveAgainstEmbree, LinearThickCurves) {
  // Embree's tolerance at a cone's begin is an absolute 1e-7 m² of the segment's squared length: it
  // would cover curves of segments below a millimetre, so that these are left to the next test.
  for (const double scale : {1.0, 1e3}) {
    // The second: radii that change as much as the keys lie apart.
    for (const double width : {0.01, 0.12}) {
      const Curves fur = made_fur(2000, 6, 0.5, width, 3.0, CurveShape::kThickLinear);
      const Compared c = against_embree(testing::scaled_fur(fur, scale), scale, 20000);
      std::printf("x %g, %g: %u met, %u other, %u t, %u u\n", scale, width, c.met, c.other,
                  c.far_apart, c.u_apart);
      EXPECT_GT(c.met, 10000u);
      EXPECT_LE(c.other, 5u);
      EXPECT_LE(c.far_apart, 5u);
      EXPECT_LE(c.u_apart, 5u);
    }
  }
}

TEST(Curve, LinearThickOnesAreSweptBySpheres) {
  // The nearest of very many spheres along the curve, for rays from outside.
  const Vec4d keys[] = {{{-1.5, 0, 0}, 0.3},     {{-0.8, 0.3, 0.2}, 0.1}, {{0, 0, 0.6}, 0.5},
                        {{0.1, -0.7, 0.2}, 0.2}, {{0.9, -0.2, -1}, 0.0},  {{1.1, 0, -1.1}, 0.6},
                        {{1.1, 1, 0}, 0.2}};
  for (const double scale : {1e-3, 1.0, 1e3}) {
    Curves curves;
    curves.shape = CurveShape::kThickLinear;
    for (const Vec4d& key : keys) curves.key(scale * key.at, scale * key.radius);
    curves.end_curve();
    const auto scene = placed({{built(curves.input())}});
    Numbers numbers(8);
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d from = 4.0 * scale * glm::normalize(numbers.cube());
      Ray ray;
      ray.origin = Vec3(from - scene->origin());
      ray.direction = Vec3(1.5 * scale * numbers.cube() - from);
      const Vec3d o = Vec3d(ray.origin) + scene->origin(), d(ray.direction);
      const double a = glm::dot(d, d);
      double nearest = 1e30, margin = 1e30;  // of grazing, in squared metres over scale
      for (int k = 0; k < 6; ++k) {
        for (int j = 0; j <= 2000; ++j) {
          const Vec4d at = keys[k] + (j / 2000.0) * (keys[k + 1] - keys[k]);
          const Vec3d q = o - scale * at.at;
          const double r = scale * at.radius, b = glm::dot(q, d);
          const double inside = b * b - a * (glm::dot(q, q) - r * r);
          margin = std::min(margin, std::abs(inside) / (a * scale * scale));
          if (inside > 0.0) nearest = std::min(nearest, (-b - std::sqrt(inside)) / a);
        }
      }
      const Hit hit = intersect_scalar(scene->view(), ray);
      if (hit.valid() != (nearest < 1e29)) {
        EXPECT_LT(margin, 1e-3) << i;
        continue;
      }
      if (!hit.valid()) continue;
      ++met;
      EXPECT_NEAR(double(hit.t), nearest, 2e-4) << i << ", scale " << scale;
    }
    EXPECT_GT(met, 500);
  }
}

TEST(Sphere, IsTheClosedForm) {
  // At the origin, 10 km from it, and tiny.
  for (const auto& [centre, radius] : {std::pair{Vec3d(0), 1.0}, std::pair{Vec3d(1e4, 2e3, 5), 0.5},
                                       std::pair{Vec3d(0.25, 0, 0), 1e-4}}) {
    const std::vector<float> xyz = {float(centre.x), float(centre.y), float(centre.z)};
    const std::vector<float> r = {float(radius)};
    const auto scene = placed({{built(PointsInput{"one", xyz, r})}});
    Numbers numbers(7);
    for (int i = 0; i < 2000; ++i) {
      Ray ray;
      const Vec3d middle = Vec3d(xyz[0], xyz[1], xyz[2]) - scene->origin();
      ray.origin = Vec3(middle + 3.0 * radius * glm::normalize(numbers.cube()));
      ray.direction = Vec3(middle + 1.5 * radius * numbers.cube() - Vec3d(ray.origin));
      const Vec3d o = Vec3d(ray.origin) - middle, d(ray.direction);
      const double a = glm::dot(d, d), b = glm::dot(o, d);
      const double c = glm::dot(o, o) - double(r[0]) * double(r[0]), disc = b * b - a * c;
      if (std::abs(disc) < 1e-5 * a * radius * radius) continue;  // grazing
      const Hit hit = intersect_scalar(scene->view(), ray);
      ASSERT_EQ(hit.valid(), disc > 0.0 && -b - std::sqrt(disc) > 0.0) << i;
      if (hit.valid()) {
        ASSERT_NEAR(double(hit.t), (-b - std::sqrt(disc)) / a, 1e-5) << i;
      }
      ray.origin = Vec3(middle + 0.3 * radius * numbers.cube());
      EXPECT_FALSE(occluded_scalar(scene->view(), ray)) << "a sphere has no inside";
    }
  }
}

TEST(Curve, OfOneStraightThickSegmentIsACylinder) {
  Curves curves;
  curves.shape = CurveShape::kThick;
  for (const double x : {-1.0, 0.0, 1.0}) curves.key({x, 0, 0}, 0.25);
  curves.end_curve();
  const auto scene = placed({{built(curves.input())}});
  Numbers numbers(2);
  for (int i = 0; i < 2000; ++i) {
    Ray ray;
    ray.origin = Vec3(Vec3d(numbers.uniform(-0.9, 0.9), -2, numbers.uniform(-0.4, 0.4)));
    ray.direction = Vec3(Vec3d(numbers.uniform(-0.3, 0.3), 1, 0));
    const double z = double(ray.origin.z), h = 0.0625 - z * z;
    const double x =
        double(ray.origin.x) + double(ray.direction.x) * (2.0 - std::sqrt(std::max(h, 0.0)));
    if (std::abs(h) < 1e-4 || std::abs(std::abs(x) - 1.0) < 1e-4) continue;
    const Hit hit = intersect_scalar(scene->view(), ray);
    ASSERT_EQ(hit.valid(), h > 0.0 && std::abs(x) < 1.0) << i;
    if (!hit.valid()) continue;
    EXPECT_NEAR(double(hit.t), 2.0 - std::sqrt(h), 1e-5);
    EXPECT_EQ(hit.primitive, x < 0.0 ? 0u : 1u);
  }
}

TEST(Curve, RibbonsAreWatertightAlongAStrand) {
  Curves curves;
  for (int k = 0; k <= 40; ++k) {
    const double a = 0.35 * k;
    curves.key({std::cos(a), std::sin(a), 0.03 * k}, 0.05);
  }
  curves.end_curve();
  const auto scene = placed({{built(curves.input())}});
  // Rays at the very joints, from everywhere.
  Numbers numbers(3);
  int missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::size_t k = 1 + std::size_t(i) % 39;
    Ray ray;
    const Vec3d to = Vec3d(curves.xyz[3 * k], curves.xyz[3 * k + 1], curves.xyz[3 * k + 2]);
    const Vec3d from = 4.0 * glm::normalize(numbers.cube());
    ray.origin = Vec3(from - scene->origin());
    ray.direction = Vec3(to - from);
    missed += intersect_scalar(scene->view(), ray).valid() ? 0 : 1;
  }
  EXPECT_EQ(missed, 0);
}

TEST(Curve, TwoHundredThousandHairsFit) {
  const Curves fur = made_fur(200000, 8, 0.3, 0.0005, 1.5, CurveShape::kRibbon);
  for (const Builder builder : {Builder::kLinear, Builder::kSah}) {
    const auto mesh = built(fur.input(), builder);
    std::printf("%s: %.1f MB\n", builder_name(builder), double(mesh->byte_count()) / 1e6);
    EXPECT_LE(mesh->byte_count(), 120000000u);
    EXPECT_GE(mesh->byte_count(), 200000u * 9u * 16u) << "the keys alone";
  }
}

}  // namespace
}  // namespace komorebi
