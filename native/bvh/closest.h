#pragma once

#include "bvh/triangle_cluster.h"
#include "core/local_ray.h"

namespace komorebi {

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

/// What of one instance stops a ray: everything that it meets, or what the scene's filter says.
class HitTest {
 public:
  HitTest(const SceneView& scene, std::uint32_t instance, const Ray& ray)
      : filter_(scene.instances[instance].filtered ? &scene.filter : nullptr), ray_(ray) {}

  /// `meet(closest)` keeps a hit in the Closest that it is given, and says whether there is one.
  /// Whether there is one that counts.
  template <class Meet>
  bool keep(const Meet& meet, Closest* closest) const {
    if (filter_ == nullptr) return meet(closest);
    Closest alone;
    if (!meet(&alone) || !closest->is_better(alone.hit)) return false;
    if (!(*filter_)({alone.hit, ray_})) return false;
    return closest->keep(alone.hit);
  }

 private:
  const HitFilter* filter_;
  const Ray& ray_;
};

/// Tests one triangle and keeps the hit if it is the better one; true if anything was hit.
inline bool test_triangle(const LocalRay& local, const Ray& ray, std::uint32_t instance,
                          std::uint32_t primitive, const Vec3& a, const Vec3& b, const Vec3& c,
                          Closest* closest) {
  if (instance == ray.self_instance && primitive == ray.self_primitive) return false;
  TriangleHit found;
  if (!intersect_triangle(local.shear, local.slab, local.range, local.t_min, local.t_max, a, b, c,
                          &found)) {
    return false;
  }
  closest->keep({found.t, found.u, found.v, instance, primitive});
  return true;
}

}  // namespace komorebi
