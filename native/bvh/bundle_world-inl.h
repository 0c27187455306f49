// Rays in the world, and their way into an instance. Included once per instruction set by
// traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays in the world.
struct WorldBundle {
  Bundle rays;
  BundleSlab slab;
  std::uint32_t self_instance[kBundle], self_primitive[kBundle], mask[kBundle];
  float time[kBundle];                   ///< where the scene moves or has a filter
  std::uint32_t path_key[kBundle];       ///< where it has a filter
  std::uint32_t some_mask, common_mask;  ///< of all rays: bits that any has, bits that each has

  /// Ray i of a scene that moves or has a filter, but for its path_key.
  Ray ray(std::uint32_t i) const {
    Ray ray;
    ray.origin = Vec3(rays.o[0][i], rays.o[1][i], rays.o[2][i]);
    ray.direction = Vec3(rays.d[0][i], rays.d[1][i], rays.d[2][i]);
    ray.t_min = rays.t_min[i];
    ray.t_max = rays.t_max[i];
    ray.time = time[i];
    ray.mask = mask[i];
    ray.self_instance = self_instance[i];
    ray.self_primitive = self_primitive[i];
    return ray;
  }
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
    const Ray ray = bundle.ray(i);
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

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
