#pragma once

#include <cmath>

#include "core/instance_motion.h"
#include "core/local_ray.h"
#include "core/moving_triangle.h"
#include "core/round_surface.h"
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

/// Unit vector; scaled first, so that squares of tiny or huge lengths neither vanish nor overflow.
/// A null or non-finite vector gives `fallback`.
inline Vec3 unit_or(const Vec3& v, const Vec3& fallback) {
  const float scale = max_abs(v);
  if (!(scale > 0.0f && scale <= 3.402823466e+38f)) return fallback;
  const Vec3 s = v / scale;
  return s / std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
}

/// A triangle's corners at a time.
inline Corners triangle_corners(const MeshView& mesh, std::size_t triangle, float time) {
  if (mesh.kind == PrimitiveKind::kMovingTriangle) {
    return moving_triangle(mesh, triangle, set_place(mesh.position_sets, time));
  }
  Corners at;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* p = mesh.vtx2xyz + 3 * std::size_t{mesh.tri2vtx[3 * triangle + k]};
    at.corner[k] = Vec3(p[0], p[1], p[2]);
  }
  return at;
}

/// The normals of a triangle's corners in world space, each of length 1; a null one stays null.
/// Cycles moves a mesh that is used once to world space, normals and all, before it interpolates
/// them (apply_static_transforms in its scene/object.cpp), and interpolates those of one that is
/// shared in its own space. Where an object is stretched, these are different surfaces.
/// @param normal_transform  the inverse transpose of world from local
inline Corners world_normals(const MeshView& mesh, std::size_t triangle, float time,
                             const Mat3& normal_transform) {
  const std::uint32_t* three = mesh.tri2normal + 3 * triangle;
  const auto of_set = [&](std::size_t set) {
    Corners at;
    for (int k = 0; k < 3; ++k) {
      const float* n = mesh.normals + 3 * (set * mesh.normal_count + three[k]);
      at.corner[k] = unit_or(normal_transform * Vec3(n[0], n[1], n[2]), Vec3(0.0f));
    }
    return at;
  };
  if (mesh.normal_sets == 1) return of_set(0);
  const SetPlace place = set_place(mesh.normal_sets, time);
  const Corners from = of_set(place.set), to = of_set(std::size_t{place.set} + 1);
  const float f = place.fraction, s = 1.0f - f;
  Corners at;
  for (int k = 0; k < 3; ++k) at.corner[k] = s * from.corner[k] + f * to.corner[k];
  return at;
}

/// The barycentrics at which a ray meets the plane of a triangle (a, a + ab, a + ac), in doubles
/// (Möller and Trumbore 1997), moved onto the triangle; false if the ray is parallel to the plane.
inline bool meet_triangle(const Vec3d& origin, const Vec3d& direction, const Vec3d& a,
                          const Vec3d& ab, const Vec3d& ac, double& u, double& v) {
  const Vec3d p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0.0) return false;
  const Vec3d from_a = origin - a;
  u = glm::dot(from_a, p) / determinant;
  v = glm::dot(direction, glm::cross(from_a, ab)) / determinant;
  u = u > 0.0 ? (u < 1.0 ? u : 1.0) : 0.0;
  v = v > 0.0 ? (v < 1.0 - u ? v : 1.0 - u) : 0.0;
  return true;
}

/// How near to an edge, in barycentrics, a point known to within `error` may lie: two errors of the
/// triangle's least height, and never more than an eighth.
inline double edge_margin(const Vec3d& ab, const Vec3d& ac, double error) {
  const Vec3d bc = ac - ab;
  const double longest =
      std::sqrt(glm::max(glm::dot(ab, ab), glm::max(glm::dot(ac, ac), glm::dot(bc, bc))));
  const Vec3d normal = glm::cross(ab, ac);
  const double margin = 2.0 * error * longest / std::sqrt(glm::dot(normal, normal));
  return margin < 0.125 ? margin : 0.125;
}

/// surface_point on a curve or sphere. Both normals are the round surface's, also where the curve
/// is a ribbon: its flat side would leave hair half as much light, in Cycles too.
inline SurfacePoint round_surface_point(const InstanceView& instance, const MeshView& mesh,
                                        const Hit& hit, const Ray& ray) {
  const Mat3d into_local(instance.local_from_world);
  const Vec3d place(instance.position);
  RoundRay round;
  round.time = round_time(mesh, ray.time);
  set_round_frame(into_local * (Vec3d(ray.origin) - place), into_local * Vec3d(ray.direction),
                  round);
  const RoundPoint at = round_point(mesh, hit, round);
  const Vec3d relative = Mat3d(instance.world_from_local) * at.position;
  const Vec3 local(at.position);
  Vec3 local_error = gamma(2) * (glm::abs(local) + Vec3(max_abs(local)));
  local_error +=
      product(absolute(instance.local_from_world),
              gamma(6) * glm::abs(Vec3(relative)) + gamma(2) * glm::abs(Vec3(relative + place)));
  SurfacePoint point;
  point.position = Vec3(relative + place);
  const Vec3 error = product(absolute(instance.world_from_local), local_error) +
                     gamma(2) * glm::abs(point.position);
  // Cycles takes a sphere's normal to be where the point lies from its centre in the world.
  const Vec3d normal = mesh.kind == PrimitiveKind::kSphere
                           ? Mat3d(instance.world_from_local) * at.normal
                           : glm::transpose(into_local) * at.normal;
  const double length = std::sqrt(glm::dot(normal, normal));
  point.normal = length > 0.0 ? Vec3(normal / length) : unit_or(-ray.direction, Vec3(0, 0, 1));
  // Of a stretched sphere it may point away, and is turned round.
  if (mesh.kind == PrimitiveKind::kSphere && glm::dot(point.normal, ray.direction) > 0.0f) {
    point.normal = -point.normal;
  }
  point.geometric_normal = point.normal;
  point.offset = glm::dot(glm::abs(point.normal), error);
  return point;
}

}  // namespace detail

