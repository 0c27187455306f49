#pragma once

#include "core/curve.h"
#include "core/sphere.h"

namespace komorebi::detail {

/// A point on a curve or sphere in local space and its normal, which for both kinds of curves is
/// that of a round one: a ribbon's normal turns across its width from side to side.
struct RoundPoint {
  Vec3d position;
  Vec3d normal;
};

inline RoundPoint ribbon_point(const MeshView& mesh, const Hit& hit, const RoundRay& ray) {
  const CurveSegment seen = seen_segment(mesh, mesh.segment2key[hit.primitive], ray);
  const auto pieces = double(mesh.pieces), u = double(hit.u), v = double(hit.v);
  const auto piece = std::min(static_cast<std::uint32_t>(u * pieces), mesh.pieces - 1);
  const double u0 = piece_begin(mesh, piece), u1 = piece_begin(mesh, piece + 1);
  const double z0 = seen.point(u0).at.z, z1 = seen.point(u1).at.z;
  const double depth = z0 + (u - u0) / (u1 - u0) * (z1 - z0);
  const Vec3d to_eye = -ray.z;
  RoundPoint point{ray.origin + depth * ray.z, to_eye};
  const Vec3d tangent = curve_segment(mesh, mesh.segment2key[hit.primitive], ray.time).slope(u).at;
  const Vec3d across = glm::cross(tangent, to_eye);
  const Vec3d outward = glm::cross(across, tangent);
  const double across_length = std::sqrt(glm::dot(across, across));
  const double outward_length = std::sqrt(glm::dot(outward, outward));
  if (!(across_length > 0.0 && outward_length > 0.0)) return point;  // along the ray
  const double cosine = std::sqrt(std::max(0.0, 1.0 - v * v));
  point.normal = v / across_length * across + cosine / outward_length * outward;
  return point;
}

inline RoundPoint thick_point(const MeshView& mesh, const Hit& hit, const RoundRay& ray) {
  const auto u = double(hit.u);
  const Vec4d at = seen_segment(mesh, mesh.segment2key[hit.primitive], ray).point(u);
  double depth;
  if (!thick_depth(at, &depth)) depth = at.at.z;
  const Vec3d position = ray.origin + depth * ray.z;
  const Vec3d normal =
      position - curve_segment(mesh, mesh.segment2key[hit.primitive], ray.time).point(u).at;
  return {position, normal};
}

inline RoundPoint sphere_point(const MeshView& mesh, const Hit& hit, const RoundRay& ray) {
  const Vec3d centre = round_key(mesh, hit.primitive, ray.time).at;
  double depth;
  if (!sphere_depth(mesh, hit.primitive, ray, &depth)) depth = ray.seen(centre).z;
  const Vec3d position = ray.origin + depth * ray.z;
  return {position, position - centre};
}

inline RoundPoint round_point(const MeshView& mesh, const Hit& hit, const RoundRay& ray) {
  if (mesh.kind == PrimitiveKind::kSphere) return sphere_point(mesh, hit, ray);
  return mesh.shape == CurveShape::kRibbon ? ribbon_point(mesh, hit, ray)
                                           : thick_point(mesh, hit, ray);
}

}  // namespace komorebi::detail
