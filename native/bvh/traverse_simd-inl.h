// Traversal of one ray, eight boxes or eight triangles at a time. Included once per instruction set
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
using PlaneTag = hn::Rebind<std::uint8_t, BoxTag>;
using CornerTag = hn::Rebind<std::uint16_t, BoxTag>;
using IndexTag = hn::Rebind<std::int32_t, BoxTag>;
using BoxVec = hn::Vec<BoxTag>;

/// A slab ray with the side of a box (0 lower, 1 upper) that it meets first, per axis.
struct BoxRay {
  explicit BoxRay(const SlabRay& ray) : slab(ray) {
    for (int axis = 0; axis < 3; ++axis) near_side[axis] = ray.inverse[axis] < 0.0f ? 1 : 0;
  }
  const SlabRay& slab;
  int near_side[3];
};

/// Planes of children part…part + lanes − 1, as WideNode::plane.
HWY_INLINE BoxVec planes(const WideNode& node, int axis, int side, std::size_t part) {
  const BoxTag d;
  const IndexTag di;
  const auto q = hn::PromoteTo(di, hn::LoadU(PlaneTag(), node.q[axis][side] + part));
  // The product is exact (a power of two), so that nothing depends on whether it is fused.
  return hn::MulAdd(hn::ConvertTo(d, q), hn::Set(d, node.step(axis)),
                    hn::Set(d, node.origin[axis]));
}

/// Bit i is set if the ray meets child i within [begin, end]; begins[i] is where it enters.
HWY_INLINE unsigned meet_boxes(const WideNode& node, const BoxRay& ray, float begin, float end,
                               float* begins) {
  const BoxTag d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  unsigned bits = 0;
  for (std::size_t part = 0; part < kWidth; part += kLanes) {
    auto enter = hn::Set(d, begin);
    auto leave = hn::Set(d, end);
    for (int axis = 0; axis < 3; ++axis) {
      const auto inverse = hn::Set(d, ray.slab.inverse[axis]);
      const auto near_plane = planes(node, axis, ray.near_side[axis], part);
      const auto far_plane = planes(node, axis, 1 - ray.near_side[axis], part);
      const auto t0 = hn::Mul(hn::Sub(near_plane, hn::Set(d, ray.slab.near_origin[axis])), inverse);
      const auto t1 = hn::Mul(hn::Sub(far_plane, hn::Set(d, ray.slab.far_origin[axis])), inverse);
      enter = hn::Max(enter, t0);
      leave = hn::Min(leave, t1);
    }
    hn::Store(enter, d, begins + part);
    std::uint8_t mask[8] = {};
    hn::StoreMaskBits(d, hn::Le(enter, leave), mask);
    bits |= static_cast<unsigned>(mask[0]) << part;
  }
  return bits & ((1u << node.child_count()) - 1);
}

/// The vertices of a cluster in a ray's sheared frame, as intersect_triangle computes them.
struct ShearedVertices {
  HWY_ALIGN float x[kClusterVertices];
  HWY_ALIGN float y[kClusterVertices];
};

HWY_INLINE void shear(const ClusterView& cluster, const ShearRay& ray, ShearedVertices& out) {
  const BoxTag d;
  const std::size_t n = cluster.vertex_count();
  const auto* coordinates = reinterpret_cast<const float*>(cluster.coordinates());
  for (std::size_t part = 0; part < kClusterVertices; part += hn::MaxLanes(d)) {
    const auto from_origin = [&](int axis) {  // what stands behind the last vertex is not used
      return hn::Sub(hn::LoadU(d, coordinates + static_cast<std::size_t>(axis) * n + part),
                     hn::Set(d, ray.origin[axis]));
    };
    const auto z = from_origin(ray.z);
    hn::Store(hn::Sub(from_origin(ray.x), hn::Mul(hn::Set(d, ray.sx), z)), d, out.x + part);
    hn::Store(hn::Sub(from_origin(ray.y), hn::Mul(hn::Set(d, ray.sy), z)), d, out.y + part);
  }
}

