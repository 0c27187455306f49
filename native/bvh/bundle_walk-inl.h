// Any-hit rays of one point through both levels of trees, together: each node and leaf is fetched
// and decoded once for all rays that reach it. Included once per instruction set by
// traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Sends rays through a tree until all have found something: `visit(leaf, rays)` returns those
/// that found their hit there, `address(child)` where a child's data is. Returns those that found
/// any.
template <class Visit, class Address>
HWY_INLINE std::uint32_t walk_bundle(const TreeView& tree, const BundleSlab& slab,
                                     std::uint32_t rays, const Visit& visit,
                                     const Address& address) {
  if (tree.node_count == 0 || rays == 0) return 0;
  Waiting waiting;
  const std::uint32_t all = rays;
  std::uint32_t open = all;
  visit_node(tree.nodes[0], slab, rays, waiting);
  const auto visit_child = [&](std::uint32_t child, std::uint32_t rays_of) HWY_ATTR {
    rays_of &= open;
    if (rays_of == 0) return;
    if (child & Waiting::kLeaf) {
      open &= ~visit(child & ~Waiting::kLeaf, rays_of);
    } else {
      visit_node(tree.nodes[child], slab, rays_of, waiting);
    }
  };
  while (waiting.size > 0 && open != 0) {
    const std::uint32_t child = waiting.child[--waiting.size];
    const std::uint32_t rays_of = waiting.rays[waiting.size];
    if (waiting.size == 0) {
      visit_child(child, rays_of);
      continue;
    }
    // Two at a time: the processor works on the second while the first waits for its results.
    const std::uint32_t second = waiting.child[--waiting.size];
    const std::uint32_t rays_of_second = waiting.rays[waiting.size];
    fetch_soon(address(second));
    visit_child(child, rays_of);
    visit_child(second, rays_of_second);
  }
  return all & ~open;
}

/// Rays of `bundle` that a mesh blocks.
HWY_INLINE std::uint32_t walk_mesh(const MeshView& mesh, const LocalBundle& bundle,
                                   std::uint32_t rays) {
  const auto visit = [&](std::uint32_t leaf, std::uint32_t active) HWY_ATTR {
    const ClusterView cluster(mesh.clusters + std::size_t{leaf} * kClusterUnit);
    const ClusterOfPoint of_point(cluster, bundle);
    std::uint32_t found = 0;
    for (; active != 0; active &= active - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(active));
      if (of_point.blocks(bundle, i)) found |= 1u << i;
    }
    return found;
  };
  const auto address = [&](std::uint32_t child) HWY_ATTR -> const void* {
    const std::byte* leaf = mesh.clusters + std::size_t{child & ~Waiting::kLeaf} * kClusterUnit;
    const void* node = mesh.tree.nodes + child;
    return child & Waiting::kLeaf ? leaf : node;
  };
  return walk_bundle(mesh.tree, bundle.slab, rays, visit, address);
}

/// The rays of one point, in the world.
struct WorldBundle {
  Vec3 origin;
  std::uint32_t self_instance, self_primitive, mask;
  Directions rays;
  BundleSlab slab;
};

/// product() of core/local_ray.h; a copy, so that no function of the baseline is called.
HWY_INLINE Vec3 image(const Mat3& m, const Vec3& v) {
  Vec3 r;
  for (int i = 0; i < 3; ++i) r[i] = (m[0][i] * v.x + m[1][i] * v.y) + m[2][i] * v.z;
  return r;
}
HWY_INLINE Vec3 image_of_absolute(const Mat3& m, const Vec3& v) {
  const auto a = [](float x) HWY_ATTR { return x < 0.0f ? -x : x; };
  Vec3 r;
  for (int i = 0; i < 3; ++i) {
    r[i] = (a(m[0][i]) * a(v.x) + a(m[1][i]) * a(v.y)) + a(m[2][i]) * a(v.z);
  }
  return r;
}

