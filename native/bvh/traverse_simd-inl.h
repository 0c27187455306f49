// Traversal of one ray, eight boxes or four triangles at a time. Included once per instruction set
// (no include guard): everything lives in that set's own namespace, so that the linker can never
// put a copy with AVX instructions where the baseline calls it.
//
// No function here decides anything that core/ does not: boxes are met by the operations of
// slab_interval, and the triangle test only picks candidates, with the first operations of
// intersect_triangle, which then decides. So hits are those of trace_scalar to the bit.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using BoxTag = hn::CappedTag<float, kWidth>;
using BlockTag = hn::CappedTag<float, kBlockSize>;

/// A slab ray spread over lanes; `near_row` is the first row of planes that it meets per axis, in
/// floats from the node's start.
struct BoxRay {
  explicit BoxRay(const SlabRay& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t lo = static_cast<std::size_t>(axis * kWidth);
      const std::size_t hi = lo + 3 * kWidth;
      const bool backward = ray.inverse[axis] < 0.0f;
      near_row[axis] = backward ? hi : lo;
      far_row[axis] = backward ? lo : hi;
      near_origin[axis] = ray.near_origin[axis];
      far_origin[axis] = ray.far_origin[axis];
      inverse[axis] = ray.inverse[axis];
    }
  }
  std::size_t near_row[3], far_row[3];
  float near_origin[3], far_origin[3], inverse[3];
};

/// Bit i is set if the ray meets child i within [begin, end]; begins[i] is where it enters.
HWY_INLINE unsigned meet_boxes(const WideNode& node, const BoxRay& ray, float begin, float end,
                               float* begins) {
  const BoxTag d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const float* planes = &node.lo[0][0];
  unsigned bits = 0;
  for (std::size_t part = 0; part < kWidth; part += kLanes) {
    auto enter = hn::Set(d, begin);
    auto leave = hn::Set(d, end);
    for (int axis = 0; axis < 3; ++axis) {
      const auto inverse = hn::Set(d, ray.inverse[axis]);
      const auto near_plane = hn::Load(d, planes + ray.near_row[axis] + part);
      const auto far_plane = hn::Load(d, planes + ray.far_row[axis] + part);
      const auto t0 = hn::Mul(hn::Sub(near_plane, hn::Set(d, ray.near_origin[axis])), inverse);
      const auto t1 = hn::Mul(hn::Sub(far_plane, hn::Set(d, ray.far_origin[axis])), inverse);
      enter = hn::Max(enter, t0);
      leave = hn::Min(leave, t1);
    }
    hn::Store(enter, d, begins + part);
    std::uint8_t mask[8] = {};
    hn::StoreMaskBits(d, hn::Le(enter, leave), mask);
    bits |= static_cast<unsigned>(mask[0]) << part;
  }
  return bits;
}

