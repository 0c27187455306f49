#pragma once

#include <cmath>

#include "core/scene_view.h"

namespace komorebi {

/// Where a ray met a surface, in world space, oriented towards where the ray came from.
struct SurfacePoint {
  Vec3 position{0.0f};
  Vec3 geometric_normal{0.0f, 0.0f, 1.0f};  ///< unit, on the ray's side
  Vec3 normal{0.0f, 0.0f, 1.0f};            ///< unit shading normal, flipped with the geometric one
  float offset = 0.0f;  ///< how far along the geometric normal the next ray must start
};

namespace detail {

/// Higham's bound for n float roundings (pbrt-v4 §6.8.1), u = 2⁻²⁴.
constexpr float gamma(int n) {
  const float nu = static_cast<float>(n) * 5.9604645e-8f;
  return nu / (1.0f - nu);
}

inline Vec3 abs_times(const Mat3& m, const Vec3& v) {
  return glm::abs(m[0]) * v.x + glm::abs(m[1]) * v.y + glm::abs(m[2]) * v.z;
}

/// Unit vector; scaled first, so that squares of tiny or huge lengths neither vanish nor overflow.
/// A null or non-finite vector gives `fallback`.
inline Vec3 unit_or(const Vec3& v, const Vec3& fallback) {
  const float scale = max_abs(v);
  if (!(scale > 0.0f && scale <= 3.402823466e+38f)) return fallback;
  const Vec3 s = v / scale;
  return s / std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
}

inline Vec3 vertex(const MeshView& mesh, std::uint32_t index) {
  const float* p = mesh.vtx2xyz + 3 * static_cast<std::size_t>(index);
  return {p[0], p[1], p[2]};
}

}  // namespace detail

/// The point of a hit with a carried error bound (pbrt-v4 §6.8.5): the position comes from the
/// barycentrics, not from t, so its error is a few ulps of the triangle's own coordinates. The
/// bound adds the rounding of the instance's transform and of the way back into the same local
/// space, so that a ray leaving by `offset` starts on the outer side of the surface as the tracer
/// sees it.
inline SurfacePoint surface_point(const SceneView& scene, const Hit& hit,
                                  const Vec3& ray_direction) {
  using namespace detail;
  const InstanceView& instance = scene.instances[hit.instance];
  const MeshView& mesh = scene.meshes[instance.mesh];
  const std::size_t tri = hit.primitive;
  const Vec3 a = vertex(mesh, mesh.tri2vtx[3 * tri]);
  const Vec3 ab = vertex(mesh, mesh.tri2vtx[3 * tri + 1]) - a;
  const Vec3 ac = vertex(mesh, mesh.tri2vtx[3 * tri + 2]) - a;
  const Vec3 along_ab = hit.u * ab;
  const Vec3 along_ac = hit.v * ac;
  const Vec3 local = a + along_ab + along_ac;
  // Rounding of the sum above; and the next ray's origin, in whose coordinates its triangle test
  // works, may not sit on the surface when an axis happens to have no rounding (z = 0).
  Vec3 local_error = gamma(5) * (glm::abs(a) + glm::abs(along_ab) + glm::abs(along_ac));
  local_error += Vec3(gamma(2) * max_abs(local));

  const Vec3 relative = instance.world_from_local * local;
  SurfacePoint point;
  point.position = relative + instance.position;
  // The next ray comes back by local_from_world · (position − instance.position): six roundings.
  local_error += gamma(6) * abs_times(instance.local_from_world, glm::abs(relative));
  const Vec3 error = abs_times(instance.world_from_local, local_error) +
                     gamma(5) * abs_times(instance.world_from_local, glm::abs(local)) +
                     gamma(2) * glm::abs(point.position);

  // Normals go by the inverse transpose, which keeps the outside outside under mirroring too.
  const Mat3 normal_transform = glm::transpose(instance.local_from_world);
  const Vec3 local_cross = unit_or(glm::cross(unit_or(ab, ab), unit_or(ac, ac)), Vec3(0, 0, 1));
  point.geometric_normal = unit_or(normal_transform * local_cross, -ray_direction);
  point.normal = point.geometric_normal;
  if (mesh.corner2normal && (!mesh.tri2smooth || mesh.tri2smooth[tri])) {
    const float* n = mesh.corner2normal + 9 * tri;
    const float w = 1.0f - hit.u - hit.v;
    const Vec3 smooth = w * Vec3(n[0], n[1], n[2]) + hit.u * Vec3(n[3], n[4], n[5]) +
                        hit.v * Vec3(n[6], n[7], n[8]);
    point.normal = unit_or(normal_transform * smooth, point.geometric_normal);
  }
  if (glm::dot(point.geometric_normal, ray_direction) > 0.0f) {
    point.geometric_normal = -point.geometric_normal;
    point.normal = -point.normal;
  }
  point.offset = glm::dot(glm::abs(point.geometric_normal), error);
  return point;
}

/// Origin of a ray that leaves the surface on its outer side.
inline Vec3 leaving_origin(const SurfacePoint& point) {
  return point.position + point.offset * point.geometric_normal;
}

}  // namespace komorebi
