// Which any-hit rays walk together. Included once per instruction set by traverse_simd.cpp, without
// a guard.
//
// Neighbouring rays of like direction meet the same nodes and leaves. So four thousand rays that
// follow each other are sorted by the octant that they point to, and walk in bundles of one octant:
// half as many visits as with the rays of each point by themselves. Where the leaves that are asked
// first catch much of a bundle, the rest waits for that of the next ones, and walks in full
// bundles.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Those of `rays` that what stands behind a leaf blocks.
HWY_INLINE std::uint32_t visit_instance(const SceneView& scene, std::uint32_t leaf,
                                        const WorldBundle& bundle, std::uint32_t rays, Turn& turn) {
  LocalBundle local;
  std::uint32_t index;
  rays = enter_leaf(scene, leaf, bundle, rays, local, index);
  if (rays == 0) return 0;
  const MeshView& mesh = scene.meshes[scene.instances[index].mesh];
  if (HWY_UNLIKELY(scene.instances[index].filtered)) {
    return walk_filtered(scene, mesh, index, bundle, local, rays);
  }
  return walk_mesh(mesh, index, local, rays, turn);
}

/// The first `count` rays of `bundle`; a bit for each that is blocked.
HWY_INLINE std::uint32_t occluded_together(const SceneView& scene, WorldBundle& bundle,
                                           std::uint32_t count, Turn& turn) {
  std::uint32_t rays = prepare(bundle, count);
  if (rays == 0 || scene.tree.node_count == 0) return 0;
  const auto visit = [&](std::uint32_t entry, std::uint32_t active)
                         HWY_ATTR { return visit_instance(scene, entry, bundle, active, turn); };
  // One instance alone needs no tree: entering it looks at its box anyway.
  if (is_alone(scene)) return visit(0, rays);
  const auto address = [&](std::uint32_t child) HWY_ATTR -> const void* {
    return scene.tree.nodes + (child & Waiting::kLeaf ? 0 : child);
  };
  std::uint32_t found = 0;
  while (rays != 0) {  // all at once: those of a bundle point to one octant
    const std::uint32_t now = same_octant(bundle.slab, rays);
    const WalkingRays walking(bundle.slab, now);
    const Reach reach(walking, bundle.rays, now);
    found |= walk_bundle(scene.tree, walking, reach, now, visit, address);
    rays &= ~now;
  }
  return found;
}

inline constexpr std::uint32_t kSorted = 4096;  ///< rays sorted at a time

/// Where kRayLanes rays come from: their numbers, and those of their points.
struct Places {
  HWY_ALIGN std::int32_t ray[kRayLanes];
  HWY_ALIGN std::int32_t point[kRayLanes];
};

/// What stands at kRayLanes places. (Highway's GatherIndex builds its vector in memory where there
/// is no instruction for it, and waits for that each time.)
template <class Number>
HWY_INLINE void fetch(const Number* from, const std::int32_t* at, Number* to) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2
  const hn::Rebind<Number, RayTag> d;
  hn::Store(hn::GatherIndex(d, from, hn::Load(RayIndexTag(), at)), d, to);
#else
  for (std::uint32_t k = 0; k < kRayLanes; ++k) to[k] = from[at[k]];
#endif
}

