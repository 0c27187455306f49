#pragma once

#include <cmath>
#include <random>

#include "support/ray_list.h"
#include "support/test_scene.h"

namespace komorebi::testing {

/// A view of the first mesh of a scene: one ray per pixel of a square picture.
inline RayList camera_rays(const TestScene& scene, int size) {
  const Aabb box = scene.tree(0).bounds;
  const Vec3 diagonal = box.hi - box.lo;
  const Vec3 forward = glm::normalize(Vec3(-0.3f, -0.4f, -1.0f));
  const Vec3 right = glm::normalize(glm::cross(forward, Vec3(0, 1, 0)));
  const Vec3 up = glm::cross(right, forward);
  RayList rays;
  for (int i = 0; i < size * size; ++i) {
    const float x = (float(i % size) + 0.5f) / float(size) - 0.5f;
    const float y = (float(i / size) + 0.5f) / float(size) - 0.5f;
    Ray ray;
    ray.origin = centre(box) - forward * std::sqrt(glm::dot(diagonal, diagonal));
    ray.direction = forward + x * right + y * up;
    rays.push_back(ray);
  }
  return rays;
}

/// `count` cosine-distributed rays from every point that the camera rays hit, `reach` of the
/// mesh's diagonal long (0: unlimited).
inline RayList ambient_rays(const TestScene& scene, const RayList& camera, int count, float reach) {
  std::vector<Hit> hits(camera.size());
  intersect(scene.view(), camera.span(), hits.data());
  const TriangleMesh& mesh = scene.mesh(0);
  const Vec3 diagonal = scene.tree(0).bounds.hi - scene.tree(0).bounds.lo;
  const float length = std::sqrt(glm::dot(diagonal, diagonal));
  std::mt19937 random(1);
  std::uniform_real_distribution<float> number(0.0f, 1.0f);
  RayList rays;
  for (std::uint32_t i = 0; i < camera.size(); ++i) {
    const Hit& hit = hits[i];
    if (!hit.valid()) continue;
    Vec3 corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const float* p = &mesh.vtx2xyz[3 * std::size_t{mesh.tri2vtx[3 * hit.primitive + k]}];
      corner[k] = Vec3(p[0], p[1], p[2]);
    }
    const Vec3 point = (1.0f - hit.u - hit.v) * corner[0] + hit.u * corner[1] + hit.v * corner[2];
    Vec3 normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    if (glm::dot(normal, camera[i].direction) > 0.0f) normal = -normal;
    const Vec3 side = glm::normalize(
        glm::cross(normal, std::abs(normal.x) < 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    for (int k = 0; k < count; ++k) {
      const float u = (float(k) + number(random)) / float(count);
      const float phi = 6.2831853f * number(random);
      Ray ray;
      ray.origin = point + 1e-6f * length * normal;
      ray.direction = std::sqrt(u) * std::cos(phi) * side +
                      std::sqrt(u) * std::sin(phi) * glm::cross(normal, side) +
                      std::sqrt(1.0f - u) * normal;
      if (reach > 0.0f) ray.t_max = reach * length;
      ray.self_instance = 0;
      ray.self_primitive = hit.primitive;
      rays.push_back(ray);
    }
  }
  return rays;
}

}  // namespace komorebi::testing
