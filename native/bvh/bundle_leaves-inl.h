// One cluster of triangles and many rays of one point. Included once per instruction set by
// traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays of one point in one instance.
struct LocalBundle {
  Vec3 origin;
  Directions rays;
  BundleSlab slab;
  BundleShear shear;
  std::uint32_t self;  ///< primitive of the instance that is never hit, or kNone

  /// Ray i as the triangle test takes it.
  LocalRay ray(std::uint32_t i) const {
    LocalRay local;
    const Vec3 direction(rays.d[0][i], rays.d[1][i], rays.d[2][i]);
    for (int axis = 0; axis < 3; ++axis) {
      const bool backward = slab.side[axis][i] != 0;
      local.slab.near_origin[axis] = backward ? slab.from_upper[axis] : slab.from_lower[axis];
      local.slab.far_origin[axis] = backward ? slab.from_lower[axis] : slab.from_upper[axis];
      local.slab.inverse[axis] = backward ? -slab.inverse[axis][i] : slab.inverse[axis][i];
    }
    local.shear = make_shear_ray(origin, direction);
    local.range = Interval{slab.begin[i], -slab.minus_end[i]};
    local.t_min = 0.0f;
    local.t_max = rays.t_max[i];
    return local;
  }
};

/// A cluster as rays of one point meet it: vertices minus the origin, and the corners' indices.
class ClusterOfPoint {
 public:
  HWY_INLINE ClusterOfPoint(const ClusterView& cluster, const LocalBundle& bundle)
      : cluster_(cluster), used_((1u << cluster.triangle_count()) - 1) {
    const BoxTag d;
    const IndexTag di;
    const std::size_t n = cluster.vertex_count();
    const auto* coordinates = reinterpret_cast<const float*>(cluster.coordinates());
    const auto* corners = reinterpret_cast<const std::uint16_t*>(cluster.corners());
    const auto* primitives = reinterpret_cast<const std::int32_t*>(coordinates + 3 * n);
    const auto self = hn::Set(di, static_cast<std::int32_t>(bundle.self));
    for (std::size_t part = 0; part < kClusterVertices; part += kLanes) {
      for (std::size_t axis = 0; axis < 3; ++axis) {  // behind the last vertex is nothing of use
        const auto x = hn::LoadU(d, coordinates + axis * n + part);
        hn::Store(hn::Sub(x, hn::Set(d, bundle.origin[static_cast<int>(axis)])), d,
                  vertex_ + axis * kClusterVertices + part);
      }
      const auto packed = hn::PromoteTo(di, hn::LoadU(CornerTag(), corners + part));
      set_corner(0, part, packed);
      set_corner(1, part, hn::ShiftRight<3>(packed));
      set_corner(2, part, hn::ShiftRight<6>(packed));
      used_ &=
          ~(bits_of(hn::RebindMask(d, hn::Eq(hn::LoadU(di, primitives + part), self))) << part);
    }
  }

