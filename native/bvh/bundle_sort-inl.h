// Which any-hit rays walk together. Included once per instruction set by traverse_simd.cpp, without
// a guard.
//
// Neighbouring rays of like direction meet the same nodes and leaves. So a thousand rays that
// follow each other are sorted by the octant that they point to, and walk in bundles of one octant:
// half as many visits as with the rays of each point by themselves.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

inline constexpr std::uint32_t kSorted = 1024;  ///< rays sorted at a time

HWY_INLINE std::uint32_t octant(float x, float y, float z) {
  return (x < 0.0f ? 1u : 0u) | (y < 0.0f ? 2u : 0u) | (z < 0.0f ? 4u : 0u);
}

/// Ray `i` of `from` into place `k`.
HWY_INLINE void load_ray(const RaySpan& from, std::uint32_t i, std::uint32_t, WorldBundle& to,
                         std::uint32_t k) {
  to.rays.o[0][k] = from.origin_x[i];
  to.rays.o[1][k] = from.origin_y[i];
  to.rays.o[2][k] = from.origin_z[i];
  to.rays.d[0][k] = from.direction_x[i];
  to.rays.d[1][k] = from.direction_y[i];
  to.rays.d[2][k] = from.direction_z[i];
  to.rays.t_min[k] = from.t_min[i];
  to.rays.t_max[k] = from.t_max[i];
  to.self_instance[k] = from.self_instance[i];
  to.self_primitive[k] = from.self_primitive[i];
  to.mask[k] = from.mask[i];
}

/// The same for a ray of point `p`.
HWY_INLINE void load_ray(const RayBundles& from, std::uint32_t i, std::uint32_t p, WorldBundle& to,
                         std::uint32_t k) {
  to.rays.o[0][k] = from.origin_x[p];
  to.rays.o[1][k] = from.origin_y[p];
  to.rays.o[2][k] = from.origin_z[p];
  to.rays.d[0][k] = from.direction_x[i];
  to.rays.d[1][k] = from.direction_y[i];
  to.rays.d[2][k] = from.direction_z[i];
  to.rays.t_min[k] = 0.0f;
  to.rays.t_max[k] = from.t_max[i];
  to.self_instance[k] = from.self_instance[p];
  to.self_primitive[k] = from.self_primitive[p];
  to.mask[k] = from.mask;
}

/// Rays first…first + count − 1, at most kSorted, of which ray first + k leaves point point[k];
/// sets the bits of those that are blocked.
template <class Rays>
HWY_INLINE void occluded_sorted(const SceneView& scene, const Rays& rays, std::uint32_t first,
                                std::uint32_t count, const std::uint32_t* point,
                                std::uint32_t* bits) {
  std::uint32_t size[8] = {};
  std::uint16_t list[8][kSorted];
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t i = first + k;
    const auto o = octant(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
    list[o][size[o]++] = static_cast<std::uint16_t>(k);
  }
  for (std::uint32_t o = 0; o < 8; ++o) {
    for (std::uint32_t begin = 0; begin < size[o]; begin += kBundle) {
      const std::uint32_t now = size[o] - begin < kBundle ? size[o] - begin : kBundle;
      const std::uint16_t* const order = list[o] + begin;
      WorldBundle bundle;
      bundle.some_mask = 0;
      bundle.common_mask = ~0u;
      const std::uint32_t full = (now + kRayLanes - 1) / kRayLanes * kRayLanes;
      for (std::uint32_t lane = 0; lane < full; ++lane) {  // unused places repeat the last ray
        const std::uint32_t k = order[lane < now ? lane : now - 1];
        load_ray(rays, first + k, point[k], bundle, lane);
        bundle.some_mask |= bundle.mask[lane];
        bundle.common_mask &= bundle.mask[lane];
      }
      for (std::uint32_t found = occluded_together(scene, bundle, now); found != 0;
           found &= found - 1) {
        const std::uint32_t i = first + order[__builtin_ctz(found)];
        bits[i / 32] |= 1u << (i % 32);
      }
    }
  }
}

void occluded(const SceneView& scene, const RaySpan& rays, std::uint32_t* bits) {
  const std::uint32_t none[kSorted] = {};
  for (std::uint32_t i = 0; i < (rays.count + 31) / 32; ++i) bits[i] = 0;
  for (std::uint32_t i = 0; i < rays.count; i += kSorted) {
    const std::uint32_t now = rays.count - i < kSorted ? rays.count - i : kSorted;
    occluded_sorted(scene, rays, i, now, none, bits);
  }
}

void occluded_bundles(const SceneView& scene, const RayBundles& bundles, std::uint32_t* bits) {
  const std::uint32_t count = bundles.ray_count();
  for (std::uint32_t i = 0; i < (count + 31) / 32; ++i) bits[i] = 0;
  std::uint32_t point[kSorted];
  std::uint32_t p = 0;
  for (std::uint32_t i = 0; i < count; i += kSorted) {
    const std::uint32_t now = count - i < kSorted ? count - i : kSorted;
    for (std::uint32_t k = 0; k < now; ++k) {
      while (bundles.first_ray[p + 1] <= i + k) ++p;
      point[k] = p;
    }
    occluded_sorted(scene, bundles, i, now, point, bits);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
