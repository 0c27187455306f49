// Hits that count only if a filter says so: every kernel and builder, for rays alone and together,
// against all that a ray meets, sorted out by the test itself.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "support/bundle_list.h"
#include "support/lottery.h"
#include "support/made_curves.h"
#include "support/moving.h"
#include "support/ray_kinds.h"
#include "support/test_scene.h"

namespace komorebi::testing {
namespace {

/// The closest hit that counts, from everything that the ray meets.
Hit sorted_out(SceneView scene, const Ray& ray, const Lottery& lottery) {
  Collector collector;
  scene.filter = collector.filter();
  Hit best = intersect_brute_force(scene, ray);  // on what is opaque
  for (const HitQuery& query : collector.take()) {
    if (!lottery.accepted(query)) continue;
    const Hit& hit = query.hit;
    const auto key = [](const Hit& h) { return std::tuple(h.t, h.instance, h.primitive, h.u); };
    if (!best.valid() || key(hit) < key(best)) best = hit;
  }
  return best;
}

bool bit(const std::vector<std::uint32_t>& bits, std::size_t i) {
  return (bits[i / 32] >> (i % 32)) & 1u;
}

/// Compares all kernels, in spans and bundles, with what the test has sorted out; how many rays of
/// those that would hit something without a filter still do, and how many do not.
std::pair<int, int> expect_filtered(const SceneView& scene, const RayList& rays,
                                    const Lottery& lottery) {
  SceneView opaque = scene;
  opaque.filter.accepts = [](const void*, const HitQuery*, std::uint32_t n, bool* accepted) {
    std::fill_n(accepted, n, true);
  };
  std::vector<Hit> expected;
  int same = 0, other = 0;
  BundleList bundles;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    const Ray ray = rays[i];
    expected.push_back(sorted_out(scene, ray, lottery));
    const Hit& hit = expected.back();
    const Hit brute = intersect_brute_force(scene, ray), scalar = intersect_scalar(scene, ray);
    EXPECT_EQ(std::memcmp(&brute, &hit, sizeof(Hit)), 0) << "brute force, ray " << i;
    EXPECT_EQ(std::memcmp(&scalar, &hit, sizeof(Hit)), 0) << "the specification, ray " << i;
    EXPECT_EQ(occluded_brute_force(scene, ray), hit.valid()) << i;
    EXPECT_EQ(occluded_scalar(scene, ray), hit.valid()) << i;
    const Hit all = intersect_scalar(opaque, ray);
    if (all.valid()) ++(std::memcmp(&all, &hit, sizeof(Hit)) == 0 ? same : other);
    if (i % 3 == 0) bundles.add_point(ray);
    bundles.add_ray(ray.direction, ray.t_max, ray.path_key);
  }
  std::vector<bool> in_bundles;
  const RayBundles view = bundles.view();
  for (std::uint32_t p = 0; p < view.point_count; ++p) {
    for (std::uint32_t i = view.first_ray[p]; i < view.first_ray[p + 1]; ++i) {
      in_bundles.push_back(sorted_out(scene, view.ray(p, i), lottery).valid());
    }
  }
  for (const std::string& isa : built_instruction_sets()) {
    force_instruction_set(isa);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint32_t> bits((rays.size() + 31) / 32), together(bits.size());
    intersect(scene, rays.span(), hits.data());
    occluded(scene, rays.span(), bits.data());
    occluded(scene, view, together.data());
    int wrong = 0, wrong_any = 0, wrong_together = 0;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      wrong += std::memcmp(&expected[i], &hits[i], sizeof(Hit)) != 0;
      wrong_any += bit(bits, i) != expected[i].valid();
      wrong_together += bit(together, i) != in_bundles[i];
    }
    EXPECT_EQ(wrong, 0) << isa;
    EXPECT_EQ(wrong_any, 0) << isa;
    EXPECT_EQ(wrong_together, 0) << isa;
  }
  force_instruction_set("");
  return {same, other};
}

RayList keyed(const RayList& rays) {
  RayList with_keys;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    Ray ray = rays[i];
    ray.path_key = hash_bits(i / 2);
    with_keys.push_back(ray);
  }
  return with_keys;
}

/// A crumpled sheet: rays meet it many times, in leaves that lie one upon the other.
TriangleMesh crumpled() {
  TriangleMesh mesh;
  constexpr int n = 14;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      const double s = 6.0 * x / n, t = 6.0 * y / n;
      mesh.vtx2xyz.insert(mesh.vtx2xyz.end(), {float(std::sin(2 * s) + 0.2 * std::cos(5 * t)),
                                               float(std::sin(2 * t) + 0.2 * std::cos(5 * s)),
                                               float(0.2 * std::sin(s * t))});
    }
  }
  for (std::uint32_t v = 0; v < n * (n + 1); ++v) {
    if (v % (n + 1) == n) continue;
    mesh.tri2vtx.insert(mesh.tri2vtx.end(), {v, v + 1, v + n + 2, v, v + n + 2, v + n + 1});
  }
  return mesh;
}

