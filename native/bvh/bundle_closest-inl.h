// Closest hits of rays that follow each other, together: camera rays of neighbouring pixels meet
// nearly the same nodes and leaves. Included once per instruction set by traverse_simd.cpp, without
// a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// What the rays of a bundle have found so far.
struct Nearest {
  Closest closest[kBundle];
  HWY_ALIGN float limit[kBundle];  ///< Closest::limit

  /// Rays for which what begins at `begin` can still matter.
  HWY_INLINE std::uint32_t in_reach(float begin) const {
    const RayTag d;
    std::uint32_t rays = 0;
    for (std::uint32_t i = 0; i < kBundle; i += kRayLanes) {
      rays |= lane_bits(hn::Ge(hn::Load(d, limit + i), hn::Set(d, begin)), i);
    }
    return rays;
  }
};

/// The ends of rays in one tree: of the part that matters there, or the closest hit before it.
class Ends {
 public:
  HWY_INLINE Ends(const BundleSlab& slab, const Nearest& nearest) : slab_(slab), nearest_(nearest) {
    const RayTag d;
    for (std::uint32_t i = 0; i < kBundle; i += kRayLanes) {
      const RayVec limit = hn::Neg(hn::Load(d, nearest.limit + i));
      hn::Store(hn::Max(hn::Load(d, slab.minus_end + i), limit), d, minus_end_ + i);
    }
  }

  HWY_INLINE const float* minus_end() const { return minus_end_; }

  /// Ray i has found something nearer.
  HWY_INLINE void update(std::uint32_t i) {
    const float range = slab_.minus_end[i], limit = -nearest_.limit[i];
    minus_end_[i] = range > limit ? range : limit;
  }

 private:
  const BundleSlab& slab_;
  const Nearest& nearest_;
  HWY_ALIGN float minus_end_[kBundle];
};

/// Sends rays through a tree, near children first: `visit(leaf, rays)` returns those that found
/// something nearer there.
template <class Visit, class Address>
HWY_INLINE void walk_closest(const TreeView& tree, const Bundle& bundle, const BundleSlab& slab,
                             std::uint32_t rays, const Nearest& nearest, const Visit& visit,
                             const Address& address) {
  if (tree.node_count == 0 || rays == 0) return;
  Ends ends(slab, nearest);
  const WalkingRays walking(slab, rays, ends.minus_end());
  const Reach reach(walking, bundle, rays);
  Waiting waiting;
  visit_node<true>(tree.nodes[0], walking, reach, rays, waiting);
  while (waiting.size > 0) {
    const std::uint32_t child = waiting.child[--waiting.size];
    const std::uint32_t active =
        waiting.rays[waiting.size] & nearest.in_reach(waiting.begin[waiting.size]);
    if (waiting.size > 0) fetch_soon(address(waiting.child[waiting.size - 1]));
    if (active == 0) continue;
    if (child & Waiting::kLeaf) {
      std::uint32_t found = visit(child & ~Waiting::kLeaf, active);
      for (; found != 0; found &= found - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(found));
        ends.update(i);
      }
    } else {
      visit_node<true>(tree.nodes[child], walking, reach, active, waiting);
    }
  }
}

/// Rays of `bundle` that find something nearer in a set of curves or points.
HWY_NOINLINE std::uint32_t find_in_round(const MeshView& mesh, std::uint32_t instance,
                                         const LocalBundle& bundle, std::uint32_t rays,
                                         Nearest& nearest) {
  const RoundRays round(mesh, bundle, rays);
  std::uint32_t all_found = 0;
  TimeTree tree;
  const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
    const std::uint32_t found =
        round.meet(mesh, instance, tree.leaves[leaf], active,
                   [&](std::uint32_t i) HWY_ATTR { return &nearest.closest[i]; });
    for (std::uint32_t left = found; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(left));
      nearest.limit[i] = nearest.closest[i].limit;
    }
    all_found |= found;
    return found;
  };
  const auto address = [&](std::uint32_t child) HWY_ATTR { return round_child(tree, child); };
  while (rays != 0) {
    const std::uint32_t now = same_octant(bundle.slab, round.same_time(rays, tree));
    walk_closest(tree.tree, bundle.rays, bundle.slab, now, nearest, visit, address);
    rays &= ~now;
  }
  return all_found;
}

/// Rays of `bundle` that find something nearer in a mesh that deforms.
HWY_NOINLINE std::uint32_t find_in_moving(const MeshView& mesh, std::uint32_t instance,
                                          const LocalBundle& bundle, std::uint32_t rays,
                                          Nearest& nearest) {
  const MovingRays moving(mesh, bundle, rays);
  std::uint32_t all_found = 0;
  while (rays != 0) {
    const TimeTree* tree;
    const std::uint32_t now = same_octant(bundle.slab, moving.same_time(rays, tree));
    const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
      const std::uint32_t found = moving.meet(mesh, instance, tree->leaf2triangle[leaf], active,
                                              [&](std::uint32_t i) { return &nearest.closest[i]; });
      for (std::uint32_t left = found; left != 0; left &= left - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(left));
        nearest.limit[i] = nearest.closest[i].limit;
      }
      all_found |= found;
      return found;
    };
    const auto address = [&](std::uint32_t child) HWY_ATTR { return moving_child(*tree, child); };
    walk_closest(tree->tree, bundle.rays, bundle.slab, now, nearest, visit, address);
    rays &= ~now;
  }
  return all_found;
}

