#include "bvh/closest.h"
#include "bvh/moving_leaf.h"
#include "bvh/round_leaf.h"
#include "bvh/traverse.h"
#include "core/instance_motion.h"

namespace komorebi {
namespace {

Vec3 corner(const MeshView& mesh, std::uint32_t triangle, std::uint32_t which) {
  const float* xyz =
      &mesh.vtx2xyz[3 * std::size_t{mesh.tri2vtx[3 * std::size_t{triangle} + which]}];
  return Vec3(xyz[0], xyz[1], xyz[2]);
}

template <bool kAny>
Hit test_everything(const SceneView& scene, const Ray& ray) {
  Closest closest(ray);
  const SlabRay world = make_world_slab(ray);
  if (!is_usable(world)) return closest.hit;
  for (std::uint32_t index = 0; index < scene.instance_count; ++index) {
    LocalRay local;
    InstanceView room;
    const InstanceView& instance = instance_at(scene, index, ray.time, room);
    if (!enter_instance(instance, ray, world, &local)) continue;
    const MeshView& mesh = scene.meshes[instance.mesh];
    const HitTest test(scene, index, ray);
    const std::uint32_t self = index == ray.self_instance ? ray.self_primitive : kNone;
    if (mesh.kind == PrimitiveKind::kMovingTriangle) {
      const SetPlace place = set_place(mesh.position_sets, ray.time);
      for (std::uint32_t i = 0; i < mesh.triangle_count; ++i) {
        const auto meet = [&](Closest* to) {
          return test_moving_triangle(mesh, local, place, self, index, i, to);
        };
        const bool found = test.keep(meet, &closest);
        if (kAny && found) return closest.hit;
      }
      continue;
    }
    if (is_round(mesh.kind)) {
      const RoundRay round =
          make_round_ray(local, local_direction(instance, ray), round_time(mesh, ray.time));
      for (std::uint32_t i = 0; i < mesh.primitive_count * mesh.segment_parts; ++i) {
        const auto meet = [&](Closest* to) {
          return test_round_item(mesh, round, self, index, i, to);
        };
        const bool found = test.keep(meet, &closest);
        if (kAny && found) return closest.hit;
      }
      continue;
    }
    for (std::uint32_t i = 0; i < mesh.triangle_count; ++i) {
      const Vec3 a = corner(mesh, i, 0), b = corner(mesh, i, 1), c = corner(mesh, i, 2);
      if (is_degenerate(a, b, c)) continue;
      const auto meet = [&](Closest* to) {
        return test_triangle(local, ray, index, i, a, b, c, to);
      };
      const bool found = test.keep(meet, &closest);
      if (kAny && found) return closest.hit;
    }
  }
  return closest.hit;
}

}  // namespace

Hit intersect_brute_force(const SceneView& scene, const Ray& ray) {
  return test_everything<false>(scene, ray);
}

bool occluded_brute_force(const SceneView& scene, const Ray& ray) {
  return test_everything<true>(scene, ray).valid();
}

}  // namespace komorebi
