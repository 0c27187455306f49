// One cluster of triangles and many rays. Included once per instruction set by traverse_simd.cpp,
// without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays in one instance.
struct LocalBundle {
  Bundle rays;
  BundleSlab slab;
  BundleShear shear;
  std::int32_t self[kBundle];  ///< primitive of the instance that is never hit, or kNone
  const float* time;           ///< where the scene moves

  /// Ray i as the triangle test takes it.
  LocalRay ray(std::uint32_t i) const {
    LocalRay local;
    local.slab = slab_ray(slab, i);
    local.shear = make_shear_ray(Vec3(rays.o[0][i], rays.o[1][i], rays.o[2][i]),
                                 Vec3(rays.d[0][i], rays.d[1][i], rays.d[2][i]));
    local.range = Interval{slab.begin[i], -slab.minus_end[i]};
    local.t_min = rays.t_min[i];
    local.t_max = rays.t_max[i];
    return local;
  }

  /// The reverse: ray i as it has been taken into the instance alone, and its shear ray.
  void put(std::uint32_t i, const LocalRay& local, const Vec3& direction) {
    const ShearRay& from = local.shear;
    for (int axis = 0; axis < 3; ++axis) {
      const float inverse = local.slab.inverse[axis];
      const float near = local.slab.near_origin[axis], far = local.slab.far_origin[axis];
      const bool backward = inverse < 0.0f;
      rays.o[axis][i] = from.origin[axis];
      rays.d[axis][i] = direction[axis];
      slab.minus_from_lower[axis][i] = -(backward ? far : near);
      slab.from_upper[axis][i] = backward ? near : far;
      slab.inverse[axis][i] = backward ? -inverse : inverse;
      slab.side[axis][i] = backward ? 1 : 0;
      if (backward) slab.backward[axis] |= 1u << i;
    }
    slab.begin[i] = local.range.begin;
    slab.minus_end[i] = -local.range.end;
    rays.t_min[i] = local.t_min;
    rays.t_max[i] = local.t_max;
    shear.x[i] = from.x;
    shear.y[i] = from.y;
    shear.z[i] = from.z;
    shear.sx[i] = from.sx;
    shear.sy[i] = from.sy;
    shear.sz[i] = from.sz;
    shear.o[0][i] = from.origin[from.x];
    shear.o[1][i] = from.origin[from.y];
    shear.o[2][i] = from.origin[from.z];
  }
};

/// A cluster with its corners' indices taken apart.
class OpenCluster {
 public:
  HWY_INLINE explicit OpenCluster(const std::byte* record)
      : cluster_(record),
        used_((1u << cluster_.triangle_count()) - 1),
        vertex_count_(cluster_.vertex_count()),
        coordinates_(reinterpret_cast<const float*>(cluster_.coordinates())) {
    const IndexTag di;
    const auto* corners = reinterpret_cast<const std::uint16_t*>(cluster_.corners());
    for (std::size_t part = 0; part < kClusterTriangles; part += kLanes) {
      const auto packed = hn::PromoteTo(di, hn::LoadU(CornerTag(), corners + part));
      set_corner(0, part, packed);
      set_corner(1, part, hn::ShiftRight<3>(packed));
      set_corner(2, part, hn::ShiftRight<6>(packed));
    }
  }

  /// Whether one of the triangles is hit by ray i: intersect_triangle, eight at a time.
  HWY_INLINE bool blocks(const LocalBundle& bundle, std::uint32_t i) const {
    return each_part(bundle, i, [&](const Part& part) HWY_ATTR {
      BoxVec t, determinant;
      if ((part.sure & are_in_reach(bundle, i, part, t, determinant)) != 0) return true;
      return part.inside != part.sure && is_hit(bundle, i, part);
    });
  }

  /// Keeps in `closest` the best hit of ray i: test_triangle (bvh/closest.h), eight at a time. True
  /// if it is a new one.
  HWY_INLINE bool find_closest(const LocalBundle& bundle, std::uint32_t i, std::uint32_t instance,
                               Closest& closest) const {
    bool found = false;
    each_hit(bundle, i, instance, [&](const Hit& hit) HWY_ATTR { found |= closest.keep(hit); });
    return found;
  }