  /// Whether one of the triangles is hit by ray i: intersect_triangle, eight at a time.
  HWY_INLINE bool blocks(const LocalBundle& bundle, std::uint32_t i) const {
    const BundleShear& shear = bundle.shear;
    const BoxTag d;
    HWY_ALIGN float x[kClusterVertices], y[kClusterVertices];
    for (std::size_t part = 0; part < kClusterVertices; part += kLanes) {
      const auto z = hn::Load(d, vertex_ + shear.z[i] + part);
      hn::Store(
          hn::Sub(hn::Load(d, vertex_ + shear.x[i] + part), hn::Mul(hn::Set(d, shear.sx[i]), z)), d,
          x + part);
      hn::Store(
          hn::Sub(hn::Load(d, vertex_ + shear.y[i] + part), hn::Mul(hn::Set(d, shear.sy[i]), z)), d,
          y + part);
    }
    for (std::size_t part = 0; part < kClusterTriangles; part += kLanes) {
      const auto a_x = corner(x, 0, part), a_y = corner(y, 0, part);
      const auto b_x = corner(x, 1, part), b_y = corner(y, 1, part);
      const auto c_x = corner(x, 2, part), c_y = corner(y, 2, part);
      const auto u = hn::Sub(hn::Mul(c_x, b_y), hn::Mul(c_y, b_x));
      const auto v = hn::Sub(hn::Mul(a_x, c_y), hn::Mul(a_y, c_x));
      const auto w = hn::Sub(hn::Mul(b_x, a_y), hn::Mul(b_y, a_x));
      const auto least = hn::Min(hn::Min(u, v), w), most = hn::Max(hn::Max(u, v), w);
      const auto zero = hn::Zero(d);
      const unsigned inside =
          bits_of(hn::Or(hn::Ge(least, zero), hn::Le(most, zero))) & (used_ >> part);
      if (inside == 0) continue;
      const auto exact = hn::And(hn::And(hn::Ne(u, zero), hn::Ne(v, zero)), hn::Ne(w, zero));
      const unsigned sure = inside & bits_of(exact);
      if ((sure & are_in_reach(bundle, i, u, v, w, part)) != 0) return true;
      if (inside != sure && is_hit(bundle, i, (inside & ~sure) << part)) return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kLanes = hn::MaxLanes(BoxTag());

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

  /// The second half of intersect_triangle, for triangles of which the edge functions are known
  /// and none is zero: whether the hit lies in the triangle's own interval and within t_max.
  HWY_INLINE unsigned are_in_reach(const LocalBundle& bundle, std::uint32_t i, const BoxVec& u,
                                   const BoxVec& v, const BoxVec& w, std::size_t part) const {
    const BoxTag d;
    const auto sz = hn::Set(d, bundle.shear.sz[i]);
    const float* depth = vertex_ + bundle.shear.z[i];
    const auto determinant = hn::Add(hn::Add(u, v), w);
    const auto of_a = hn::Mul(u, hn::Mul(sz, corner(depth, 0, part)));
    const auto of_b = hn::Mul(v, hn::Mul(sz, corner(depth, 1, part)));
    const auto of_c = hn::Mul(w, hn::Mul(sz, corner(depth, 2, part)));
    const auto t = hn::Div(hn::Add(hn::Add(of_a, of_b), of_c), determinant);
    auto good =
        hn::And(hn::Ne(determinant, hn::Zero(d)), hn::Le(hn::Abs(t), hn::Set(d, kFloatMax)));

    const auto* coordinates = reinterpret_cast<const float*>(cluster_.coordinates());
    BoxVec lo[3], hi[3];
    auto largest = hn::Zero(d);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* coordinate = coordinates + axis * cluster_.vertex_count();
      const auto a = corner(coordinate, 0, part), b = corner(coordinate, 1, part),
                 c = corner(coordinate, 2, part);
      lo[axis] = hn::Min(hn::Min(a, b), c);
      hi[axis] = hn::Max(hn::Max(a, b), c);
      largest = hn::Max(largest, hn::Max(hn::Abs(lo[axis]), hn::Abs(hi[axis])));
    }
    const auto padding = hn::Mul(largest, hn::Set(d, kPadding));
    auto begin = hn::Set(d, bundle.slab.begin[i]);
    auto minus_end = hn::Set(d, bundle.slab.minus_end[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto inverse = hn::Set(d, bundle.slab.inverse[axis][i]);
      const auto lower = hn::Sub(hn::Sub(lo[axis], padding),
                                 hn::Set(d, bundle.slab.from_lower[static_cast<int>(axis)]));
      const auto minus_upper = hn::Sub(hn::Set(d, bundle.slab.from_upper[static_cast<int>(axis)]),
                                       hn::Add(hi[axis], padding));
      const bool backward = bundle.slab.side[axis][i] != 0;
      begin = hn::Max(begin, hn::Mul(backward ? minus_upper : lower, inverse));
      minus_end = hn::Max(minus_end, hn::Mul(backward ? lower : minus_upper, inverse));
    }
    const auto end = hn::Neg(minus_end);
    good = hn::And(good, hn::Le(begin, end));
    const auto moved = hn::Max(begin, hn::Min(t, end));
    good = hn::And(
        good, hn::And(hn::Gt(moved, hn::Zero(d)), hn::Lt(moved, hn::Set(d, bundle.rays.t_max[i]))));
    return bits_of(good);
  }

  /// Whether one of `candidates` is hit, decided by intersect_triangle itself.
  HWY_NOINLINE bool is_hit(const LocalBundle& bundle, std::uint32_t i, unsigned candidates) const {
    const LocalRay local = bundle.ray(i);
    for (; candidates != 0; candidates &= candidates - 1) {
      const auto k = static_cast<std::uint32_t>(__builtin_ctz(candidates));
      TriangleHit hit;
      if (intersect_triangle(local.shear, local.slab, local.range, local.t_min, local.t_max,
                             cluster_.position(k, 0), cluster_.position(k, 1),
                             cluster_.position(k, 2), &hit)) {
        return true;
      }
    }
    return false;
  }

  const ClusterView& cluster_;
  unsigned used_;
  HWY_ALIGN float vertex_[3 * kClusterVertices];
  HWY_ALIGN std::int32_t corner_[3][kClusterTriangles];
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
