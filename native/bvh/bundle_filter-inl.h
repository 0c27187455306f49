// Instances of which only some hits count (core/hit_filter.h): those of a leaf are asked about
// together, as the filter works on many at a time. Nothing here is run for any other instance.
// Included once per instruction set by traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// What the rays of a bundle meet in a leaf.
class Candidates {
 public:
  Candidates(const SceneView& scene, const WorldBundle& bundle)
      : filter_(scene.filter), bundle_(bundle) {}
  Candidates(const Candidates&) = delete;

  void add(std::uint32_t i, const Hit& hit) {
    HitQuery& query = *new (&query_[count_]) HitQuery{hit, bundle_.ray(i)};
    query.ray.path_key = bundle_.path_key[i];
    ray_[count_++] = i;
  }

  /// Calls visit(ray, hit) for those that count, and forgets all.
  template <class Visit>
  void ask(const Visit& visit) {
    if (count_ == 0) return;
    filter_.accepts(filter_.user, query_, count_, accepted_);
    for (std::uint32_t k = 0; k < count_; ++k) {
      if (accepted_[k]) visit(ray_[k], query_[k].hit);
    }
    count_ = 0;
  }

 private:
  static constexpr std::uint32_t kMost = kBundle * kClusterTriangles;
  const HitFilter& filter_;
  const WorldBundle& bundle_;
  std::uint32_t count_ = 0;
  std::uint32_t ray_[kMost];
  bool accepted_[kMost];
  union {  // not set to anything before: 18 KiB an instance that a bundle enters
    HitQuery query_[kMost];
  };
};

/// Calls walk(tree, rays, list, address) for rays of one octant and tree after the other, with what
/// walk_bundle needs; list(leaf, rays, add) calls add(ray, hit) for every hit in a leaf.
template <class Walk>
HWY_INLINE void each_tree(const MeshView& mesh, std::uint32_t instance, const LocalBundle& bundle,
                          std::uint32_t rays, const Walk& walk) {
  while (rays != 0) {
    const std::uint32_t now = same_octant(bundle.slab, rays);
    const auto list = [&](std::uint32_t leaf, std::uint32_t active, const auto& add) HWY_ATTR {
      const OpenCluster cluster(mesh.clusters + std::size_t{leaf} * kClusterUnit);
      for (; active != 0; active &= active - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(active));
        cluster.each_hit(bundle, i, instance, [&](const Hit& hit) HWY_ATTR { add(i, hit); });
      }
    };
    walk(mesh.tree, now, list, [&](std::uint32_t child) HWY_ATTR -> const void* {
      const std::byte* leaf = mesh.clusters + std::size_t{child & ~Waiting::kLeaf} * kClusterUnit;
      const void* node = mesh.tree.nodes + child;
      return child & Waiting::kLeaf ? leaf : node;
    });
    rays &= ~now;
  }
}

/// The hits that meet(closest) finds, where `closest(ray)` is where it keeps that of a ray.
template <class Meet, class Add>
HWY_INLINE void list_alone(const Meet& meet, const Add& add) {
  Closest alone[kBundle];
  for (std::uint32_t found = meet([&](std::uint32_t i) HWY_ATTR { return &alone[i]; }); found != 0;
       found &= found - 1) {
    const auto i = static_cast<std::uint32_t>(__builtin_ctz(found));
    add(i, alone[i].hit);
  }
}

/// The same in a set of curves or points.
template <class Walk>
HWY_INLINE void each_round_tree(const MeshView& mesh, std::uint32_t instance,
                                const LocalBundle& bundle, std::uint32_t rays, const Walk& walk) {
  const RoundRays round(mesh, bundle, rays);
  TimeTree tree;
  while (rays != 0) {
    const std::uint32_t now = same_octant(bundle.slab, round.same_time(rays, tree));
    const auto list = [&](std::uint32_t leaf, std::uint32_t active, const auto& add) HWY_ATTR {
      list_alone(
          [&](const auto& closest)
              HWY_ATTR { return round.meet(mesh, instance, tree.leaves[leaf], active, closest); },
          add);
    };
    walk(tree.tree, now, list,
         [&](std::uint32_t child) HWY_ATTR { return round_child(tree, child); });
    rays &= ~now;
  }
}

/// The same in a mesh that deforms.
template <class Walk>
HWY_INLINE void each_moving_tree(const MeshView& mesh, std::uint32_t instance,
                                 const LocalBundle& bundle, std::uint32_t rays, const Walk& walk) {
  const MovingRays moving(mesh, bundle, rays);
  const TimeTree* tree;
  while (rays != 0) {
    const std::uint32_t now = same_octant(bundle.slab, moving.same_time(rays, tree));
    const auto list = [&](std::uint32_t leaf, std::uint32_t active, const auto& add) HWY_ATTR {
      list_alone(
          [&](const auto& closest) HWY_ATTR {
            return moving.meet(mesh, instance, tree->leaf2triangle[leaf], active, closest);
          },
          add);
    };
    walk(tree->tree, now, list,
         [&](std::uint32_t child) HWY_ATTR { return moving_child(*tree, child); });
    rays &= ~now;
  }
}

template <class Walk>
HWY_INLINE void each_tree_of_any_kind(const MeshView& mesh, std::uint32_t instance,
                                      const LocalBundle& bundle, std::uint32_t rays,
                                      const Walk& walk) {
  if (mesh.kind == PrimitiveKind::kTriangle) return each_tree(mesh, instance, bundle, rays, walk);
  if (is_round(mesh.kind)) return each_round_tree(mesh, instance, bundle, rays, walk);
  each_moving_tree(mesh, instance, bundle, rays, walk);
}

/// Rays that something in a filtered instance blocks. Leaves that blocked many rays before are not
/// asked first: rays that pass one would ask the filter twice.
HWY_NOINLINE std::uint32_t walk_filtered(const SceneView& scene, const MeshView& mesh,
                                         std::uint32_t instance, const WorldBundle& world,
                                         const LocalBundle& bundle, std::uint32_t rays) {
  Candidates candidates(scene, world);
  std::uint32_t found = 0;
  const auto walk = [&](const TreeView& tree, std::uint32_t now, const auto& list,
                        const auto& address) HWY_ATTR {
    const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
      std::uint32_t blocked = 0;
      list(leaf, active, [&](std::uint32_t i, const Hit& hit) { candidates.add(i, hit); });
      candidates.ask([&](std::uint32_t i, const Hit&) { blocked |= 1u << i; });
      return blocked;
    };
    const WalkingRays walking(bundle.slab, now);
    const Reach reach(walking, bundle.rays, now);
    found |= walk_bundle(tree, walking, reach, now, visit, address);
  };
  each_tree_of_any_kind(mesh, instance, bundle, rays, walk);
  return found;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
