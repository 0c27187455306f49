// What scattered rays cover of a surface, and how attributes change across it.
#include "render/ray_cone.h"

#include <gtest/gtest.h>

#include "bvh/traverse.h"
#include "support/materials.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

TEST(RayCone, CoversAsMuchAsItIsWideAcrossTheRayAndAttributesFollow) {
  // A stretched, turned ball of which an attribute is the place itself.
  const Polygons ball = sphere(12, Vec3d(0.0), 1.0, false);
  std::vector<float> place;
  for (const std::int32_t v : ball.corner2vtx) {
    const float* p = &ball.vtx2xyz[3 * std::size_t(v)];
    place.insert(place.end(), {p[0], p[1], p[2]});
  }
  MeshInput input = ball.input();
  input.attributes = {{"place", AttributeDomain::kCorner, 3, place}};
  const auto mesh = Mesh::build(input, Builder::kLinear, shared_pool(), Cancel(), nullptr);
  const Mat4d pose = glm::rotate(Mat4d(1.0), 0.7, glm::normalize(Vec3d(1, 2, 3))) *
                     glm::scale(Mat4d(1.0), Vec3d(2.0, 0.5, 1.0));
  auto scene = std::make_shared<Scene>();
  const InstanceInput instance{scene->add_mesh(mesh), pose};
  scene->add_instances({&instance, 1}, "ball");
  scene->set_camera(camera_at({5, 0, 0}, {0, 0, 0}, 8, 8));
  const auto made = committed(scene);
  const FilterTable filter(Settings{}.pixel_filter, Settings{}.filter_width);
  const RenderContext context = make_context(*made, Settings{}, filter.view());

  MadeProgram asking;
  const auto program =
      asking.program({asking.input("cone_x"), asking.input("cone_y"),
                      asking.attribute("cone_x:place"), asking.attribute("cone_y:place")});
  MaterialPoints points;
  Program::Scratch scratch;
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const auto k = static_cast<float>(i);
    Ray ray;
    const Vec3 from =
        4.0f * glm::normalize(Vec3(std::sin(k), std::cos(1.7f * k), std::sin(0.3f * k)));
    const Vec3 to(0.3f * std::cos(k), 0.3f * std::sin(2.0f * k), 0.2f);
    ray.origin = Vec3(Vec3d(from) - made->origin());
    ray.direction = glm::normalize(to - from);
    ShadeTask task;
    task.hit = intersect_scalar(made->view(), ray);
    if (!task.hit.valid()) continue;
    ++met;
    task.point = surface_point(made->view(), task.hit, ray);
    task.direction = ray.direction;
    task.vertex = 1;
    float values[14];
    float* rows[14];
    for (int c = 0; c < 14; ++c) rows[c] = &values[c];
    program->run(points.fill(context, *program, &task, 1), scratch, rows);
    const Vec3 normal = task.point.geometric_normal;
    const Mat3d into_local = glm::inverse(Mat3d(pose));
    const float width = kScatterSpread * task.hit.t;
    for (int way = 0; way < 2; ++way) {
      const Vec3 step(values[3 * way], values[3 * way + 1], values[3 * way + 2]);
      EXPECT_NEAR(glm::dot(step, normal), 0.0f, 1e-5f * glm::length(step));
      EXPECT_NEAR(glm::length(step - glm::dot(step, task.direction) * task.direction), width,
                  1e-3f * width);
      const Vec3 change(values[6 + 4 * way], values[7 + 4 * way], values[8 + 4 * way]);
      const Vec3 expected(into_local * Vec3d(step));
      EXPECT_LT(glm::length(change - expected), 1e-4f * (1.0f + glm::length(expected)));
    }
  }
  EXPECT_GT(met, 100);
}

}  // namespace
}  // namespace komorebi::testing