  /// Calls visit(hit) for all of the triangles that ray i hits.
  template <class Visit>
  HWY_INLINE void each_hit(const LocalBundle& bundle, std::uint32_t i, std::uint32_t instance,
                           const Visit& visit) const {
    each_part(bundle, i, [&](const Part& part) HWY_ATTR {
      const BoxTag d;
      BoxVec t, determinant;
      if (unsigned good = part.sure & are_in_reach(bundle, i, part, t, determinant); good != 0) {
        HWY_ALIGN float all_t[kLanes], u[kLanes], v[kLanes];
        hn::Store(hn::Add(t, hn::Zero(d)), d, all_t);  // never −0
        hn::Store(hn::Div(part.v, determinant), d, u);
        hn::Store(hn::Div(part.w, determinant), d, v);
        for (; good != 0; good &= good - 1) {
          const auto k = static_cast<std::uint32_t>(__builtin_ctz(good));
          const auto primitive = cluster_.primitive(static_cast<std::uint32_t>(part.first) + k);
          visit(Hit{all_t[k], u[k], v[k], instance, primitive});
        }
      }
      if (part.inside != part.sure) each_doubtful_hit(bundle, i, part, instance, visit);
      return false;
    });
  }

 private:
  static constexpr std::size_t kLanes = hn::MaxLanes(BoxTag());

  /// Triangles first…first + lanes − 1 and one ray: their edge functions, which of them the ray
  /// may meet, and of which of these no edge function is zero.
  struct Part {
    std::size_t first;
    BoxVec u, v, w;
    unsigned inside, sure;
  };

  /// The first half of intersect_triangle; hands on the parts with any such triangle, until one is
  /// answered with true.
  template <class Visit>
  HWY_INLINE bool each_part(const LocalBundle& bundle, std::uint32_t i, const Visit& visit) const {
    const BundleShear& shear = bundle.shear;
    const BoxTag d;
    const IndexTag di;
    HWY_ALIGN float x[kClusterVertices], y[kClusterVertices];
    const float* at_x = coordinate(shear.x[i]);
    const float* at_y = coordinate(shear.y[i]);
    const float* at_z = coordinate(shear.z[i]);
    const auto sx = hn::Set(d, shear.sx[i]), sy = hn::Set(d, shear.sy[i]);
    const auto o_x = hn::Set(d, shear.o[0][i]), o_y = hn::Set(d, shear.o[1][i]),
               o_z = hn::Set(d, shear.o[2][i]);
    for (std::size_t part = 0; part < kClusterVertices; part += kLanes) {
      const auto z = hn::Sub(hn::LoadU(d, at_z + part), o_z);
      hn::Store(hn::Sub(hn::Sub(hn::LoadU(d, at_x + part), o_x), hn::Mul(sx, z)), d, x + part);
      hn::Store(hn::Sub(hn::Sub(hn::LoadU(d, at_y + part), o_y), hn::Mul(sy, z)), d, y + part);
    }
    const auto* primitives = reinterpret_cast<const std::int32_t*>(coordinate(3));
    const auto self = hn::Set(di, bundle.self[i]);
    for (std::size_t part = 0; part < kClusterTriangles; part += kLanes) {
      const auto a_x = corner(x, 0, part), a_y = corner(y, 0, part);
      const auto b_x = corner(x, 1, part), b_y = corner(y, 1, part);
      const auto c_x = corner(x, 2, part), c_y = corner(y, 2, part);
      const auto u = hn::Sub(hn::Mul(c_x, b_y), hn::Mul(c_y, b_x));
      const auto v = hn::Sub(hn::Mul(a_x, c_y), hn::Mul(a_y, c_x));
      const auto w = hn::Sub(hn::Mul(b_x, a_y), hn::Mul(b_y, a_x));
      const auto least = hn::Min(hn::Min(u, v), w), most = hn::Max(hn::Max(u, v), w);
      const auto zero = hn::Zero(d);
      const auto other = hn::RebindMask(d, hn::Ne(hn::LoadU(di, primitives + part), self));
      const auto meets = hn::And(hn::Or(hn::Ge(least, zero), hn::Le(most, zero)), other);
      const unsigned inside = bits_of(meets) & (used_ >> part);
      if (inside == 0) continue;
      const auto exact = hn::And(hn::And(hn::Ne(u, zero), hn::Ne(v, zero)), hn::Ne(w, zero));
      if (visit(Part{part, u, v, w, inside, inside & bits_of(exact)})) return true;
    }
    return false;
  }