/// enter_instance for those of `bundle` whose bit is set, and the way through the mesh; returns
/// those that it blocks.
HWY_INLINE std::uint32_t visit_instance(const SceneView& scene, std::uint32_t index,
                                        const WorldBundle& bundle, std::uint32_t rays) {
  const InstanceView& instance = scene.instances[index];
  if ((instance.mask & bundle.mask) == 0 || instance.world_bounds.is_empty()) return 0;
  const RayTag d;
  LocalBundle local;
  const auto count = 32u - static_cast<std::uint32_t>(__builtin_clz(rays));
  rays &= clip(bundle.slab, instance.world_bounds, bundle.rays, count, local.slab);
  if (rays == 0) return 0;
  const Vec3 offset = bundle.origin - instance.position;
  local.origin = image(instance.local_from_world, offset);
  const Vec3 spread = image_of_absolute(instance.local_from_world, offset);
  const Vec3 error = spread * kPadding + instance.local_error;
  const Mat3& m = instance.local_from_world;
  for (std::uint32_t i = 0; i < count; i += kRayLanes) {
    const RayVec x = hn::Load(d, bundle.rays.d[0] + i), y = hn::Load(d, bundle.rays.d[1] + i),
                 z = hn::Load(d, bundle.rays.d[2] + i);
    for (int axis = 0; axis < 3; ++axis) {
      const RayVec sum =
          hn::Add(hn::Mul(hn::Set(d, m[0][axis]), x), hn::Mul(hn::Set(d, m[1][axis]), y));
      hn::Store(hn::Add(sum, hn::Mul(hn::Set(d, m[2][axis]), z)), d, local.rays.d[axis] + i);
    }
    hn::Store(hn::Load(d, bundle.rays.t_max + i), d, local.rays.t_max + i);
  }
  rays &= make_slabs(local.origin, error + Vec3(max_abs(local.origin) * kPadding), local.rays,
                     count, local.slab);
  if (rays == 0) return 0;
  make_shears(local.rays, count, local.shear);
  local.self = bundle.self_instance == index ? bundle.self_primitive : kNone;
  return walk_mesh(scene.meshes[instance.mesh], local, rays);
}

/// Rays first…first + count − 1 of point p, at most kBundle; bit i of the result for first + i.
HWY_INLINE std::uint32_t occluded_together(const SceneView& scene, const RayBundles& bundles,
                                           std::uint32_t p, std::uint32_t first,
                                           std::uint32_t count) {
  WorldBundle bundle;
  bundle.origin = Vec3(bundles.origin_x[p], bundles.origin_y[p], bundles.origin_z[p]);
  bundle.self_instance = bundles.self_instance[p];
  bundle.self_primitive = bundles.self_primitive[p];
  bundle.mask = bundles.mask;
  for (std::uint32_t i = 0; i < kBundle; ++i) {  // unused places repeat the last ray
    const std::uint32_t from = first + (i < count ? i : count - 1);
    bundle.rays.d[0][i] = bundles.direction_x[from];
    bundle.rays.d[1][i] = bundles.direction_y[from];
    bundle.rays.d[2][i] = bundles.direction_z[from];
    bundle.rays.t_max[i] = bundles.t_max[from];
    if (i % kRayLanes == 0 && i >= count) break;
  }
  std::uint32_t rays = count == 32 ? ~0u : (1u << count) - 1;
  rays &= make_slabs(bundle.origin, Vec3(max_abs(bundle.origin) * kPadding), bundle.rays, count,
                     bundle.slab);
  const auto visit = [&](std::uint32_t entry, std::uint32_t active) HWY_ATTR {
    return visit_instance(scene, scene.leaf2instance[entry], bundle, active);
  };
  // One instance alone needs no tree: entering it looks at its box anyway.
  if (rays == 0) return 0;
  if (scene.instance_count == 1) return scene.tree.node_count == 0 ? 0 : visit(0, rays);
  const RayTag d;
  for (std::uint32_t i = 0; i < count; i += kRayLanes) {
    hn::Store(hn::Zero(d), d, bundle.slab.begin + i);
    hn::Store(hn::Neg(hn::Load(d, bundle.rays.t_max + i)), d, bundle.slab.minus_end + i);
  }
  const auto address = [&](std::uint32_t child) HWY_ATTR -> const void* {
    return scene.tree.nodes + (child & Waiting::kLeaf ? 0 : child);
  };
  return walk_bundle(scene.tree, bundle.slab, rays, visit, address);
}

void occluded_bundles(const SceneView& scene, const RayBundles& bundles, std::uint32_t* bits) {
  const std::uint32_t count = bundles.ray_count();
  for (std::uint32_t i = 0; i < (count + 31) / 32; ++i) bits[i] = 0;
  for (std::uint32_t p = 0; p < bundles.point_count; ++p) {
    const std::uint32_t end = bundles.first_ray[p + 1];
    for (std::uint32_t i = bundles.first_ray[p]; i < end; i += kBundle) {
      const std::uint32_t now = end - i < kBundle ? end - i : kBundle;
      const std::uint64_t found = occluded_together(scene, bundles, p, i, now);
      const std::uint64_t shifted = (found & ((std::uint64_t{1} << now) - 1)) << (i % 32);
      bits[i / 32] |= static_cast<std::uint32_t>(shifted);
      if ((shifted >> 32) != 0) bits[i / 32 + 1] |= static_cast<std::uint32_t>(shifted >> 32);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
