#include "bvh/moving_leaf.h"

namespace komorebi {

bool test_moving_triangle(const MeshView& mesh, const LocalRay& local, const SetPlace& place,
                          std::uint32_t self, std::uint32_t instance, std::uint32_t triangle,
                          Closest* closest) {
  if (triangle == self) return false;
  const Corners at = moving_triangle(mesh, triangle, place);
  const Vec3 &a = at.corner[0], &b = at.corner[1], &c = at.corner[2];
  TriangleHit found;
  if (!intersect_triangle(local.shear, local.slab, local.range, local.t_min, local.t_max, a, b, c,
                          &found)) {
    return false;
  }
  if (is_degenerate(a, b, c)) return false;
  closest->keep({found.t, found.u, found.v, instance, triangle});
  return true;
}

}  // namespace komorebi
