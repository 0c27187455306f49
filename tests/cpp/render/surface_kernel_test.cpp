// Surface points worked out in lanes are those of surface_point, and their terminators those of
// terminator, to the bit, for every instruction set: smooth and flat, mirrored, sheared, flattened,
// far away, huge, tiny and degenerate.
#include <gtest/gtest.h>

#include <algorithm>

#include "bvh/traverse.h"
#include "render/filter.h"
#include "render/one_ray.h"
#include "render/ray_batch.h"
#include "render/surface_batch.h"
#include "support/made_curves.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

std::shared_ptr<Scene> odd_scene() {
  const auto smooth = sphere(12, Vec3d(0), 1.0, true).mesh();
  // Of one user each: its normals are interpolated in the world.
  const auto once = sphere(6, Vec3d(0), 1.0, true).mesh();
  const auto bulging = deforming(sphere(6, Vec3d(0), 1.0, true), 2,
                                 [](const Vec3d& p, double t) { return (1.0 + 0.2 * t) * p; });
  const auto flat = sphere(7, Vec3d(0), 1.0, false).mesh();
  const auto put = [](double x, double y, double z, const Vec3d& size) {
    return glm::scale(glm::translate(Mat4d(1.0), Vec3d(x, y, z)), size);
  };
  Mat4d sheared = put(-2, 1, 1, Vec3d(1));
  sheared[2][0] = 0.8;
  Mat4d once_sheared = put(0.6, -3.4, 0.5, Vec3d(0.3, -0.4, 0.4));
  once_sheared[1][2] = 0.3;
  const Curves flat_hair = made_fur(400, 5, 0.6, 0.04, 2.0, CurveShape::kRibbon);
  const Curves thick_hair = made_fur(400, 5, 0.6, 0.04, 2.0, CurveShape::kThick);
  const Curves straight_hair = made_fur(400, 5, 0.6, 0.04, 2.0, CurveShape::kThickLinear);
  const std::vector<float> points = {0, 0, 0, 0.5f, 0.2f, 0, 0, 0.5f, 0.4f},
                           radii = {0.4f, 0.3f, 0.2f};
  const auto ribbons = Mesh::build(flat_hair.input(), Builder::kSah, shared_pool(), Cancel());
  const auto strands = Mesh::build(thick_hair.input(), Builder::kSah, shared_pool(), Cancel());
  const auto wires = Mesh::build(straight_hair.input(), Builder::kSah, shared_pool(), Cancel());
  const PointsInput three{"three", points, radii};
  const auto balls = Mesh::build(three, Builder::kSah, shared_pool(), Cancel());
  Polygons sliver;  // one of these triangles has no area, the other hardly any
  for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(2, 0, 0), Vec3d(1, 1e-6, 0.5)}) {
    sliver.vertex(p);
  }
  sliver.face({0, 1, 2});
  sliver.face({0, 1, 3});
  auto scene = make_scene({{quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}).mesh()},
                           {smooth, put(0, 0, 1, Vec3d(1))},
                           {smooth, put(2, 1, 1, Vec3d(-1, 1, 0.5))},
                           {once, once_sheared},
                           {bulging, put(-2.5, -1.2, 1.6, Vec3d(0.6, 0.3, 0.5))},
                           {flat, sheared},
                           {flat, put(1, -2, 1, Vec3d(0.7, 0.7, 0))},
                           {flat, put(0, 3, 1, Vec3d(1e-4))},
                           {smooth, put(0, 700, 60, Vec3d(300))},
                           {sliver.mesh(), put(-1, -2, 0.5, Vec3d(2))},
                           {ribbons, put(-1.5, -1, 0.4, Vec3d(0.4, 0.3, -0.3))},
                           {strands, put(3, -1, 0.4, Vec3d(0.3))},
                           {wires, put(2.7, -3.2, 0.4, Vec3d(0.3))},
                           {balls, put(1.8, -2.2, 0.9, Vec3d(0.5, 0.5, 0.2))},
                           {balls, put(1.5, -3.0, 0.4, Vec3d(0.5, 0.5, 0))}},
                          camera_at({4, -6, 3}, {0, 0, 0.8}, 160, 100));
  SceneTables tables;
  tables.objects.resize(1);
  tables.objects[0].terminator_cutoff = 0.3f;
  tables.objects[0].terminator_frequency = 1.25f;
  scene->set_tables(std::move(tables));
  return scene;
}

void expect_equal_to_surface_point(const std::shared_ptr<Scene>& scene, std::ptrdiff_t seen) {
  const FilterTable filter(PixelFilter::kBlackmanHarris, 1.5f);
  const RenderContext context = make_context(*scene, Settings{}, filter.view());
  RayBatch rays;
  for (std::uint32_t y = 0; y < 100; ++y) {
    for (std::uint32_t x = 0; x < 160; ++x) {
      Ray ray = start_ray(context, x, y, y % 5);
      ray.time = static_cast<float>(x % 8) / 7.0f;
      rays.push(ray);
    }
  }
  std::vector<Hit> hits(rays.size());
  intersect(context.scene, rays.span(), hits.data());
  std::uint32_t lifted = 0;
  std::vector<std::uint32_t> hit_once(scene->view().instance_count, 0);
  for (const std::string& name : built_instruction_sets()) {
    force_instruction_set(name);
    SurfaceBatch surfaces;
    surfaces.clear(rays.size());
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      if (!hits[i].valid()) continue;
      surfaces.push(i, hits[i], rays.span().time[i], i, 3 * i);
      ++hit_once[hits[i].instance];
    }
    surfaces.fill(context, hits.data(), rays.span());
    const LightBlock block = surfaces.light_block(context, 0, surfaces.size());
    for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
      const std::uint32_t i = surfaces.path(s);
      const SurfacePoint expected = surface_point(context.scene, hits[i], rays.span()[i]);
      const Vec3 geometric(block.geometric_normal[0][s], block.geometric_normal[1][s],
                           block.geometric_normal[2][s]);
      ASSERT_EQ(surfaces.normal(s), expected.normal) << name << " " << i;
      ASSERT_EQ(geometric, expected.geometric_normal) << name << " " << i;
      ASSERT_EQ(surfaces.leaving_origin(s), leaving_origin(expected)) << name << " " << i;
      const Terminator end =
          terminator(context, hits[i], rays.span().time[i], expected.geometric_normal);
      ASSERT_EQ(surfaces.lift(s), end.lift) << name << " " << i;
      ASSERT_EQ(surfaces.cutoff(s), end.cutoff) << name << " " << i;
      ASSERT_EQ(surfaces.frequency(s), end.frequency) << name << " " << i;
      lifted += end.cutoff > 0.0f;
      ASSERT_EQ(surfaces.depth(s), camera_depth(context.camera, expected.position)) << name;
    }
  }
  force_instruction_set("");
  EXPECT_GT(lifted, 1000u);
  EXPECT_GE(std::count_if(hit_once.begin(), hit_once.end(), [](auto n) { return n > 0; }), seen);
}

TEST(SurfaceKernel, EqualsSurfacePoint) {
  // All but the tiny one and the points without volume are in the picture.
  expect_equal_to_surface_point(committed(odd_scene()), 12);
}

TEST(SurfaceKernel, DepthOfAPanoramaIsEqualToo) {
  const auto scene = odd_scene();
  CameraDesc camera = scene->camera_desc();
  camera.kind = CameraKind::kPanorama;
  camera.world_from_camera[3] = glm::dvec4(4, -6, 3, 1);
  scene->set_camera(camera);
  expect_equal_to_surface_point(committed(scene), 4);
}

}  // namespace
}  // namespace komorebi::testing