/// Rays of `bundle` that find something nearer in a mesh.
HWY_INLINE std::uint32_t find_in_mesh(const MeshView& mesh, std::uint32_t instance,
                                      const LocalBundle& bundle, std::uint32_t rays,
                                      Nearest& nearest) {
  if (HWY_UNLIKELY(mesh.kind != PrimitiveKind::kTriangle)) {
    return is_round(mesh.kind) ? find_in_round(mesh, instance, bundle, rays, nearest)
                               : find_in_moving(mesh, instance, bundle, rays, nearest);
  }
  std::uint32_t all_found = 0;
  const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
    const OpenCluster cluster(mesh.clusters + std::size_t{leaf} * kClusterUnit);
    std::uint32_t found = 0;
    for (; active != 0; active &= active - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(active));
      if (!cluster.find_closest(bundle, i, instance, nearest.closest[i])) continue;
      nearest.limit[i] = nearest.closest[i].limit;
      found |= 1u << i;
    }
    all_found |= found;
    return found;
  };
  const auto address = [&](std::uint32_t child) HWY_ATTR -> const void* {
    const std::byte* leaf = mesh.clusters + std::size_t{child & ~Waiting::kLeaf} * kClusterUnit;
    const void* node = mesh.tree.nodes + child;
    return child & Waiting::kLeaf ? leaf : node;
  };
  while (rays != 0) {
    const std::uint32_t now = same_octant(bundle.slab, rays);
    walk_closest(mesh.tree, bundle.rays, bundle.slab, now, nearest, visit, address);
    rays &= ~now;
  }
  return all_found;
}

/// Rays of `bundle` that find something nearer in a filtered instance.
HWY_NOINLINE std::uint32_t find_filtered(const SceneView& scene, const MeshView& mesh,
                                         std::uint32_t instance, const WorldBundle& world,
                                         const LocalBundle& bundle, std::uint32_t rays,
                                         Nearest& nearest) {
  Candidates candidates(scene, world);
  std::uint32_t all_found = 0;
  const auto walk = [&](const TreeView& tree, std::uint32_t now, const auto& list,
                        const auto& address) HWY_ATTR {
    const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
      std::uint32_t found = 0;
      list(leaf, active, [&](std::uint32_t i, const Hit& hit) {
        if (nearest.closest[i].is_better(hit)) candidates.add(i, hit);
      });
      candidates.ask([&](std::uint32_t i, const Hit& hit) {
        if (!nearest.closest[i].keep(hit)) return;
        nearest.limit[i] = nearest.closest[i].limit;
        found |= 1u << i;
      });
      all_found |= found;
      return found;
    };
    walk_closest(tree, bundle.rays, bundle.slab, now, nearest, visit, address);
  };
  each_tree_of_any_kind(mesh, instance, bundle, rays, walk);
  return all_found;
}

/// The closest hits of the first `count` rays of `bundle`.
HWY_INLINE void intersect_together(const SceneView& scene, WorldBundle& bundle, std::uint32_t count,
                                   Nearest& nearest) {
  for (std::uint32_t i = 0; i < kBundle; ++i) {
    const bool used = i < count;  // nothing is in reach of the others
    nearest.closest[i].limit = nearest.limit[i] = used ? bundle.rays.t_max[i] : -kFloatMax;
  }
  std::uint32_t rays = prepare(bundle, count);
  if (rays == 0 || scene.tree.node_count == 0) return;
  const auto visit = [&](std::uint32_t entry, std::uint32_t active) HWY_ATTR {
    LocalBundle local;
    std::uint32_t index;
    active = enter_leaf(scene, entry, bundle, active, local, index);
    if (active == 0) return 0u;
    const MeshView& mesh = scene.meshes[scene.instances[index].mesh];
    if (HWY_UNLIKELY(scene.instances[index].filtered)) {
      return find_filtered(scene, mesh, index, bundle, local, active, nearest);
    }
    return find_in_mesh(mesh, index, local, active, nearest);
  };
  const auto address = [&](std::uint32_t child) HWY_ATTR -> const void* {
    return scene.tree.nodes + (child & Waiting::kLeaf ? 0 : child);
  };
  while (rays != 0) {
    const std::uint32_t now = same_octant(bundle.slab, rays);
    walk_closest(scene.tree, bundle.rays, bundle.slab, now, nearest, visit, address);
    rays &= ~now;
  }
}

void intersect(const SceneView& scene, const RaySpan& rays, Hit* hits) {
  for (std::uint32_t first = 0; first < rays.count; first += kBundle) {
    const std::uint32_t now = rays.count - first < kBundle ? rays.count - first : kBundle;
    WorldBundle bundle;
    for (std::uint32_t k = 0; k < now; k += kRayLanes) {
      const RayIndexTag di;
      const auto last = hn::Set(di, static_cast<std::int32_t>(first + now - 1));
      const auto ray = hn::Min(hn::Iota(di, static_cast<std::int32_t>(first + k)), last);
      Places at;  // what is behind the last ray repeats it
      hn::Store(ray, di, at.ray);
      hn::Store(ray, di, at.point);
      load_rays(rays, at, bundle, k);
      load_more(scene, rays, at, bundle, k);
    }
    join_masks(rays, bundle, now);
    Nearest nearest;
    intersect_together(scene, bundle, now, nearest);
    for (std::uint32_t k = 0; k < now; ++k) hits[first + k] = nearest.closest[k].hit;
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