TEST(Filter, OfSomeInstancesForEveryBuilderAndKernel) {
  const TriangleMesh mesh = crumpled();
  for (const Builder builder :
       {Builder::kLinear, Builder::kSah, Builder::kPrincipalAxis, Builder::kList}) {
    for (const int instances : {1, 12}) {
      TestScene scene(2);
      scene.add_mesh(mesh, builder);
      std::mt19937 random(1);
      std::normal_distribution<double> number;
      for (int i = 0; i < instances; ++i) {
        Mat3d m(1.0);
        for (int k = 0; i > 0 && k < 9; ++k) m[k / 3][k % 3] = number(random);
        if (i % 3 == 2) m[2] *= -1e-4;
        const Vec3 at =
            i == 0 ? Vec3(0.0f) : Vec3(Vec3d(number(random), number(random), number(random)));
        scene.add_instance(0, m, at, i % 4 == 3 ? kMaskShadow : kMaskAll);
      }
      scene.add_instance(0);  // what lies on it is as near: the smaller index counts
      const Lottery lottery(0.4);
      scene.set_filter(lottery.filter(), [](std::uint32_t i) { return i % 5 != 1; });
      scene.commit(builder);
      RayMaker maker(mesh, Aabb{Vec3(-2.0f), Vec3(2.0f)}, 3);
      RayList rays;
      for (std::uint32_t i = 0; i < 1800; ++i) {
        Ray ray = maker.make(static_cast<int>(i) % RayMaker::kKinds);
        if (i % 5 == 2) ray.mask = kMaskShadow;
        if (i % 7 == 0) ray.self_instance = i % 3, ray.self_primitive = i % 300;
        if (i % 6 == 1) ray.t_max = 0.8f;
        rays.push_back(ray);
      }
      const auto [same, other] = expect_filtered(scene.view(), keyed(rays), lottery);
      EXPECT_GT(same, 200);
      EXPECT_GT(other, 200);
    }
  }
}

TEST(Filter, IsAskedOfInstancesThatAreFilteredAlone) {
  TestScene scene;
  scene.add_mesh(crumpled());
  scene.add_instance(0);
  scene.add_instance(0, Mat3d(1.0), Vec3(0.3f, 0.2f, 0.1f));
  scene.commit();
  const RayList rays = RayMaker(scene.mesh(0), scene.tree(0).bounds, 3).make_list(600);
  const auto traced = [&] {
    std::vector<Hit> hits(600);
    std::vector<std::uint32_t> bits(19);
    intersect(scene.view(), rays.span(), hits.data());
    occluded(scene.view(), rays.span(), bits.data());
    return std::pair(hits, bits);
  };
  const auto [hits, bits] = traced();
  Collector collector;
  scene.set_filter(collector.filter(), [](std::uint32_t i) { return i == 1; });
  traced();
  const std::vector<HitQuery> asked = collector.take();
  EXPECT_GT(asked.size(), 100u);
  for (const HitQuery& query : asked) EXPECT_EQ(query.hit.instance, 1u);
  const Lottery all(1.0);
  scene.set_filter(all.filter(), [](std::uint32_t) { return true; });
  const auto [hits_of_all, bits_of_all] = traced();
  EXPECT_GT(all.asked(), 300u);
  EXPECT_EQ(std::memcmp(hits.data(), hits_of_all.data(), 600 * sizeof(Hit)), 0);
  EXPECT_EQ(bits, bits_of_all);
}

TEST(Filter, KeysStandWhereDirectionsDo) {
  TestScene scene;
  scene.add_mesh(crumpled());
  scene.add_instance(0);
  const Lottery lottery(0.3);
  scene.set_filter(lottery.filter(), [](std::uint32_t) { return true; });
  scene.commit();
  BundleList list;
  Ray ray;
  ray.origin = Vec3(0.1f, 0.2f, 3.0f);
  list.add_point(ray);
  for (std::uint32_t i = 0; i < 500; ++i) {  // one direction: keys alone decide
    list.add_ray(Vec3(0.02f, 0.01f, -1.0f), kFloatMax, hash_bits(i));
  }
  std::vector<std::uint32_t> place(500);
  for (std::uint32_t i = 0; i < 500; ++i) place[i] = (i * 7 + 3) % 500;
  RayBundles bundles = list.view();
  bundles.place = place.data();
  int met = 0;
  for (const std::string& isa : built_instruction_sets()) {
    force_instruction_set(isa);
    std::vector<std::uint32_t> bits(16);
    occluded(scene.view(), bundles, bits.data());
    for (std::uint32_t i = 0; i < 500; ++i) {
      const Ray alone = bundles.ray(0, i);
      EXPECT_EQ(alone.path_key, hash_bits(place[i]));
      EXPECT_EQ(bit(bits, i), sorted_out(scene.view(), alone, lottery).valid()) << isa << i;
      met += bit(bits, i);
    }
  }
  force_instruction_set("");
  EXPECT_GT(met, 100);
}