/// Bit k is set if triangle k's edge functions do not rule it out.
HWY_INLINE unsigned meet_block(const TriangleBlock& block, const ShearRay& ray) {
  const BlockTag d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const auto origin_x = hn::Set(d, ray.origin[ray.x]);
  const auto origin_y = hn::Set(d, ray.origin[ray.y]);
  const auto origin_z = hn::Set(d, ray.origin[ray.z]);
  const auto shear_x = hn::Set(d, ray.sx);
  const auto shear_y = hn::Set(d, ray.sy);
  const auto zero = hn::Zero(d);
  unsigned bits = 0;
  for (std::size_t part = 0; part < kBlockSize; part += kLanes) {
    const auto a_z = hn::Sub(hn::Load(d, block.corner[0][ray.z] + part), origin_z);
    const auto b_z = hn::Sub(hn::Load(d, block.corner[1][ray.z] + part), origin_z);
    const auto c_z = hn::Sub(hn::Load(d, block.corner[2][ray.z] + part), origin_z);
    const auto a_x = hn::Sub(hn::Sub(hn::Load(d, block.corner[0][ray.x] + part), origin_x),
                             hn::Mul(shear_x, a_z));
    const auto a_y = hn::Sub(hn::Sub(hn::Load(d, block.corner[0][ray.y] + part), origin_y),
                             hn::Mul(shear_y, a_z));
    const auto b_x = hn::Sub(hn::Sub(hn::Load(d, block.corner[1][ray.x] + part), origin_x),
                             hn::Mul(shear_x, b_z));
    const auto b_y = hn::Sub(hn::Sub(hn::Load(d, block.corner[1][ray.y] + part), origin_y),
                             hn::Mul(shear_y, b_z));
    const auto c_x = hn::Sub(hn::Sub(hn::Load(d, block.corner[2][ray.x] + part), origin_x),
                             hn::Mul(shear_x, c_z));
    const auto c_y = hn::Sub(hn::Sub(hn::Load(d, block.corner[2][ray.y] + part), origin_y),
                             hn::Mul(shear_y, c_z));
    const auto u = hn::Sub(hn::Mul(c_x, b_y), hn::Mul(c_y, b_x));
    const auto v = hn::Sub(hn::Mul(a_x, c_y), hn::Mul(a_y, c_x));
    const auto w = hn::Sub(hn::Mul(b_x, a_y), hn::Mul(b_y, a_x));
    const auto front = hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Ge(w, zero));
    const auto back = hn::And(hn::And(hn::Le(u, zero), hn::Le(v, zero)), hn::Le(w, zero));
    std::uint8_t mask[8] = {};
    hn::StoreMaskBits(d, hn::Or(front, back), mask);
    bits |= static_cast<unsigned>(mask[0]) << part;
  }
  return bits;
}

/// Asks for the cache lines of an object that will be read soon: a third of the time of a ray is
/// waiting for memory.
template <std::size_t kBytes>
HWY_INLINE void fetch_soon(const void* object) {
  for (std::size_t offset = 0; offset < kBytes; offset += 64) {
    __builtin_prefetch(static_cast<const char*>(object) + offset);
  }
}

/// Visits the leaves of a wide tree that the ray meets in `range` and not behind the closest hit;
/// for closest hits near children first. Stops, and returns true, when `visit` does.
template <bool kAny, class Visit>
HWY_INLINE bool walk(const TreeView& tree, const SlabRay& slab, Interval range, Visit& visit) {
  struct Entry {
    float begin;
    std::uint32_t child, count;
  };
  if (tree.node_count == 0) return false;
  const BoxRay ray(slab);
  HWY_ALIGN float begins[kWidth];
  Entry stack[kStackSize];
  std::uint32_t size = 0;
  Entry entry = {range.begin, 0, 0};
  while (true) {
    if (entry.count > 0) {
      if (visit(entry.child, entry.count)) return true;
    } else {
      const WideNode& node = tree.nodes[entry.child];
      const float limit = min_of(range.end, visit.limit());
      unsigned bits = meet_boxes(node, ray, range.begin, limit, begins);
      const std::uint32_t bottom = size;
      while (bits != 0) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(bits));
        bits &= bits - 1;
        std::uint32_t place = size++;
        if constexpr (!kAny) {  // sorted: the nearest on top
          for (; place > bottom && stack[place - 1].begin < begins[i]; --place) {
            stack[place] = stack[place - 1];
          }
        }
        stack[place] = {begins[i], node.child[i], node.count[i]};
        if constexpr (kAny) {  // rays for closest hits are coherent: theirs are in the cache
          if (node.count[i] > 0) {
            visit.prefetch(node.child[i]);
          } else {
            fetch_soon<sizeof(WideNode)>(tree.nodes + node.child[i]);
          }
        }
      }
    }
    do {
      if (size == 0) return false;
      entry = stack[--size];
    } while (!kAny && entry.begin > visit.limit());
  }
}

