#pragma once

#include "core/math.h"
#include "core/surface_point.h"

namespace komorebi {

/// What keeps coarse smooth meshes from shadowing themselves in facets where light grazes them, as
/// Cycles does it (intern/cycles/kernel/light/sample.h and kernel/closure/bsdf.h, release 3.4):
/// rays that graze leave a point above the flat triangle, and the cosine's last part is cut off.
struct Terminator {
  Vec3 lift{0.0f};         ///< world space: from the triangle to about the smooth surface
  float cutoff = 0.0f;     ///< cosine below which rays are lifted; 0: none
  float frequency = 1.0f;  ///< of the cosine over the angle, at least 1
};

namespace detail {

/// How far the planes through the corners along their normals reach above a point of the triangle,
/// at least: the envelope of a convex surface.
inline float convex_reach(const Vec3 (&corner)[3], const Vec3 (&normal)[3], const Vec3& at,
                          float side) {
  float least = 3.402823466e+38f;
  for (int i = 0; i < 3; ++i) {
    const Vec3 to_next = side * (corner[(i + 1) % 3] - corner[i]);
    const Vec3 to_last = side * (corner[(i + 2) % 3] - corner[i]);
    float rise = glm::max(glm::dot(to_next, normal[i]), glm::dot(to_last, normal[i]));
    rise = glm::max(rise, 0.0f);
    rise = glm::max(glm::dot(side * (corner[i] - at), normal[i]) + rise, 0.0f);
    least = glm::min(least, rise);
  }
  return least;
}

}  // namespace detail

/// From a hit on a smooth triangle to the surface that its normals tell of, in world space; null
/// where the triangle is flat. `geometric_normal` is on the side that light comes from.
inline Vec3 smooth_lift(const SceneView& scene, const Hit& hit, float time,
                        const Vec3& geometric_normal) {
  const MeshView& mesh = scene.meshes[scene.instances[hit.instance].mesh];
  const bool smooth =
      !is_round(mesh.kind) && mesh.normals && (!mesh.tri2smooth || mesh.tri2smooth[hit.primitive]);
  if (!smooth) return Vec3(0.0f);
  // In the world's lengths and angles: a stretched object's surface is bent otherwise.
  InstanceView room;
  const InstanceView& instance = instance_at(scene, hit.instance, time, room);
  const Mat3 normal_transform = glm::transpose(instance.local_from_world);
  const Corners corners = detail::triangle_corners(mesh, hit.primitive, time);
  const Corners normals = corner_normals(mesh, hit.primitive, time);
  Vec3 corner[3], normal[3];
  for (int k = 0; k < 3; ++k) {
    corner[k] = instance.world_from_local * corners.corner[k];
    normal[k] = detail::unit_or(normal_transform * normals.corner[k], geometric_normal);
  }
  const float v = hit.u, w = hit.v, u = 1.0f - v - w;
  const Vec3 at = u * corner[0] + v * corner[1] + w * corner[2];
  const Vec3 up = u * normal[0] + v * normal[1] + w * normal[2];

  // The height of a paraboloid through the corners with about these normals.
  const float bend_u = glm::dot(normal[2] - normal[0], corner[0] - corner[2]);
  const float bend_v = glm::dot(normal[2] - normal[1], corner[1] - corner[2]);
  const float bend_uv = glm::dot(normal[1] - normal[0], corner[1] - corner[0]);
  const float height =
      bend_u * u * (u - 1.0f) + (bend_u + bend_v + bend_uv) * u * v + bend_v * v * (v - 1.0f);
  const bool outer = glm::dot(up, geometric_normal) > 0.0f;
  const float reach = detail::convex_reach(corner, normal, at, outer ? 1.0f : -1.0f);
  return up * (outer ? glm::max(reach, 0.5f * height) : glm::min(-reach, 0.5f * height));
}

/// Which part of the lift a ray starts at: all of it where it grazes, none from the cutoff on.
/// Cosines to the shading normal (positive) and the geometric one.
inline float lifted_share(float cutoff, float cosine, float geometric_cosine) {
  const float share = cosine < cutoff ? 2.0f - (geometric_cosine + cosine) / cutoff
                                      : 1.0f - geometric_cosine / cutoff;
  return glm::clamp(share, 0.0f, 1.0f);
}

/// What remains of light that comes at this cosine > 0: cos(frequency · angle) / cos(angle).
inline float cosine_left(float frequency, float cosine) {
  const float c = glm::min(cosine, 1.0f);
  const float angle = atan2_radians(std::sqrt(1.0f - c * c), c);
  return glm::max(sin_cos_turns(angle * frequency * kInvTwoPi).cos, 0.0f) / c;
}

}  // namespace komorebi
