#pragma once

#include <random>

#include "core/aabb.h"
#include "support/mesh_file.h"
#include "support/ray_list.h"

namespace komorebi::testing {

/// Rays that find the weak places of a tracer, made for one mesh: through its box at random, along
/// the axes, in the planes of its triangles, at its edges and vertices, and from its surface.
class RayMaker {
 public:
  RayMaker(const TriangleMesh& mesh, const Aabb& box, unsigned seed)
      : mesh_(mesh), middle_(centre(box)), random_(seed) {
    const Vec3 half = box.hi - middle_;
    radius_ = std::sqrt(glm::dot(half, half));
    if (!(radius_ > 0.0f) || box.is_empty()) radius_ = 1.0f;
    if (box.is_empty()) middle_ = Vec3(0.0f);
  }

  static constexpr int kKinds = 7;

  Ray make(int kind) {
    switch (kind) {
      case 0:
        return towards(outside(), middle_ + 0.7f * radius_ * cube());
      case 1:
        return along_axis();
      case 2:
        return grazing();
      case 3:
        return towards(outside(), on_edge(some_triangle()));
      case 4:
        return towards(outside(), corner(some_triangle(), 0));
      case 5:
        return from_surface();
      default:
        return inside_out();
    }
  }

  /// Rays of all kinds in turn.
  RayList make_list(std::uint32_t count) {
    RayList rays;
    for (std::uint32_t i = 0; i < count; ++i) rays.push_back(make(static_cast<int>(i) % kKinds));
    return rays;
  }

 private:
  float uniform(float from, float to) {
    return std::uniform_real_distribution<float>(from, to)(random_);
  }
  Vec3 cube() { return Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); }
  Vec3 outside() {
    Vec3 direction = cube();
    while (glm::dot(direction, direction) < 0.01f) direction = cube();
    return middle_ + direction * (2.5f * radius_ / std::sqrt(glm::dot(direction, direction)));
  }
  static Ray towards(const Vec3& origin, const Vec3& target) {
    Ray ray;
    ray.origin = origin;
    ray.direction = target - origin;
    return ray;
  }
  std::size_t some_triangle() {
    if (mesh_.triangle_count() == 0) return 0;
    return std::uniform_int_distribution<std::size_t>(0, mesh_.triangle_count() - 1)(random_);
  }
  Vec3 corner(std::size_t triangle, std::size_t which) {
    if (mesh_.triangle_count() == 0) return middle_;
    const float* p = &mesh_.vtx2xyz[3 * std::size_t{mesh_.tri2vtx[3 * triangle + which % 3]}];
    return Vec3(p[0], p[1], p[2]);
  }
  Vec3 on_edge(std::size_t triangle) {
    const Vec3 a = corner(triangle, 0), b = corner(triangle, 1);
    return a + uniform(0, 1) * (b - a);
  }
  Vec3 on_triangle(std::size_t triangle) {
    const float u = uniform(0, 1), v = uniform(0, 1 - u);
    const Vec3 a = corner(triangle, 0);
    return (a + u * (corner(triangle, 1) - a)) + v * (corner(triangle, 2) - a);
  }

  /// Two components exactly zero (of either sign); often straight through a vertex.
  Ray along_axis() {
    const int axis = std::uniform_int_distribution<int>(0, 2)(random_);
    Ray ray;
    ray.origin = uniform(0, 1) < 0.5f ? corner(some_triangle(), 0) : middle_ + radius_ * cube();
    ray.direction = uniform(0, 1) < 0.5f ? Vec3(0.0f) : Vec3(-0.0f);
    ray.direction[axis] = uniform(0, 1) < 0.5f ? 1.0f : -1.0f;
    ray.origin[axis] = middle_[axis] - 2.0f * radius_ * ray.direction[axis];
    return ray;
  }
  /// In the plane of a triangle, up to rounding.
  Ray grazing() {
    const std::size_t triangle = some_triangle();
    const Vec3 target = on_triangle(triangle);
    Vec3 direction = target - corner(triangle, 1);
    const float length = std::sqrt(glm::dot(direction, direction));
    if (!(length > 0.0f)) return towards(outside(), target);
    direction *= 1.0f / length;
    return towards(target - direction * (2.0f * radius_), target);
  }
  /// As shadow rays leave: exactly on a triangle that is not to be hit, to a point some way off.
  Ray from_surface() {
    const std::size_t triangle = some_triangle();
    Ray ray = towards(on_triangle(triangle), middle_ + 1.5f * radius_ * cube());
    ray.t_max = uniform(0.05f, 1.0f);
    if (uniform(0, 1) < 0.5f) {
      ray.self_instance = 0;
      ray.self_primitive = static_cast<std::uint32_t>(triangle);
    }
    return ray;
  }
  Ray inside_out() {
    Ray ray = towards(middle_ + 0.5f * radius_ * cube(), outside());
    if (uniform(0, 1) < 0.3f) ray.t_min = -1.0f;
    if (uniform(0, 1) < 0.3f) ray.direction *= 1e-3f;
    return ray;
  }

  const TriangleMesh& mesh_;
  Vec3 middle_;
  float radius_ = 1.0f;
  std::mt19937 random_;
};

}  // namespace komorebi::testing
