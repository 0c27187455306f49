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

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::uint32_t kSorted = 1024;  ///< rays sorted at a time

HWY_INLINE std::uint32_t octant(float x, float y, float z) {
  return (x < 0.0f ? 1u : 0u) | (y < 0.0f ? 2u : 0u) | (z < 0.0f ? 4u : 0u);
}

/// Where kRayLanes rays come from: their numbers, and those of their points.
struct Places {
  hn::Vec<RayIndexTag> ray, point;
};

HWY_INLINE void fetch(const float* from, const hn::Vec<RayIndexTag>& at, float* to) {
  hn::Store(hn::GatherIndex(RayTag(), from, at), RayTag(), to);
}
HWY_INLINE void fetch(const std::uint32_t* from, const hn::Vec<RayIndexTag>& at,
                      std::uint32_t* to) {
  const hn::RebindToUnsigned<RayTag> du;
  hn::Store(hn::GatherIndex(du, from, at), du, to);
}

/// What spans and bundles of rays both have; a ray of a span is its own point.
template <class Rays>
HWY_INLINE void load_shared(const Rays& from, const Places& at, WorldBundle& to, std::uint32_t k) {
  fetch(from.origin_x, at.point, to.rays.o[0] + k);
  fetch(from.origin_y, at.point, to.rays.o[1] + k);
  fetch(from.origin_z, at.point, to.rays.o[2] + k);
  fetch(from.direction_x, at.ray, to.rays.d[0] + k);
  fetch(from.direction_y, at.ray, to.rays.d[1] + k);
  fetch(from.direction_z, at.ray, to.rays.d[2] + k);
  fetch(from.t_max, at.ray, to.rays.t_max + k);
  fetch(from.self_instance, at.point, to.self_instance + k);
  fetch(from.self_primitive, at.point, to.self_primitive + k);
}

/// Into places k…k + kRayLanes − 1 of a bundle.
HWY_INLINE void load_rays(const RaySpan& from, const Places& at, WorldBundle& to, std::uint32_t k) {
  load_shared(from, at, to, k);
  fetch(from.t_min, at.ray, to.rays.t_min + k);
  fetch(from.mask, at.ray, to.mask + k);
}

HWY_INLINE void load_rays(const RayBundles& from, Places at, WorldBundle& to, std::uint32_t k) {
  const hn::RebindToUnsigned<RayTag> du;
  if (from.place != nullptr) {
    at.ray = hn::BitCast(RayIndexTag(), hn::GatherIndex(du, from.place, at.ray));
  }
  load_shared(from, at, to, k);
  hn::Store(hn::Zero(RayTag()), RayTag(), to.rays.t_min + k);
  hn::Store(hn::Set(du, from.mask), du, to.mask + k);
}

HWY_INLINE std::uint32_t place_of(const RaySpan&, std::uint32_t i) {
  return i;
}
HWY_INLINE std::uint32_t place_of(const RayBundles& rays, std::uint32_t i) {
  return rays.place == nullptr ? i : rays.place[i];
}

/// Bits that any of a bundle's rays see by, and that all do.
HWY_INLINE void join_masks(WorldBundle& bundle, std::uint32_t count) {
  bundle.some_mask = 0;
  bundle.common_mask = ~0u;
  for (std::uint32_t k = 0; k < count; ++k) {
    bundle.some_mask |= bundle.mask[k];
    bundle.common_mask &= bundle.mask[k];
  }
}
HWY_INLINE void join_masks(const RaySpan&, WorldBundle& bundle, std::uint32_t count) {
  join_masks(bundle, count);
}
HWY_INLINE void join_masks(const RayBundles& rays, WorldBundle& bundle, std::uint32_t) {
  bundle.some_mask = bundle.common_mask = rays.mask;
}

/// Rays first…first + count − 1, at most kSorted, of which ray first + k leaves point[k];
/// sets the bits of those that are blocked.
/// @param blockers  of each octant
template <class Rays>
HWY_INLINE void occluded_sorted(const SceneView& scene, const Rays& rays, std::uint32_t first,
                                std::uint32_t count, const std::int32_t* point, Blockers* blockers,
                                std::uint32_t* bits) {
  std::uint32_t size[8] = {};
  std::uint16_t list[8][kSorted + kRayLanes];
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t i = first + k;
    const std::uint32_t at = place_of(rays, i);
    const auto o = octant(rays.direction_x[at], rays.direction_y[at], rays.direction_z[at]);
    list[o][size[o]++] = static_cast<std::uint16_t>(k);
  }
  for (std::uint32_t o = 0; o < 8; ++o) {
    if (size[o] == 0) continue;
    for (std::uint32_t k = 0; k < kRayLanes; ++k) {  // what is behind the last ray repeats it
      list[o][size[o] + k] = list[o][size[o] - 1];
    }
    for (std::uint32_t begin = 0; begin < size[o]; begin += kBundle) {
      const std::uint32_t now = size[o] - begin < kBundle ? size[o] - begin : kBundle;
      const std::uint16_t* const order = list[o] + begin;
      WorldBundle bundle;
      for (std::uint32_t k = 0; k < now; k += kRayLanes) {
        const RayIndexTag di;
        const hn::Rebind<std::uint16_t, RayTag> d16;
        const auto place = hn::PromoteTo(di, hn::LoadU(d16, order + k));
        const Places at = {hn::Add(place, hn::Set(di, static_cast<std::int32_t>(first))),
                           hn::GatherIndex(di, point, place)};
        load_rays(rays, at, bundle, k);
      }
      join_masks(rays, bundle, now);
      for (std::uint32_t found = occluded_together(scene, bundle, now, blockers[o]); found != 0;
           found &= found - 1) {
        const std::uint32_t i = first + order[__builtin_ctz(found)];
        bits[i / 32] |= 1u << (i % 32);
      }
    }
  }
}

void occluded(const SceneView& scene, const RaySpan& rays, std::uint32_t* bits) {
  for (std::uint32_t i = 0; i < (rays.count + 31) / 32; ++i) bits[i] = 0;
  std::int32_t point[kSorted];
  Blockers blockers[8];
  for (std::uint32_t i = 0; i < rays.count; i += kSorted) {
    const std::uint32_t now = rays.count - i < kSorted ? rays.count - i : kSorted;
    for (std::uint32_t k = 0; k < now; ++k) point[k] = static_cast<std::int32_t>(i + k);
    occluded_sorted(scene, rays, i, now, point, blockers, bits);
  }
}

void occluded_bundles(const SceneView& scene, const RayBundles& bundles, std::uint32_t* bits) {
  const std::uint32_t count = bundles.ray_count();
  for (std::uint32_t i = 0; i < (count + 31) / 32; ++i) bits[i] = 0;
  std::int32_t point[kSorted];
  Blockers blockers[8];
  std::uint32_t p = 0;
  for (std::uint32_t i = 0; i < count; i += kSorted) {
    const std::uint32_t now = count - i < kSorted ? count - i : kSorted;
    for (std::uint32_t k = 0; k < now; ++k) {
      while (bundles.first_ray[p + 1] <= i + k) ++p;
      point[k] = static_cast<std::int32_t>(p);
    }
    occluded_sorted(scene, bundles, i, now, point, blockers, bits);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
