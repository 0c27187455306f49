// One cluster of triangles and many rays, which stand in lanes. Included once per instruction set
// by traverse_simd.cpp, without a guard.
//
// Of a cluster's eight lanes half are empty, and each ray must move all vertices into its frame. So
// from a handful of rays on it is cheaper to let the triangles take turns: the operations of
// intersect_triangle, for kRayLanes rays at once.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR  // which has no vectors at all

inline constexpr int kManyInLeaf = 8;  ///< rays that are better in lanes themselves

/// A cluster whose triangles take turns, with its vertices put together.
class ClusterInTurns {
 public:
  HWY_INLINE explicit ClusterInTurns(const std::byte* record) : cluster_(record) {
    const hn::FixedTag<float, 4> d;
    const auto* coordinates = reinterpret_cast<const float*>(cluster_.coordinates());
    const std::uint32_t count = cluster_.vertex_count();
    for (std::uint32_t v = 0; v < count; v += 4) {
      const auto x = hn::LoadU(d, coordinates + v), y = hn::LoadU(d, coordinates + count + v),
                 z = hn::LoadU(d, coordinates + 2 * count + v);
      hn::StoreInterleaved4(x, y, z, hn::Zero(d), d, vertex_[v]);
    }
  }

  /// Those of `rays`, all of one octant, that hit one of the triangles.
  HWY_INLINE std::uint32_t blocks(const LocalBundle& bundle, std::uint32_t rays) const {
    bool backward[3];
    for (int axis = 0; axis < 3; ++axis) {
      backward[axis] = (bundle.slab.backward[axis] & rays) != 0;
    }
    std::uint32_t found = 0;
    for (std::uint32_t i = 0; i < kBundle && (rays >> i) != 0; i += kRayLanes) {
      const std::uint32_t here = (rays >> i) & kAllLanes;
      if (here != 0) found |= blocks(bundle, backward, i, here) << i;
    }
    return found;
  }

 private:
  static constexpr std::uint32_t kAllLanes = (1u << kRayLanes) - 1;

  /// Rays i…i + kRayLanes − 1 of a bundle in the frame of ShearRay, and vertices in it.
  struct Frame {
    HWY_INLINE Frame(const BundleShear& shear, std::uint32_t i) {
      const RayTag d;
      sx = hn::Load(d, shear.sx + i);
      sy = hn::Load(d, shear.sy + i);
      for (int k = 0; k < 3; ++k) o[k] = hn::Load(d, shear.o[k] + i);
      const std::int32_t* const axes[3] = {shear.x, shear.y, shear.z};
      for (int k = 0; k < 3; ++k) {
        const RayIndexTag di;
        const auto axis = hn::Load(di, axes[k] + i);
        place[k] =  // the four bytes of the float
            hn::Add(hn::Mul(axis, hn::Set(di, 0x04040404)), hn::Set(di, 0x03020100));
      }
    }

    /// A vertex's coordinate along axis k of each ray's frame, from (x, y, z, 0).
    HWY_INLINE RayVec along(const float* vertex, int k) const {
      const RayTag d;
      const hn::Repartition<std::uint8_t, RayTag> d8;
      const auto table = hn::BitCast(d8, hn::LoadDup128(d, vertex));
      const RayVec coordinate =
          hn::BitCast(d, hn::TableLookupBytes(table, hn::BitCast(d8, place[k])));
      return hn::Sub(coordinate, o[k]);
    }

    RayVec sx, sy, o[3];
    hn::Vec<RayIndexTag> place[3];
  };

  /// A triangle's corners and edge functions.
  struct Edges {
    HWY_INLINE Edges(const ClusterView& cluster, std::uint32_t k, const RayVec* x, const RayVec* y)
        : a(cluster.vertex(k, 0)), b(cluster.vertex(k, 1)), c(cluster.vertex(k, 2)) {
      u = hn::Sub(hn::Mul(x[c], y[b]), hn::Mul(y[c], x[b]));
      v = hn::Sub(hn::Mul(x[a], y[c]), hn::Mul(y[a], x[c]));
      w = hn::Sub(hn::Mul(x[b], y[a]), hn::Mul(y[b], x[a]));
    }

    /// Lanes that may be hits, and those of which no edge function is zero.
    HWY_INLINE std::uint32_t inside() const {
      const RayVec zero = hn::Zero(RayTag());
      const RayVec least = hn::Min(hn::Min(u, v), w), most = hn::Max(hn::Max(u, v), w);
      return lane_bits(hn::Or(hn::Ge(least, zero), hn::Le(most, zero)), 0);
    }
    HWY_INLINE std::uint32_t sure() const {
      const RayVec zero = hn::Zero(RayTag());
      return lane_bits(hn::And(hn::And(hn::Ne(u, zero), hn::Ne(v, zero)), hn::Ne(w, zero)), 0);
    }

    std::uint32_t a, b, c;
    RayVec u, v, w;
  };

