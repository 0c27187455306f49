// One wide node and many rays. Included once per instruction set by traverse_simd.cpp, without a
// guard.
//
// The eight boxes stand in lanes, and the rays take turns. Decoding the boxes is done once for all
// rays; what is left for each is three sums, products and maxima on either side, the very
// operations of slab_interval.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using MaskTag = hn::RebindToUnsigned<BoxTag>;

/// Rays waiting to visit a child: bit i for ray i.
struct Waiting {
  static constexpr std::uint32_t kLeaf = 0x80000000u;  ///< bit of a child that is a leaf

  HWY_INLINE void push(std::uint32_t of, std::uint32_t rays_of) {
    child[size] = of;
    rays[size++] = rays_of;
  }
  std::uint32_t size = 0;
  std::uint32_t child[2 * kStackSize + kWidth];  // two are visited at a time
  std::uint32_t rays[2 * kStackSize + kWidth];
};

/// Rays as a node's boxes meet them: where they come from, as what is to be added to the side that
/// each meets first and to the other one (−from_lower to a lower side, from_upper to the negative
/// of an upper one).
struct WalkingRays {
  const BundleSlab& slab;
#if HWY_TARGET == HWY_AVX3
  HWY_ALIGN float range[kBundle][2 * kWidth];  ///< eight times begin, eight times minus_end
  HWY_ALIGN float from[kBundle][3][2 * kWidth];

  HWY_INLINE WalkingRays(const BundleSlab& of, std::uint32_t rays) : slab(of) {
    const hn::FixedTag<float, 2 * kWidth> d;
    const auto is_first = hn::FirstN(d, kWidth);
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      hn::Store(hn::IfThenElse(is_first, hn::Set(d, slab.begin[i]), hn::Set(d, slab.minus_end[i])),
                d, range[i]);
      for (int axis = 0; axis < 3; ++axis) {
        const bool backward = slab.side[axis][i] != 0;
        const float lower = -slab.from_lower[axis][i], upper = slab.from_upper[axis][i];
        const auto first = hn::Set(d, backward ? upper : lower);
        hn::Store(hn::IfThenElse(is_first, first, hn::Set(d, backward ? lower : upper)), d,
                  from[i][axis]);
      }
    }
  }
#else
  HWY_ALIGN float from[3][2][kBundle];

  HWY_INLINE WalkingRays(const BundleSlab& of, std::uint32_t rays) : slab(of) {
    const RayTag d;
    const RayIndexTag di;
    for (std::uint32_t i = 0; i < kBundle && (rays >> i) != 0; i += kRayLanes) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto backward =
            hn::RebindMask(d, hn::Gt(hn::Load(di, slab.side[axis] + i), hn::Zero(di)));
        const RayVec lower = hn::Neg(hn::Load(d, slab.from_lower[axis] + i));
        const RayVec upper = hn::Load(d, slab.from_upper[axis] + i);
        hn::Store(hn::IfThenElse(backward, upper, lower), d, from[axis][0] + i);
        hn::Store(hn::IfThenElse(backward, lower, upper), d, from[axis][1] + i);
      }
    }
  }
#endif
};

#if HWY_TARGET == HWY_AVX3
/// Eight boxes with both sides in one vector: [lower, −upper] and [−upper, lower].
struct NodePlanes {
  using Tag = hn::FixedTag<float, 2 * kWidth>;
  HWY_ALIGN float row[3][2][2 * kWidth];

  HWY_INLINE explicit NodePlanes(const WideNode& node) {
    const Tag d;
    const hn::Rebind<std::int32_t, Tag> di;
    const hn::Rebind<std::uint8_t, Tag> d8;
    const auto sign = hn::IfThenElseZero(hn::Not(hn::FirstN(d, kWidth)), hn::Set(d, -0.0f));
    for (int axis = 0; axis < 3; ++axis) {
      const auto q = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, node.q[axis][0])));
      const auto plane = hn::MulAdd(q, hn::Set(d, node.step(axis)), hn::Set(d, node.origin[axis]));
      const auto both = hn::Xor(plane, sign);
      hn::Store(both, d, row[axis][0]);
      hn::Store(hn::ConcatLowerUpper(d, both, both), d, row[axis][1]);
    }
  }

  /// Adds the bit of `ray` to children that it meets.
  HWY_INLINE void meet(const WalkingRays& rays, std::uint32_t ray, hn::Vec<MaskTag>* met) const {
    const Tag d;
    const BoxTag half;
    const MaskTag dm;
    auto both = hn::Load(d, rays.range[ray]);
    for (int axis = 0; axis < 3; ++axis) {
      const auto plane = hn::Load(d, row[axis][rays.slab.side[axis][ray]]);
      const auto distance = hn::Add(plane, hn::Load(d, rays.from[ray][axis]));
      both = hn::Max(both, hn::Mul(distance, hn::Set(d, rays.slab.inverse[axis][ray])));
    }
    const auto meets = hn::Le(hn::LowerHalf(half, both), hn::Neg(hn::UpperHalf(half, both)));
    met[0] =
        hn::IfThenElse(hn::RebindMask(dm, meets), hn::Or(met[0], hn::Set(dm, 1u << ray)), met[0]);
  }
};
#else
/// Lower sides of eight boxes and negative upper sides.
struct NodePlanes {
  HWY_ALIGN float row[3][2][kWidth];