  template <class Mask>
  static HWY_INLINE unsigned bits_of(const Mask& mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(BoxTag(), mask, bytes);
    return bytes[0];
  }

  /// Keeps which vertex a corner is (three bits of `packed`), as `corner` needs it: the index, or
  /// where vectors are too short for one table of eight, the places of the float's four bytes.
  HWY_INLINE void set_corner(std::size_t which, std::size_t part, const hn::Vec<IndexTag>& packed) {
    const IndexTag di;
    const auto index = hn::And(packed, hn::Set(di, 7));
    if constexpr (kLanes == kClusterVertices || kLanes == 1) {
      hn::Store(index, di, corner_[which] + part);
    } else {
      const auto bytes = hn::Mul(index, hn::Set(di, 0x04040404));
      hn::Store(hn::Add(bytes, hn::Set(di, 0x03020100)), di, corner_[which] + part);
    }
  }

  /// Of all vertices; behind the last one is nothing of use.
  HWY_INLINE const float* coordinate(std::int32_t axis) const {
    return coordinates_ + static_cast<std::uint32_t>(axis) * vertex_count_;
  }

  /// A corner's coordinate of triangles part…part + lanes − 1, from that of all vertices.
  HWY_INLINE BoxVec corner(const float* coordinate, std::size_t which, std::size_t part) const {
    const BoxTag d;
    const auto index = hn::Load(IndexTag(), corner_[which] + part);
#if HWY_TARGET == HWY_SCALAR
    return hn::GatherIndex(d, coordinate, hn::And(index, hn::Set(IndexTag(), 7)));
#else
    if constexpr (kLanes == kClusterVertices) {
      return hn::TableLookupLanes(hn::LoadU(d, coordinate), hn::IndicesFromVec(d, index));
    } else {
      // Two tables of sixteen bytes; a place with its highest bit set gives 0.
      const hn::Repartition<std::uint8_t, BoxTag> d8;
      const auto place = hn::BitCast(d8, index);
      const auto low = hn::TableLookupBytesOr0(hn::BitCast(d8, hn::LoadU(d, coordinate)),
                                               hn::Add(place, hn::Set(d8, 0x70)));
      const auto high = hn::TableLookupBytesOr0(hn::BitCast(d8, hn::LoadU(d, coordinate + 4)),
                                                hn::Sub(place, hn::Set(d8, 0x10)));
      return hn::BitCast(d, hn::Or(low, high));
    }
#endif
  }

