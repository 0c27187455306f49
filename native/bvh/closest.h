#pragma once

#include "bvh/triangle_cluster.h"
#include "core/local_ray.h"

namespace komorebi {

/// Leaf filters decide whether a hit counts (cut-outs by texture, later). This one says yes
/// without being asked: `kEnabled` false compiles the question out.
struct OpaqueFilter {
  static constexpr bool kEnabled = false;
  bool operator()(const Hit&) const { return true; }
};

/// What one ray has found so far, and the only place that decides between hits.
struct Closest {
  Hit hit;
  float limit = 0.0f;  ///< nothing that begins behind this can matter: best t, or t_max

  Closest() = default;
  explicit Closest(const Ray& ray) : limit(ray.t_max) {}

  /// Nearer, or as near with smaller (instance, primitive, u): a curve's segment can be met in more
  /// than one leaf.
  bool is_better(const Hit& other) const {
    if (other.t != hit.t || !hit.valid()) return !hit.valid() || other.t < hit.t;
    if (other.instance != hit.instance) return other.instance < hit.instance;
    if (other.primitive != hit.primitive) return other.primitive < hit.primitive;
    return other.u < hit.u;
  }

  bool keep(const Hit& other) {
    if (!is_better(other)) return false;
    hit = other;
    limit = other.t;
    return true;
  }
};

/// Tests one triangle and keeps the hit if it is the better one; true if anything was hit.
template <class Filter>
inline bool test_triangle(const LocalRay& local, const Ray& ray, std::uint32_t instance,
                          std::uint32_t primitive, const Vec3& a, const Vec3& b, const Vec3& c,
                          const Filter& filter, Closest* closest) {
  if (instance == ray.self_instance && primitive == ray.self_primitive) return false;
  TriangleHit found;
  if (!intersect_triangle(local.shear, local.slab, local.range, local.t_min, local.t_max, a, b, c,
                          &found)) {
    return false;
  }
  const Hit hit{found.t, found.u, found.v, instance, primitive};
  if constexpr (Filter::kEnabled) {
    if (closest->is_better(hit) && !filter(hit)) return false;
  }
  closest->keep(hit);
  return true;
}

}  // namespace komorebi