  HWY_INLINE std::uint32_t blocks(const LocalBundle& bundle, const bool* backward, std::uint32_t i,
                                  std::uint32_t rays) const {
    const RayTag d;
    const RayIndexTag di;
    RayVec x[kClusterVertices], y[kClusterVertices], z[kClusterVertices];
    const Frame frame(bundle.shear, i);
    for (std::uint32_t v = 0; v < cluster_.vertex_count(); ++v) {
      z[v] = frame.along(vertex_[v], 2);
      x[v] = hn::Sub(frame.along(vertex_[v], 0), hn::Mul(frame.sx, z[v]));
      y[v] = hn::Sub(frame.along(vertex_[v], 1), hn::Mul(frame.sy, z[v]));
    }
    // First which triangles any ray may hit, most often none.
    std::uint32_t inside[kClusterTriangles], some = 0;
    for (std::uint32_t k = 0; k < cluster_.triangle_count(); ++k) {
      const Edges edges(cluster_, k, x, y);
      inside[k] = rays & edges.inside();
      some |= (inside[k] != 0 ? 1u : 0u) << k;
    }
    const auto self = hn::Load(di, bundle.self + i);
    std::uint32_t open = rays;
    for (; some != 0 && open != 0; some &= some - 1) {
      const auto k = static_cast<std::uint32_t>(__builtin_ctz(some));
      const Edges edges(cluster_, k, x, y);
      const auto primitive = hn::Set(di, static_cast<std::int32_t>(cluster_.primitive(k)));
      const std::uint32_t other =
          open & inside[k] & ~lane_bits(hn::RebindMask(d, hn::Eq(self, primitive)), 0);
      const std::uint32_t sure = other & edges.sure();
      if (sure != 0) {
        const RayVec sz = hn::Load(d, bundle.shear.sz + i);
        const RayVec determinant = hn::Add(hn::Add(edges.u, edges.v), edges.w);
        const RayVec height = hn::Add(hn::Add(hn::Mul(edges.u, hn::Mul(sz, z[edges.a])),
                                              hn::Mul(edges.v, hn::Mul(sz, z[edges.b]))),
                                      hn::Mul(edges.w, hn::Mul(sz, z[edges.c])));
        open &= ~(sure & are_in_reach(bundle, backward, i, edges, height, determinant));
      }
      if (other != sure) open &= ~are_hit(bundle, i, k, other & ~sure);
    }
    return rays & ~open;
  }

  /// The rest of intersect_triangle where no edge function is zero.
  HWY_INLINE std::uint32_t are_in_reach(const LocalBundle& bundle, const bool* backward,
                                        std::uint32_t i, const Edges& corners, const RayVec& height,
                                        const RayVec& determinant) const {
    const RayTag d;
    const hn::FixedTag<float, 4> d4;
    const auto a = hn::Load(d4, vertex_[corners.a]), b = hn::Load(d4, vertex_[corners.b]),
               c = hn::Load(d4, vertex_[corners.c]);
    const auto lo = hn::Min(hn::Min(a, b), c), hi = hn::Max(hn::Max(a, b), c);
    const auto padding =
        hn::Mul(hn::MaxOfLanes(d4, hn::Max(hn::Abs(lo), hn::Abs(hi))), hn::Set(d4, kPadding));
    HWY_ALIGN float lower[4], minus_upper[4];
    hn::Store(hn::Sub(lo, padding), d4, lower);
    hn::Store(hn::Neg(hn::Add(hi, padding)), d4, minus_upper);
    RayVec begin = hn::Load(d, bundle.slab.begin + i);
    RayVec minus_end = hn::Load(d, bundle.slab.minus_end + i);
    for (int axis = 0; axis < 3; ++axis) {
      const RayVec inverse = hn::Load(d, bundle.slab.inverse[axis] + i);
      const RayVec at_lower = hn::Mul(
          hn::Add(hn::Set(d, lower[axis]), hn::Load(d, bundle.slab.minus_from_lower[axis] + i)),
          inverse);
      const RayVec minus_at_upper = hn::Mul(
          hn::Add(hn::Set(d, minus_upper[axis]), hn::Load(d, bundle.slab.from_upper[axis] + i)),
          inverse);
      begin = hn::Max(begin, backward[axis] ? minus_at_upper : at_lower);
      minus_end = hn::Max(minus_end, backward[axis] ? at_lower : minus_at_upper);
    }
    const RayVec t = hn::Div(height, determinant), end = hn::Neg(minus_end);
    const RayVec moved = hn::Max(begin, hn::Min(t, end));
    const auto finite =
        hn::And(hn::Ne(determinant, hn::Zero(d)), hn::Le(hn::Abs(t), hn::Set(d, kFloatMax)));
    const auto within = hn::And(hn::Gt(moved, hn::Load(d, bundle.rays.t_min + i)),
                                hn::Lt(moved, hn::Load(d, bundle.rays.t_max + i)));
    return lane_bits(hn::And(hn::And(finite, hn::Le(begin, end)), within), 0);
  }

  /// Where an edge function is zero intersect_triangle itself decides.
  HWY_NOINLINE std::uint32_t are_hit(const LocalBundle& bundle, std::uint32_t i, std::uint32_t k,
                                     std::uint32_t rays) const {
    std::uint32_t found = 0;
    for (; rays != 0; rays &= rays - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(rays));
      const LocalRay local = bundle.ray(i + lane);
      TriangleHit hit;
      if (intersect_triangle(local.shear, local.slab, local.range, local.t_min, local.t_max,
                             cluster_.position(k, 0), cluster_.position(k, 1),
                             cluster_.position(k, 2), &hit)) {
        found |= 1u << lane;
      }
    }
    return found;
  }

  const ClusterView cluster_;
  HWY_ALIGN float vertex_[kClusterVertices][4];  ///< (x, y, z, 0)
};

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