  /// The second half of intersect_triangle, for triangles of which no edge function is zero:
  /// whether the hit lies in the triangle's own interval and within t_max; where, and the
  /// determinant.
  HWY_INLINE unsigned are_in_reach(const LocalBundle& bundle, std::uint32_t i, const Part& part,
                                   BoxVec& moved, BoxVec& determinant) const {
    const BoxTag d;
    const auto sz = hn::Set(d, bundle.shear.sz[i]), o_z = hn::Set(d, bundle.shear.o[2][i]);
    const float* depth = coordinate(bundle.shear.z[i]);
    const std::size_t first = part.first;
    determinant = hn::Add(hn::Add(part.u, part.v), part.w);
    const auto of_a = hn::Mul(part.u, hn::Mul(sz, hn::Sub(corner(depth, 0, first), o_z)));
    const auto of_b = hn::Mul(part.v, hn::Mul(sz, hn::Sub(corner(depth, 1, first), o_z)));
    const auto of_c = hn::Mul(part.w, hn::Mul(sz, hn::Sub(corner(depth, 2, first), o_z)));
    const auto t = hn::Div(hn::Add(hn::Add(of_a, of_b), of_c), determinant);
    auto good =
        hn::And(hn::Ne(determinant, hn::Zero(d)), hn::Le(hn::Abs(t), hn::Set(d, kFloatMax)));

    BoxVec lo[3], hi[3];
    auto largest = hn::Zero(d);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* of = coordinate(static_cast<std::int32_t>(axis));
      const auto a = corner(of, 0, first), b = corner(of, 1, first), c = corner(of, 2, first);
      lo[axis] = hn::Min(hn::Min(a, b), c);
      hi[axis] = hn::Max(hn::Max(a, b), c);
      largest = hn::Max(largest, hn::Max(hn::Abs(lo[axis]), hn::Abs(hi[axis])));
    }
    const auto padding = hn::Mul(largest, hn::Set(d, kPadding));
    auto begin = hn::Set(d, bundle.slab.begin[i]);
    auto minus_end = hn::Set(d, bundle.slab.minus_end[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto inverse = hn::Set(d, bundle.slab.inverse[axis][i]);
      const auto lower =
          hn::Add(hn::Sub(lo[axis], padding), hn::Set(d, bundle.slab.minus_from_lower[axis][i]));
      const auto minus_upper =
          hn::Sub(hn::Set(d, bundle.slab.from_upper[axis][i]), hn::Add(hi[axis], padding));
      const bool backward = bundle.slab.side[axis][i] != 0;
      begin = hn::Max(begin, hn::Mul(backward ? minus_upper : lower, inverse));
      minus_end = hn::Max(minus_end, hn::Mul(backward ? lower : minus_upper, inverse));
    }
    const auto end = hn::Neg(minus_end);
    good = hn::And(good, hn::Le(begin, end));
    moved = hn::Max(begin, hn::Min(t, end));
    good = hn::And(good, hn::And(hn::Gt(moved, hn::Set(d, bundle.rays.t_min[i])),
                                 hn::Lt(moved, hn::Set(d, bundle.rays.t_max[i]))));
    return bits_of(good);
  }

  /// Triangles of `part` that have an edge function of zero: intersect_triangle itself decides.
  /// visit(hit, triangle) returns true to stop.
  template <class Visit>
  HWY_INLINE bool each_doubtful(const LocalBundle& bundle, std::uint32_t i, const Part& part,
                                const Visit& visit) const {
    const LocalRay local = bundle.ray(i);
    unsigned doubtful = (part.inside & ~part.sure) << part.first;
    for (; doubtful != 0; doubtful &= doubtful - 1) {
      const auto k = static_cast<std::uint32_t>(__builtin_ctz(doubtful));
      TriangleHit hit;
      if (intersect_triangle(local.shear, local.slab, local.range, local.t_min, local.t_max,
                             cluster_.position(k, 0), cluster_.position(k, 1),
                             cluster_.position(k, 2), &hit) &&
          visit(hit, k)) {
        return true;
      }
    }
    return false;
  }

  HWY_NOINLINE bool is_hit(const LocalBundle& bundle, std::uint32_t i, const Part& part) const {
    return each_doubtful(bundle, i, part, [](const TriangleHit&, std::uint32_t) { return true; });
  }

  template <class Visit>
  HWY_NOINLINE void each_doubtful_hit(const LocalBundle& bundle, std::uint32_t i, const Part& part,
                                      std::uint32_t instance, const Visit& visit) const {
    each_doubtful(bundle, i, part, [&](const TriangleHit& hit, std::uint32_t k) {
      visit(Hit{hit.t, hit.u, hit.v, instance, cluster_.primitive(k)});
      return false;
    });
  }

  const ClusterView cluster_;
  const unsigned used_;
  const std::uint32_t vertex_count_;
  const float* const coordinates_;
  HWY_ALIGN std::int32_t corner_[3][kClusterTriangles];
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
