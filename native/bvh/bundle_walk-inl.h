// Any-hit rays through both levels of trees, together: each node and leaf is fetched and decoded
// once for all rays that reach it. Included once per instruction set by
// traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::uint32_t kAhead = 2;  ///< visits for which the next data have time to come

/// Sends rays through a tree until all have found something: `visit(leaf, rays)` returns those
/// that found their hit there, `address(child)` where a child's data is. Returns those that found
/// any. What is taken off the stack is fetched then, and visited only after what was taken before
/// it: in a tree that is larger than a cache, waiting for memory is what walking would do most.
template <class Visit, class Address>
HWY_INLINE std::uint32_t walk_bundle(const TreeView& tree, const WalkingRays& walking,
                                     const Reach& reach, std::uint32_t rays, const Visit& visit,
                                     const Address& address) {
  if (tree.node_count == 0 || rays == 0) return 0;
  Waiting waiting;
  std::uint32_t open = rays;
  visit_node<false>(tree.nodes[0], walking, reach, rays, waiting);
  std::uint32_t next[kAhead] = {}, next_rays[kAhead] = {};
  std::uint32_t idle = 0;  // turns in which nothing was taken or visited
  for (std::uint32_t turn = 0; open != 0 && idle <= kAhead; turn = (turn + 1) % kAhead, ++idle) {
    std::uint32_t child = next[turn], active = next_rays[turn] & open;
    next_rays[turn] = 0;
    const bool crowded = waiting.size >= kStackSize;  // one walk by itself always finds room
    if (waiting.size > 0 && !crowded) {
      next[turn] = waiting.child[--waiting.size];
      next_rays[turn] = waiting.rays[waiting.size];
      fetch_soon(address(next[turn]));
      idle = 0;
    } else if (crowded && active == 0) {
      child = waiting.child[--waiting.size];
      active = waiting.rays[waiting.size] & open;
      idle = 0;
    }
    if (active == 0) continue;
    idle = 0;
    if (child & Waiting::kLeaf) {
      open &= ~visit(child & ~Waiting::kLeaf, active);
    } else {
      visit_node<false>(tree.nodes[child], walking, reach, active, waiting);
    }
  }
  return rays & ~open;
}

/// The leaves that blocked most rays of the bundles before. In a room bundles that follow each
/// other have them in common: two leaves block half of the rays before these have walked at all.
/// What is asked first changes no answer.
class Blockers {
 public:
  /// Rays of `bundle` that these leaves of an instance block.
  template <class Visit>
  HWY_INLINE std::uint32_t block(std::uint32_t instance, std::uint32_t rays, const Visit& visit) {
    std::uint32_t found = 0;
    for (Leaf& leaf : leaves_) {
      if (leaf.count == 0 || leaf.instance != instance || found == rays) continue;
      const std::uint32_t now = visit(leaf.index, rays & ~found);
      found |= now;
      leaf.count = __builtin_popcount(now);
      if (leaf.count < kFew) leaf.count = 0;
    }
    return found;
  }

  /// A leaf has blocked so many rays.
  HWY_INLINE void keep(std::uint32_t instance, std::uint32_t index, int count) {
    if (count < kFew) return;
    Leaf* least = leaves_;
    for (Leaf& leaf : leaves_) {
      if (leaf.count < least->count) least = &leaf;
    }
    if (count > least->count) *least = {instance, index, count};
  }

 private:
  static constexpr int kKept = 3;
  static constexpr int kFew = 4;  ///< rays that it takes to be asked first

  struct Leaf {
    std::uint32_t instance = 0, index = 0;
    int count = 0;  ///< of rays blocked last; 0: not in use
  };
  Leaf leaves_[kKept];
};

inline constexpr int kPutOff = 8;  ///< rays that it takes for the rest to be put off

/// How a bundle walks. Where blockers catch many of its rays, the few that are left are better put
/// off until there is a bundle of them.
struct Turn {
  Blockers& blockers;
  bool ask;                   ///< the blockers first
  bool may_put_off;           ///< rays, which only a single instance can
  std::uint32_t put_off = 0;  ///< rays that blockers did not block and that have not walked
};

