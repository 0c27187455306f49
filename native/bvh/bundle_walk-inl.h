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

/// Rays in the world.
struct WorldBundle {
  Bundle rays;
  BundleSlab slab;
  std::uint32_t self_instance[kBundle], self_primitive[kBundle], mask[kBundle];
  float time[kBundle];                   ///< where the scene moves
  std::uint32_t some_mask, common_mask;  ///< of all rays: bits that any has, bits that each has
};

/// enter_instance for those of `bundle` whose bit is set; those that can hit anything there.
HWY_INLINE std::uint32_t enter(const InstanceView& instance, std::uint32_t index,
                               const WorldBundle& bundle, std::uint32_t rays, LocalBundle& local) {
  const RayTag d;
  const Mat3& m = instance.local_from_world;
  const Vec3 own_error = local_error(instance);
  // product() of core/local_ray.h
  const auto image = [&](const RayVec* v, int axis) HWY_ATTR {
    const RayVec sum =
        hn::Add(hn::Mul(hn::Set(d, m[0][axis]), v[0]), hn::Mul(hn::Set(d, m[1][axis]), v[1]));
    return hn::Add(sum, hn::Mul(hn::Set(d, m[2][axis]), v[2]));
  };
  const auto spread = [&](const RayVec* v, int axis) HWY_ATTR {
    const auto a = [&](int column) HWY_ATTR { return hn::Abs(hn::Set(d, m[column][axis])); };
    const RayVec sum = hn::Add(hn::Mul(a(0), hn::Abs(v[0])), hn::Mul(a(1), hn::Abs(v[1])));
    return hn::Add(sum, hn::Mul(a(2), hn::Abs(v[2])));
  };
  std::uint32_t entered = 0;
  for (std::uint32_t i = 0; i < kBundle && (rays >> i) != 0; i += kRayLanes) {
    const std::uint32_t left = clip(bundle.slab, instance.world_bounds, bundle.rays, i, local.slab);
    if ((left & rays) == 0) continue;
    RayVec offset[3], direction[3], origin[3], shift[3];
    for (int axis = 0; axis < 3; ++axis) {
      offset[axis] =
          hn::Sub(hn::Load(d, bundle.rays.o[axis] + i), hn::Set(d, instance.position[axis]));
      direction[axis] = hn::Load(d, bundle.rays.d[axis] + i);
    }
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = image(offset, axis);
      hn::Store(origin[axis], d, local.rays.o[axis] + i);
      hn::Store(image(direction, axis), d, local.rays.d[axis] + i);
    }
    const RayVec padding = hn::Set(d, kPadding);
    const RayVec largest = hn::Mul(largest_of(origin[0], origin[1], origin[2]), padding);
    for (int axis = 0; axis < 3; ++axis) {
      const RayVec error =
          hn::Add(hn::Mul(spread(offset, axis), padding), hn::Set(d, own_error[axis]));
      shift[axis] = hn::Add(error, largest);
    }
    hn::Store(hn::Load(d, bundle.rays.t_min + i), d, local.rays.t_min + i);
    hn::Store(hn::Load(d, bundle.rays.t_max + i), d, local.rays.t_max + i);
    entered |= left & make_slabs(local.rays, i, shift, local.slab);
    make_shears(local.rays, i, local.shear);
    for (std::uint32_t k = i; k < i + kRayLanes; ++k) {
      const bool here = bundle.self_instance[k] == index;
      local.self[k] = static_cast<std::int32_t>(here ? bundle.self_primitive[k] : kNone);
    }
  }
  return entered & rays;
}

/// Those of `rays` that see an instance.
HWY_INLINE std::uint32_t seeing(const InstanceView& instance, const WorldBundle& bundle,
                                std::uint32_t rays) {
  if ((instance.mask & bundle.some_mask) == 0 || instance.world_bounds.is_empty()) return 0;
  if ((instance.mask & bundle.common_mask) == 0) {  // some see it, others may not
    for (std::uint32_t left = rays; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(left));
      if ((instance.mask & bundle.mask[i]) == 0) rays &= ~(1u << i);
    }
  }
  return rays;
}

