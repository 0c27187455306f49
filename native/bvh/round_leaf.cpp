#include "bvh/round_leaf.h"

#include "core/curve.h"
#include "core/sphere.h"

namespace komorebi {

bool test_round_item(const MeshView& mesh, const RoundRay& ray, std::uint32_t self,
                     std::uint32_t instance, std::uint32_t item, std::uint32_t entry,
                     Closest* closest) {
  if (!(ray.length > 0.0)) return false;
  if (mesh.kind == PrimitiveKind::kSphere) {
    float t;
    if (item == self || !intersect_sphere(mesh, item, ray, &t)) return false;
    closest->keep({t, 0.0f, 0.0f, instance, item});
    return true;
  }
  const CurveItem its = curve_item(mesh, item, entry);
  if (self != kNone && its.curve() == (mesh.segment2key[self] & kKeyMask) - self) return false;
  CurveHit hit;
  if (!intersect_curve(mesh, its, ray, &hit)) return false;
  closest->keep({hit.t, hit.u, hit.v, instance, its.segment});
  return true;
}

}  // namespace komorebi