  HWY_INLINE explicit NodePlanes(const WideNode& node) {
    const BoxTag d;
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t part = 0; part < kWidth; part += hn::MaxLanes(d)) {
        hn::Store(planes(node, axis, 0, part), d, row[axis][0] + part);
        hn::Store(hn::Neg(planes(node, axis, 1, part)), d, row[axis][1] + part);
      }
    }
  }

  /// Adds the bit of `ray` to children that it meets.
  HWY_INLINE void meet(const WalkingRays& rays, std::uint32_t ray, hn::Vec<MaskTag>* met) const {
    const BoxTag d;
    const MaskTag dm;
    constexpr std::size_t kLanes = hn::MaxLanes(d);
    const auto inverse_x = hn::Set(d, rays.slab.inverse[0][ray]);
    const auto inverse_y = hn::Set(d, rays.slab.inverse[1][ray]);
    const auto inverse_z = hn::Set(d, rays.slab.inverse[2][ray]);
    const std::int32_t x = rays.slab.side[0][ray], y = rays.slab.side[1][ray],
                       z = rays.slab.side[2][ray];
    const auto bit = hn::Set(dm, 1u << ray);
    for (std::size_t part = 0; part < kWidth; part += kLanes) {
      const auto farther = [&](const auto& t, int axis, std::int32_t side, int which,
                               const auto& inverse) HWY_ATTR {
        const auto plane = hn::Load(d, row[axis][side] + part);
        const auto distance = hn::Add(plane, hn::Set(d, rays.from[axis][which][ray]));
        return hn::Max(t, hn::Mul(distance, inverse));
      };
      auto enter = hn::Set(d, rays.slab.begin[ray]);
      auto minus_leave = hn::Set(d, rays.slab.minus_end[ray]);
      enter = farther(enter, 0, x, 0, inverse_x);
      minus_leave = farther(minus_leave, 0, 1 - x, 1, inverse_x);
      enter = farther(enter, 1, y, 0, inverse_y);
      minus_leave = farther(minus_leave, 1, 1 - y, 1, inverse_y);
      enter = farther(enter, 2, z, 0, inverse_z);
      minus_leave = farther(minus_leave, 2, 1 - z, 1, inverse_z);
      const auto meets = hn::RebindMask(dm, hn::Le(enter, hn::Neg(minus_leave)));
      met[part / kLanes] = hn::Or(met[part / kLanes], hn::IfThenElseZero(meets, bit));
    }
  }
};
#endif

/// Moves the lanes whose bit is set to the front. (Highway's Compress copies its table to the stack
/// at every call when GCC 12 compiles it, where there is no instruction for it.)
HWY_INLINE hn::Vec<MaskTag> pack(const hn::Vec<MaskTag>& v, unsigned bits) {
  const MaskTag dm;
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_SCALAR
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits)};
  return hn::Compress(v, hn::LoadMaskBits(dm, bytes));
#else
  const hn::Rebind<std::uint8_t, MaskTag> d8;
  const auto index = hn::PromoteTo(dm, hn::LoadU(d8, kPackTable[bits].data()));
  if constexpr (hn::MaxLanes(dm) == kWidth) {
    return hn::TableLookupLanes(v, hn::IndicesFromVec(dm, index));
  } else {
    const auto bytes = hn::Mul(index, hn::Set(dm, 0x04040404u));
    return hn::TableLookupBytes(v, hn::Add(bytes, hn::Set(dm, 0x03020100u)));
  }
#endif
}

/// Sends `rays` through a node: every child that one of them meets is pushed, leaves on top.
HWY_INLINE void visit_node(const WideNode& node, const WalkingRays& walking, std::uint32_t rays,
                           Waiting& waiting) {
  const MaskTag dm;
  const hn::Rebind<std::uint8_t, MaskTag> d8;
  constexpr std::size_t kLanes = hn::MaxLanes(dm);
  hn::Vec<MaskTag> met[kWidth / kLanes];
  for (auto& m : met) m = hn::Zero(dm);
  const NodePlanes planes_of(node);
  for (; rays != 0; rays &= rays - 1) {
    planes_of.meet(walking, static_cast<std::uint32_t>(__builtin_ctz(rays)), met);
  }
  for (std::size_t part = 0; part < kWidth; part += kLanes) {
    const auto index = hn::Iota(dm, static_cast<std::uint32_t>(part));
    const auto inner = hn::Add(index, hn::Set(dm, node.first_child));
    const auto leaf = hn::Add(hn::PromoteTo(dm, hn::LoadU(d8, node.leaf + part)),
                              hn::Set(dm, node.first_leaf | Waiting::kLeaf));
    const auto is_inner = hn::Lt(index, hn::Set(dm, std::uint32_t(node.inner_count())));
    const auto is_used = hn::Lt(index, hn::Set(dm, std::uint32_t(node.child_count())));
    const auto& to_push = met[part / kLanes];
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(dm, hn::And(hn::Ne(to_push, hn::Zero(dm)), is_used), bytes);
    const unsigned some = bytes[0];
    hn::StoreU(pack(hn::IfThenElse(is_inner, inner, leaf), some), dm, waiting.child + waiting.size);
    hn::StoreU(pack(to_push, some), dm, waiting.rays + waiting.size);
    waiting.size += static_cast<std::uint32_t>(__builtin_popcount(some));
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