/// enter_group for those of `bundle` whose bit is set, each in the space of its own time.
HWY_NOINLINE std::uint32_t enter_moving(const SceneView& scene, const MotionGroup& group,
                                        const WorldBundle& bundle, std::uint32_t rays,
                                        LocalBundle& local) {
  std::uint32_t entered = 0;
  for (; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
    Ray ray;
    ray.origin = Vec3(bundle.rays.o[0][i], bundle.rays.o[1][i], bundle.rays.o[2][i]);
    ray.direction = Vec3(bundle.rays.d[0][i], bundle.rays.d[1][i], bundle.rays.d[2][i]);
    ray.t_min = bundle.rays.t_min[i];
    ray.t_max = bundle.rays.t_max[i];
    ray.time = bundle.time[i];
    ray.mask = bundle.mask[i];
    InstanceView at;
    LocalRay in;
    if (!enter_group(scene, group, ray, slab_ray(bundle.slab, i), &at, &in)) continue;
    local.put(i, in, local_direction(at, ray));
    const bool here = bundle.self_instance[i] == group.instance;
    local.self[i] = static_cast<std::int32_t>(here ? bundle.self_primitive[i] : kNone);
    entered |= 1u << i;
  }
  return entered;
}

/// Takes rays into what a leaf of the tree over instances stands for; those that can hit anything
/// there.
/// @param index  becomes the instance's
HWY_INLINE std::uint32_t enter_leaf(const SceneView& scene, std::uint32_t leaf,
                                    const WorldBundle& bundle, std::uint32_t rays,
                                    LocalBundle& local, std::uint32_t& index) {
  index = scene.leaf2instance[leaf];
  local.time = bundle.time;
  if (HWY_UNLIKELY(index >= scene.instance_count)) {
    const MotionGroup& group = scene.motion_groups[index - scene.instance_count];
    index = group.instance;
    return enter_moving(scene, group, bundle, rays, local);
  }
  rays = seeing(scene.instances[index], bundle, rays);
  return rays == 0 ? 0 : enter(scene.instances[index], index, bundle, rays, local);
}

/// Those of `rays` that what stands behind a leaf blocks.
HWY_INLINE std::uint32_t visit_instance(const SceneView& scene, std::uint32_t leaf,
                                        const WorldBundle& bundle, std::uint32_t rays, Turn& turn) {
  LocalBundle local;
  std::uint32_t index;
  rays = enter_leaf(scene, leaf, bundle, rays, local, index);
  if (rays == 0) return 0;
  return walk_mesh(scene.meshes[scene.instances[index].mesh], index, local, rays, turn);
}

/// One instance that stands still is all there is.
HWY_INLINE bool is_alone(const SceneView& scene) {
  return scene.instance_count == 1 && scene.motion_group_count == 0;
}

/// Makes the first `count` rays of `bundle` ready for the tree over instances; those that can hit
/// anything.
HWY_INLINE std::uint32_t prepare(WorldBundle& bundle, std::uint32_t count) {
  const RayTag d;
  std::uint32_t rays = 0;
  for (std::uint32_t i = 0; i < count; i += kRayLanes) {
    const RayVec largest =
        largest_of(hn::Load(d, bundle.rays.o[0] + i), hn::Load(d, bundle.rays.o[1] + i),
                   hn::Load(d, bundle.rays.o[2] + i));
    const RayVec padding = hn::Mul(largest, hn::Set(d, kPadding));
    const RayVec shift[3] = {padding, padding, padding};
    rays |= make_slabs(bundle.rays, i, shift, bundle.slab);
    hn::Store(hn::Load(d, bundle.rays.t_min + i), d, bundle.slab.begin + i);
    hn::Store(hn::Neg(hn::Load(d, bundle.rays.t_max + i)), d, bundle.slab.minus_end + i);
  }
  return rays & (count == 32 ? ~0u : (1u << count) - 1);
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

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