/// Rays of `bundle` that a set of curves or points blocks.
HWY_NOINLINE std::uint32_t walk_round(const MeshView& mesh, std::uint32_t instance,
                                      const LocalBundle& bundle, std::uint32_t rays) {
  const RoundRays round(mesh, bundle, rays);
  Closest any;
  TimeTree tree;
  const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
    return round.meet(mesh, instance, tree.leaves[leaf], active,
                      [&](std::uint32_t) { return &any; });
  };
  const auto address = [&](std::uint32_t child) HWY_ATTR { return round_child(tree, child); };
  std::uint32_t found = 0;
  while (rays != 0) {  // all at once unless the instance is turned or the set deforms
    const std::uint32_t now = same_octant(bundle.slab, round.same_time(rays, tree));
    const WalkingRays walking(bundle.slab, now);
    const Reach reach(walking, bundle.rays, now);
    found |= walk_bundle(tree.tree, walking, reach, now, visit, address);
    rays &= ~now;
  }
  return found;
}

/// Rays of `bundle` that a mesh that deforms blocks.
HWY_NOINLINE std::uint32_t walk_moving(const MeshView& mesh, std::uint32_t instance,
                                       const LocalBundle& bundle, std::uint32_t rays) {
  const MovingRays moving(mesh, bundle, rays);
  Closest any;
  std::uint32_t found = 0;
  while (rays != 0) {
    const TimeTree* tree;
    const std::uint32_t now = same_octant(bundle.slab, moving.same_time(rays, tree));
    const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
      return moving.meet(mesh, instance, tree->leaf2triangle[leaf], active,
                         [&](std::uint32_t) { return &any; });
    };
    const auto address = [&](std::uint32_t child) HWY_ATTR { return moving_child(*tree, child); };
    const WalkingRays walking(bundle.slab, now);
    const Reach reach(walking, bundle.rays, now);
    found |= walk_bundle(tree->tree, walking, reach, now, visit, address);
    rays &= ~now;
  }
  return found;
}

/// Rays of `bundle` that a mesh blocks.
HWY_INLINE std::uint32_t walk_mesh(const MeshView& mesh, std::uint32_t instance,
                                   const LocalBundle& bundle, std::uint32_t rays, Turn& turn) {
  if (HWY_UNLIKELY(mesh.kind != PrimitiveKind::kTriangle)) {
    return is_round(mesh.kind) ? walk_round(mesh, instance, bundle, rays)
                               : walk_moving(mesh, instance, bundle, rays);
  }
  const auto test = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
    const std::byte* record = mesh.clusters + std::size_t{leaf} * kClusterUnit;
#if HWY_TARGET != HWY_SCALAR
    if (__builtin_popcount(active) >= kManyInLeaf)
      return ClusterInTurns(record).blocks(bundle, active);
#endif
    const OpenCluster cluster(record);
    std::uint32_t found = 0;
    for (; active != 0; active &= active - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(active));
      if (cluster.blocks(bundle, i)) found |= 1u << i;
    }
    return found;
  };
  const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
    const std::uint32_t found = test(leaf, active);
    turn.blockers.keep(instance, leaf, __builtin_popcount(found));
    return found;
  };
  const auto address = [&](std::uint32_t child) HWY_ATTR -> const void* {
    const std::byte* leaf = mesh.clusters + std::size_t{child & ~Waiting::kLeaf} * kClusterUnit;
    const void* node = mesh.tree.nodes + child;
    return child & Waiting::kLeaf ? leaf : node;
  };
  std::uint32_t found = 0;
  while (rays != 0) {  // all at once unless the instance is turned
    const std::uint32_t now = same_octant(bundle.slab, rays);
    const std::uint32_t blocked = turn.ask ? turn.blockers.block(instance, now, test) : 0;
    const std::uint32_t left = now & ~blocked;
    found |= blocked;
    if (turn.may_put_off && __builtin_popcount(blocked) >= kPutOff) {
      turn.put_off |= left;
    } else if (left != 0) {
      const WalkingRays walking(bundle.slab, left);
      const Reach reach(walking, bundle.rays, left);
      found |= walk_bundle(mesh.tree, walking, reach, left, visit, address);
    }
    rays &= ~now;
  }
  return found;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