/// Bit k is set if triangle k's edge functions do not rule it out.
HWY_INLINE unsigned meet_cluster(const ClusterView& cluster, const ShearRay& ray) {
  const BoxTag d;
  const IndexTag di;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  ShearedVertices vertices;
  shear(cluster, ray, vertices);
  const auto* corners = reinterpret_cast<const std::uint16_t*>(cluster.corners());
  const auto zero = hn::Zero(d);
  const auto seven = hn::Set(di, 7);
  unsigned bits = 0;
  for (std::size_t part = 0; part < kClusterTriangles; part += kLanes) {
    const auto packed = hn::PromoteTo(di, hn::LoadU(CornerTag(), corners + part));
    const auto a = hn::And(packed, seven);
    const auto b = hn::And(hn::ShiftRight<3>(packed), seven);
    const auto c = hn::And(hn::ShiftRight<6>(packed), seven);
    const auto of = [&](const float* coordinate, auto index) HWY_ATTR {
      if constexpr (kLanes == kClusterVertices) {
        return hn::TableLookupLanes(hn::Load(d, coordinate), hn::IndicesFromVec(d, index));
      } else {
        return hn::GatherIndex(d, coordinate, index);
      }
    };
    const auto a_x = of(vertices.x, a), a_y = of(vertices.y, a);
    const auto b_x = of(vertices.x, b), b_y = of(vertices.y, b);
    const auto c_x = of(vertices.x, c), c_y = of(vertices.y, c);
    const auto u = hn::Sub(hn::Mul(c_x, b_y), hn::Mul(c_y, b_x));
    const auto v = hn::Sub(hn::Mul(a_x, c_y), hn::Mul(a_y, c_x));
    const auto w = hn::Sub(hn::Mul(b_x, a_y), hn::Mul(b_y, a_x));
    const auto front = hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Ge(w, zero));
    const auto back = hn::And(hn::And(hn::Le(u, zero), hn::Le(v, zero)), hn::Le(w, zero));
    std::uint8_t mask[8] = {};
    hn::StoreMaskBits(d, hn::Or(front, back), mask);
    bits |= static_cast<unsigned>(mask[0]) << part;
  }
  return bits & ((1u << cluster.triangle_count()) - 1);
}

/// Asks for two cache lines that will be read soon, a node or the better part of a cluster: a third
/// of the time of a ray is waiting for memory.
HWY_INLINE void fetch_soon(const void* object) {
  __builtin_prefetch(object);
  __builtin_prefetch(static_cast<const char*>(object) + 64);
}

/// Visits the leaves of a wide tree that the ray meets in `range` and not behind the closest hit;
/// for closest hits near children first. Stops, and returns true, when `visit` does.
template <bool kAny, class Visit>
HWY_INLINE bool walk(const TreeView& tree, const SlabRay& slab, Interval range, Visit& visit) {
  struct Entry {
    float begin;
    bool is_leaf;
    std::uint32_t child;
  };
  if (tree.node_count == 0) return false;
  const BoxRay ray(slab);
  HWY_ALIGN float begins[kWidth];
  Entry stack[kStackSize];
  std::uint32_t size = 0;
  Entry entry = {range.begin, false, 0};
  while (true) {
    if (entry.is_leaf) {
      if (visit(entry.child)) return true;
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
        const int child = static_cast<int>(i);
        const bool is_leaf = child >= node.inner_count();
        stack[place] = {begins[i], is_leaf,
                        is_leaf ? node.child_leaf(child) : node.child_node(child)};
        if constexpr (kAny) {  // rays for closest hits are coherent: theirs are in the cache
          if (is_leaf) {
            visit.prefetch(stack[place].child);
          } else {
            fetch_soon(tree.nodes + stack[place].child);
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

/// A ray inside one instance: tests the clusters of its mesh.
template <bool kAny, class Filter>
struct ClusterVisitor {
  const Ray& ray;
  const LocalRay& local;
  const std::byte* clusters;
  std::uint32_t instance;
  const Filter& filter;
  Closest& closest;

  float limit() const { return closest.limit; }
  void prefetch(std::uint32_t leaf) const {
    fetch_soon(clusters + std::size_t{leaf} * kClusterUnit);
  }

  bool operator()(std::uint32_t leaf) const {
    const ClusterView cluster(clusters + std::size_t{leaf} * kClusterUnit);
    for (unsigned bits = meet_cluster(cluster, local.shear); bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::uint32_t>(__builtin_ctz(bits));
      const bool found =
          test_triangle(local, ray, instance, cluster.primitive(k), cluster.position(k, 0),
                        cluster.position(k, 1), cluster.position(k, 2), filter, &closest);
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

  bool operator()(std::uint32_t entry) const {
    const std::uint32_t index = scene.leaf2instance[entry];
    const InstanceView& instance = scene.instances[index];
    LocalRay local;
    if (!enter_instance(instance, ray, world, &local)) return false;
    const MeshView& mesh = scene.meshes[instance.mesh];
    ClusterVisitor<kAny, Filter> visit{ray, local, mesh.clusters, index, filter, closest};
    return walk<kAny>(mesh.tree, local.slab, local.range, visit);
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

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