/// The point of a hit with a carried error bound (pbrt-v4 §6.8.5): from the barycentrics, whatever
/// t was. Those of the tracer are floats, which on a large triangle is coarse (4 mm on 60 km), so
/// they are worked out again in doubles, and taken if the tracer's bear them out: they do unless
/// the ray grazes the triangle. The bound covers the rounding of the point and of the way into the
/// instance's space and back, so that a ray leaving by `offset` starts on the outer side of the
/// surface as the tracer sees it.
inline SurfacePoint surface_point(const SceneView& scene, const Hit& hit, const Ray& ray) {
  using namespace detail;
  InstanceView room;
  const InstanceView& instance = instance_at(scene, hit.instance, ray.time, room);
  const MeshView& mesh = scene.meshes[instance.mesh];
  if (is_round(mesh.kind)) return round_surface_point(instance, mesh, hit, ray);
  const std::size_t tri = hit.primitive;
  const Corners corners = triangle_corners(mesh, tri, ray.time);
  const Vec3d a(corners.corner[0]);
  const Vec3d ab = Vec3d(corners.corner[1]) - a;
  const Vec3d ac = Vec3d(corners.corner[2]) - a;
  const Mat3d into_local(instance.local_from_world);
  const Vec3d place(instance.position);
  double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
  double exact_u = 0.0, exact_v = 0.0;
  constexpr double kBorneOut = 1e-5;
  if (meet_triangle(into_local * (Vec3d(ray.origin) - place), into_local * Vec3d(ray.direction), a,
                    ab, ac, exact_u, exact_v) &&
      std::abs(exact_u - u) < kBorneOut && std::abs(exact_v - v) < kBorneOut) {
    u = exact_u;
    v = exact_v;
  }
  Vec3d local = a + u * ab + v * ac;
  Vec3d relative = Mat3d(instance.world_from_local) * local;

  // In local space: the rounding of the point here (also on an axis that happens to have none, as
  // z = 0), in the world, and on the way back by local_from_world · (position − place).
  Vec3 local_error = gamma(2) * (glm::abs(Vec3(local)) + Vec3(max_abs(Vec3(local))));
  local_error +=
      product(absolute(instance.local_from_world),
              gamma(6) * glm::abs(Vec3(relative)) + gamma(2) * glm::abs(Vec3(relative + place)));

  // A point on an edge may not round to the far side of the neighbour: it moves into its own
  // triangle.
  const double margin = edge_margin(ab, ac, static_cast<double>(max_abs(local_error)));
  if (u < margin || v < margin || 1.0 - u - v < margin) {
    u = margin + (1.0 - 3.0 * margin) * u;
    v = margin + (1.0 - 3.0 * margin) * v;
    local = a + u * ab + v * ac;
    relative = Mat3d(instance.world_from_local) * local;
  }
  SurfacePoint point;
  point.position = Vec3(relative + place);
  const Vec3 error = product(absolute(instance.world_from_local), local_error) +
                     gamma(2) * glm::abs(point.position);

  // Normals go by the inverse transpose, which keeps the outside outside under mirroring too.
  const Mat3 normal_transform = glm::transpose(instance.local_from_world);
  const Vec3 along_ab(ab), along_ac(ac);
  const Vec3 local_cross =
      unit_or(glm::cross(unit_or(along_ab, along_ab), unit_or(along_ac, along_ac)), Vec3(0, 0, 1));
  point.geometric_normal = unit_or(normal_transform * local_cross, -ray.direction);
  point.normal = point.geometric_normal;
  if (mesh.normals && (!mesh.tri2smooth || mesh.tri2smooth[tri])) {
    const Corners normals = mesh.stretched ? world_normals(mesh, tri, ray.time, normal_transform)
                                           : corner_normals(mesh, tri, ray.time);
    const float w = 1.0f - hit.u - hit.v;  // normals vary slowly: the tracer's own will do
    const Vec3 smooth =
        w * normals.corner[0] + hit.u * normals.corner[1] + hit.v * normals.corner[2];
    point.normal =
        unit_or(mesh.stretched ? smooth : normal_transform * smooth, point.geometric_normal);
  }
  if (glm::dot(point.geometric_normal, ray.direction) > 0.0f) {
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