/// Where the directions of kRayLanes rays stand.
HWY_INLINE void find_places(const RaySpan&, std::int32_t*) {}
HWY_INLINE void find_places(const RayBundles& rays, std::int32_t* ray) {
  if (rays.place == nullptr) return;
  HWY_ALIGN std::uint32_t place[kRayLanes];
  fetch(rays.place, ray, place);
  const hn::RebindToUnsigned<RayTag> du;
  hn::Store(hn::BitCast(RayIndexTag(), hn::Load(du, place)), RayIndexTag(), ray);
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

/// The times of rays, in places k…k + kRayLanes − 1 of a bundle.
template <class Rays>
HWY_INLINE void load_times(const Rays& from, const Places& at, WorldBundle& to, std::uint32_t k) {
  for (std::uint32_t i = 0; i < kRayLanes; ++i) to.time[k + i] = from.time[at.point[i]];
}

/// What a scene that moves, or that has a filter, asks for as well.
template <class Rays>
HWY_INLINE void load_more(const SceneView& scene, const Rays& from, const Places& at,
                          WorldBundle& to, std::uint32_t k) {
  const bool filters = scene.filter.exists();
  if (scene.moves || filters) load_times(from, at, to, k);
  if (!HWY_UNLIKELY(filters)) return;
  for (std::uint32_t i = 0; i < kRayLanes; ++i) {
    to.path_key[k + i] = from.path_key != nullptr ? from.path_key[at.ray[i]] : 0;
  }
}

/// Into places k…k + kRayLanes − 1 of a bundle.
HWY_INLINE void load_rays(const RaySpan& from, const Places& at, WorldBundle& to, std::uint32_t k) {
  load_shared(from, at, to, k);
  fetch(from.t_min, at.ray, to.rays.t_min + k);
  fetch(from.mask, at.ray, to.mask + k);
}

HWY_INLINE void load_rays(const RayBundles& from, const Places& at, WorldBundle& to,
                          std::uint32_t k) {
  const hn::RebindToUnsigned<RayTag> du;
  load_shared(from, at, to, k);
  hn::Store(hn::Zero(RayTag()), RayTag(), to.rays.t_min + k);
  hn::Store(hn::Set(du, from.mask), du, to.mask + k);
}

HWY_INLINE bool follow(const RaySpan&) {
  return true;
}
HWY_INLINE bool follow(const RayBundles& rays) {
  return rays.place == nullptr;
}

/// The octants that rays first…first + count − 1 point to; writes up to kRayLanes − 1 more.
template <class Rays>
HWY_INLINE void find_octants(const Rays& rays, std::uint32_t first, std::uint32_t count,
                             std::int32_t* octants) {
  const RayTag d;
  const RayIndexTag di;
  const auto last = hn::Set(di, static_cast<std::int32_t>(first + count - 1));
  for (std::uint32_t k = 0; k < count; k += kRayLanes) {
    RayVec x, y, z;
    if (follow(rays) && k + kRayLanes <= count) {
      x = hn::LoadU(d, rays.direction_x + first + k);
      y = hn::LoadU(d, rays.direction_y + first + k);
      z = hn::LoadU(d, rays.direction_z + first + k);
    } else {
      HWY_ALIGN std::int32_t at[kRayLanes];
      hn::Store(hn::Min(hn::Iota(di, static_cast<std::int32_t>(first + k)), last), di, at);
      find_places(rays, at);
      x = hn::GatherIndex(d, rays.direction_x, hn::Load(di, at));
      y = hn::GatherIndex(d, rays.direction_y, hn::Load(di, at));
      z = hn::GatherIndex(d, rays.direction_z, hn::Load(di, at));
    }
    const auto bit = [&](const RayVec& v, std::int32_t value) HWY_ATTR {
      return hn::IfThenElseZero(hn::RebindMask(di, hn::Lt(v, hn::Zero(d))), hn::Set(di, value));
    };
    hn::StoreU(hn::Or(hn::Or(bit(x, 1), bit(y, 2)), bit(z, 4)), di, octants + k);
  }
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

/// Rays order[0…count − 1] of a block that begins with ray `first`, of which ray first + k leaves
/// point[k]; reads kRayLanes − 1 more of `order`. Sets the bits of those that are blocked.
template <class Rays>
HWY_NOINLINE void occluded_listed(const SceneView& scene, const Rays& rays, std::uint32_t first,
                                  const std::uint16_t* order, std::uint32_t count,
                                  const std::int32_t* point, Turn& turn, std::uint32_t* bits) {
  WorldBundle bundle;
  for (std::uint32_t k = 0; k < count; k += kRayLanes) {
    const RayIndexTag di;
    const hn::Rebind<std::uint16_t, RayTag> d16;
    const auto place = hn::PromoteTo(di, hn::LoadU(d16, order + k));
    HWY_ALIGN std::int32_t in_block[kRayLanes];
    hn::Store(place, di, in_block);
    Places at;
    fetch(point, in_block, at.point);
    hn::Store(hn::Add(place, hn::Set(di, static_cast<std::int32_t>(first))), di, at.ray);
    find_places(rays, at.ray);
    load_rays(rays, at, bundle, k);
    load_more(scene, rays, at, bundle, k);
  }
  join_masks(rays, bundle, count);
  for (std::uint32_t found = occluded_together(scene, bundle, count, turn); found != 0;
       found &= found - 1) {
    const std::uint32_t i = first + order[__builtin_ctz(found)];
    bits[i / 32] |= 1u << (i % 32);
  }
}

/// Repeats the last one of a list of rays behind it, as whole vectors are read.
HWY_INLINE void close_list(std::uint16_t* list, std::uint32_t size) {
  for (std::uint32_t k = 0; k < kRayLanes; ++k) list[size + k] = list[size - 1];
}

/// Rays of one octant, in bundles: list[0…size − 1] of a block, as occluded_listed has it.
template <class Rays>
HWY_INLINE void occluded_octant(const SceneView& scene, const Rays& rays, std::uint32_t first,
                                std::uint16_t* list, std::uint32_t size, const std::int32_t* point,
                                Blockers& blockers, std::uint32_t* bits) {
  close_list(list, size);
  std::uint16_t waiting[2 * kBundle + kRayLanes];  // rays put off
  std::uint32_t waiting_count = 0;
  const auto walk_waiting = [&]() HWY_ATTR {
    const std::uint32_t now = waiting_count < kBundle ? waiting_count : kBundle;
    close_list(waiting, waiting_count);
    Turn turn{blockers, false, false};
    occluded_listed(scene, rays, first, waiting, now, point, turn, bits);
    waiting_count -= now;
    for (std::uint32_t k = 0; k < waiting_count; ++k) waiting[k] = waiting[kBundle + k];
  };
  for (std::uint32_t begin = 0; begin < size; begin += kBundle) {
    const std::uint32_t now = size - begin < kBundle ? size - begin : kBundle;
    Turn turn{blockers, true, is_alone(scene)};
    occluded_listed(scene, rays, first, list + begin, now, point, turn, bits);
    for (std::uint32_t left = turn.put_off; left != 0; left &= left - 1) {
      waiting[waiting_count++] = list[begin + static_cast<std::uint32_t>(__builtin_ctz(left))];
    }
    if (waiting_count >= kBundle) walk_waiting();
  }
  if (waiting_count > 0) walk_waiting();
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
  std::int32_t octants[kSorted + kRayLanes];
  find_octants(rays, first, count, octants);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::int32_t o = octants[k];
    list[o][size[o]++] = static_cast<std::uint16_t>(k);
  }
  for (std::uint32_t o = 0; o < 8; ++o) {
    if (size[o] == 0) continue;
    occluded_octant(scene, rays, first, list[o], size[o], point, blockers[o], bits);
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
  std::int32_t point[kSorted + kRayLanes];
  Blockers blockers[8];
  std::uint32_t p = 0;
  for (std::uint32_t i = 0; i < count; i += kSorted) {
    const std::uint32_t now = count - i < kSorted ? count - i : kSorted;
    for (std::uint32_t k = 0; k < now;) {
      while (bundles.first_ray[p + 1] <= i + k) ++p;
      const std::uint32_t left = bundles.first_ray[p + 1] - i;
      const std::uint32_t end = left < now ? left : now;
      // Some too many each time: the next point's follow.
      for (; k < end; k += kRayLanes) {
        hn::StoreU(hn::Set(RayIndexTag(), static_cast<std::int32_t>(p)), RayIndexTag(), point + k);
      }
      k = end;
    }
    occluded_sorted(scene, bundles, i, now, point, blockers, bits);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