/// A ray inside one instance: tests the blocks of its mesh.
template <bool kAny, class Filter>
struct BlockVisitor {
  const Ray& ray;
  const LocalRay& local;
  const TriangleBlock* blocks;
  std::uint32_t instance;
  const Filter& filter;
  Closest& closest;

  float limit() const { return closest.limit; }
  void prefetch(std::uint32_t leaf) const { fetch_soon<sizeof(TriangleBlock)>(blocks + leaf); }

  bool operator()(std::uint32_t leaf, std::uint32_t) const {
    const TriangleBlock& block = blocks[leaf];
    for (unsigned bits = meet_block(block, local.shear); bits != 0; bits &= bits - 1) {
      const int k = __builtin_ctz(bits);
      const bool found =
          test_triangle(local, ray, instance, block.primitive[k], block.position(0, k),
                        block.position(1, k), block.position(2, k), filter, &closest);
      if (kAny && found) return true;
    }
    return false;
  }
};

/// A ray in the world: enters instances.
template <bool kAny, class Filter>
struct InstanceVisitor {
  const SceneView& scene;
  const Ray& ray;
  const SlabRay& world;
  const Filter& filter;
  Closest& closest;

  float limit() const { return closest.limit; }
  void prefetch(std::uint32_t) const {}

  bool operator()(std::uint32_t first, std::uint32_t count) const {
    for (std::uint32_t i = first; i < first + count; ++i) {
      const std::uint32_t index = scene.leaf2instance[i];
      const InstanceView& instance = scene.instances[index];
      LocalRay local;
      if (!enter_instance(instance, ray, world, &local)) continue;
      const MeshView& mesh = scene.meshes[instance.mesh];
      BlockVisitor<kAny, Filter> visit{ray, local, mesh.blocks, index, filter, closest};
      if (walk<kAny>(mesh.tree, local.slab, local.range, visit)) return true;
    }
    return false;
  }
};

template <bool kAny, class Filter>
HWY_INLINE Hit trace(const SceneView& scene, const Ray& ray, const Filter& filter) {
  Closest closest(ray);
  const SlabRay world = make_world_slab(ray);
  if (!is_usable(world)) return closest.hit;
  InstanceVisitor<kAny, Filter> visit{scene, ray, world, filter, closest};
  walk<kAny>(scene.tree, world, Interval{ray.t_min, ray.t_max}, visit);
  return closest.hit;
}

void intersect(const SceneView& scene, const RaySpan& rays, Hit* hits) {
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    hits[i] = trace<false>(scene, rays[i], OpaqueFilter{});
  }
}

void occluded(const SceneView& scene, const RaySpan& rays, std::uint32_t* bits) {
  for (std::uint32_t i = 0; i < rays.count; i += 32) {
    std::uint32_t word = 0;
    for (std::uint32_t k = 0; k < 32 && i + k < rays.count; ++k) {
      if (trace<true>(scene, rays[i + k], OpaqueFilter{}).valid()) word |= 1u << k;
    }
    bits[i / 32] = word;
  }
}

void occluded_bundles(const SceneView& scene, const RayBundles& bundles, std::uint32_t* bits) {
  const std::uint32_t count = bundles.ray_count();
  for (std::uint32_t i = 0; i < (count + 31) / 32; ++i) bits[i] = 0;
  for (std::uint32_t p = 0; p < bundles.point_count; ++p) {
    for (std::uint32_t i = bundles.first_ray[p]; i < bundles.first_ray[p + 1]; ++i) {
      if (trace<true>(scene, bundles.ray(p, i), OpaqueFilter{}).valid())
        bits[i / 32] |= 1u << (i % 32);
    }
  }
}

}  // namespace

extern const Kernel kKernel;
constexpr Kernel kKernel = {&HWY_STR(HWY_NAMESPACE)[2], &intersect, &occluded,
                            &occluded_bundles};  // N_AVX2: "AVX2"

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
