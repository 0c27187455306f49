#pragma once

#include "core/film_steps.h"
#include "core/round_surface.h"
#include "core/surface_point.h"

namespace komorebi {

/// Pixels that a motion vector may have at most; only what passes the camera has more.
inline constexpr double kMaxMotionVector = 1e6;

/// World from local of an instance that moves while the shutter stays shut.
struct InstanceSteps {
  AffineMap before, rest, after;
};

/// What moves from a step of time before to one after, of a scene that is traced at rest.
struct StepsView {
  const InstanceSteps* instances = nullptr;
  const std::uint32_t* instance2steps = nullptr;  ///< kNone: it stands still; null: all do
  /// Of each mesh [2][vertices][3], before and after, or null; null: none deforms.
  const float* const* mesh_positions = nullptr;
};

namespace detail {

/// What the Vector pass follows of a hit, in the mesh's space, a step before, at rest and after.
struct LocalSteps {
  Vec3d before, rest, after;
};

/// Of a curve it is the point on its axis, and of a sphere its centre, as in Cycles.
inline LocalSteps round_steps(const MeshView& mesh, const float* positions, const Hit& hit) {
  const auto follow = [&](const auto& key_at) {
    if (mesh.kind == PrimitiveKind::kSphere) return key_at(hit.primitive).at;
    const CurveSegment segment =
        segment_of_keys(mesh.shape, mesh.segment2key[hit.primitive], key_at);
    return segment.point(static_cast<double>(hit.u)).at;
  };
  const auto at = [&](float time) {
    const MotionPlace place = round_time(mesh, time);
    return follow([&](std::uint32_t key) { return round_key(mesh, key, place); });
  };
  if (!positions) return {at(0.0f), at(0.5f), at(1.0f)};
  const auto step = [&](std::size_t set) {
    return follow([&](std::uint32_t key) {
      const float* p = positions + 3 * (set * mesh.point_count + key);
      return Vec4d{Vec3d(p[0], p[1], p[2]), 0.0};
    });
  };
  return {step(0), at(0.5f), step(1)};
}

/// A triangle's point goes with its corners.
inline LocalSteps local_steps(const MeshView& mesh, const float* positions, const Hit& hit) {
  if (is_round(mesh.kind)) return round_steps(mesh, positions, hit);
  const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
  const auto at = [&](const Corners& corners) {
    const Vec3d a(corners.corner[0]);
    return a + u * (Vec3d(corners.corner[1]) - a) + v * (Vec3d(corners.corner[2]) - a);
  };
  const Vec3d rest = at(triangle_corners(mesh, hit.primitive, 0.5f));
  if (positions) {
    const std::uint32_t* three = mesh.tri2vtx + 3 * std::size_t{hit.primitive};
    const auto step = [&](std::uint32_t set) {
      Corners corners;
      for (int k = 0; k < 3; ++k) {
        const float* p = positions + 3 * (std::size_t{set} * mesh.vertex_count + three[k]);
        corners.corner[k] = Vec3(p[0], p[1], p[2]);
      }
      return at(corners);
    };
    return {step(0), rest, step(1)};
  }
  if (mesh.kind != PrimitiveKind::kMovingTriangle) return {rest, rest, rest};
  return {at(triangle_corners(mesh, hit.primitive, 0.0f)), rest,
          at(triangle_corners(mesh, hit.primitive, 1.0f))};
}

inline Vec3d applied(const AffineMap& map, const Vec3d& local) {
  return map.linear * local + map.translation;
}

}  // namespace detail

/// The value of the Vector pass for a hit, in pixels, y up: where the point was a step before minus
/// where it is, and where it is minus where it will be a step after.
inline glm::vec4 motion_vector(const SceneView& scene, const StepsView& moving,
                               const FilmSteps& film, const Hit& hit) {
  using namespace detail;
  const InstanceView& instance = scene.instances[hit.instance];
  const LocalSteps local =
      local_steps(scene.meshes[instance.mesh],
                  moving.mesh_positions ? moving.mesh_positions[instance.mesh] : nullptr, hit);
  const AffineMap still{Mat3d(instance.world_from_local), Vec3d(instance.position)};
  InstanceSteps steps{still, still, still};
  if (moving.instance2steps && moving.instance2steps[hit.instance] != kNone) {
    steps = moving.instances[moving.instance2steps[hit.instance]];
  }
  const auto before = film_point(film, film.before, applied(steps.before, local.before));
  const auto rest = film_point(film, film.rest, applied(steps.rest, local.rest));
  const auto after = film_point(film, film.after, applied(steps.after, local.after));
  const auto pixels = [](double x) {
    return static_cast<float>(x < kMaxMotionVector ? (x > -kMaxMotionVector ? x : -kMaxMotionVector)
                                                   : kMaxMotionVector);
  };
  return {pixels(before.x - rest.x), pixels(before.y - rest.y), pixels(rest.x - after.x),
          pixels(rest.y - after.y)};
}

}  // namespace komorebi