/// One material, which is see-through, for all; the list of slots 1 is empty.
std::shared_ptr<Scene> with_filter(std::shared_ptr<Scene> scene, const Lottery& lottery) {
  SceneTables tables;
  tables.materials = {{1.0f, 1}};
  tables.slot_begin = {0, 1, 1};
  tables.slots = {0};
  scene->set_tables(std::move(tables));
  scene->set_hit_filter(lottery.filter(), {1});
  return committed(scene);
}

TEST(Filter, OfThingsThatMoveAndDeform) {
  const auto waving = deforming(sphere(9, Vec3d(0), 1.5, false), 4, [](const Vec3d& p, double t) {
    return p + Vec3d(2.0 * t * t, 0.4 * std::sin(7.0 * p.x + 5.0 * t), t);
  });
  const auto still = sphere(8, Vec3d(0), 1.2, false).mesh();
  const Lottery lottery(0.5);
  auto scene = make_scene({{waving},
                           {still, translated(1, 1, 1)},
                           {still, glm::scale(translated(0, 0, 2), Vec3d(1, 1, 0))}},
                          camera_at({9, 0, 0}, {0, 0, 0}, 10, 10));
  for (const auto& mesh : {still, waving}) {
    add_moving(
        *scene, mesh,
        [](double t) { return glm::rotate(translated(-1, -1, 3.0 * t), 4.0 * t, Vec3d(0, 1, 0)); },
        5);
  }
  with_filter(scene, lottery);
  const Vec3 centre(-scene->origin());
  const auto [same, other] =
      expect_filtered(scene->view(), keyed(random_rays(2000, centre, 3.0f)), lottery);
  EXPECT_GT(same, 200);
  EXPECT_GT(other, 200);
}

TEST(Filter, OfCurvesAndPoints) {
  std::vector<float> centres, radii;
  std::mt19937 random(2);
  std::uniform_real_distribution<float> number(-1.5f, 1.5f);
  for (int i = 0; i < 300; ++i) {
    for (int c = 0; c < 3; ++c) centres.push_back(number(random));
    radii.push_back(0.1f);
  }
  const auto built = [](const auto& input) {
    return Mesh::build(input, Builder::kSah, shared_pool(), Cancel());
  };
  const auto move = [](const Vec3d& p, double t) { return p + Vec3d(0.3 * t, 0, p.x * t); };
  const MovedKeys moved(centres, radii, 4, move, [](double r, double) { return r; });
  PointsInput points{"cloud", moved.rest_xyz, moved.rest_radius};
  points.motion = moved.motion();
  for (const CurveShape shape :
       {CurveShape::kRibbon, CurveShape::kThick, CurveShape::kThickLinear}) {
    const auto fur = made_fur(250, 4, 1.0, 0.03, 0.6, shape);
    const Lottery lottery(0.5);
    const auto scene = with_filter(make_scene({{built(fur.input())}, {built(points)}},
                                              camera_at({9, 0, 0}, {0, 0, 0}, 10, 10)),
                                   lottery);
    const auto [same, other] = expect_filtered(
        scene->view(), keyed(random_rays(1500, Vec3(-scene->origin()), 1.6f)), lottery);
    EXPECT_GT(same, 150);
    EXPECT_GT(other, 150);
  }
}

TEST(Filter, NeedsToKnowOfAllMaterialsAndTakesThemByList) {
  const Lottery lottery(0.0);
  const auto square = quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}).mesh();
  for (const std::size_t count : {0u, 2u}) {
    auto scene = make_scene({{square}}, camera_at({0, 0, 9}, {0, 0, 0}, 10, 10));
    SceneTables tables;
    tables.materials = {{}};
    scene->set_tables(std::move(tables));
    scene->set_hit_filter(lottery.filter(), std::vector<std::uint8_t>(count, 1));
    EXPECT_THROW(committed(scene), std::invalid_argument);
  }
  auto scene = std::make_shared<Scene>();
  const std::uint32_t mesh = scene->add_mesh(square);
  for (std::uint32_t list = 0; list < 4; ++list) {
    const InstanceInput input{mesh, translated(0, 0, -double(list)), 0, kMaskAll, 0, list};
    scene->add_instances({&input, 1}, "test");
  }
  SceneTables tables;
  tables.materials = {{}, {}};
  tables.slot_begin = {0, 2, 2, 3};
  tables.slots = {0, 1, 0};
  scene->set_tables(std::move(tables));
  scene->set_hit_filter(lottery.filter(), {0, 1});
  committed(scene);
  for (std::uint32_t i = 0; i < 4; ++i) {  // opaque, no slots and an unknown list are never asked
    EXPECT_EQ(scene->view().instances[i].filtered, i == 0 ? 1u : 0u);
  }
}

}  // namespace
}  // namespace komorebi::testing
