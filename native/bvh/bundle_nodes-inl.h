// One wide node and many rays of one point. Included once per instruction set by
// traverse_simd.cpp, without a guard.
//
// The eight boxes stand in lanes, and the rays take turns. Decoding the boxes and subtracting the
// origin is done once for all rays; what is left for each is three products and three maxima on
// either side, the very operations of slab_interval. (Rays in lanes, box by box, cost as much when
// sixteen are active and more for any fewer.)

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
  std::uint32_t child[kStackSize + kWidth];
  std::uint32_t rays[kStackSize + kWidth];
};

#if HWY_TARGET == HWY_AVX3
/// Both sides of eight boxes in one vector: [lower, −upper] and [−upper, lower], minus the origin.
struct NodePlanes {
  using Tag = hn::FixedTag<float, 2 * kWidth>;
  HWY_ALIGN float row[3][2][2 * kWidth];

  HWY_INLINE NodePlanes(const WideNode& node, const BundleSlab& slab) {
    const Tag d;
    const hn::Rebind<std::int32_t, Tag> di;
    const hn::Rebind<std::uint8_t, Tag> d8;
    const auto is_lower = hn::FirstN(d, kWidth);
    for (int axis = 0; axis < 3; ++axis) {
      const auto q = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, node.q[axis][0])));
      const auto plane = hn::MulAdd(q, hn::Set(d, node.step(axis)), hn::Set(d, node.origin[axis]));
      const auto lower = hn::Sub(plane, hn::Set(d, slab.from_lower[axis]));
      const auto upper = hn::Sub(hn::Set(d, slab.from_upper[axis]), plane);
      const auto both = hn::IfThenElse(is_lower, lower, upper);
      hn::Store(both, d, row[axis][0]);
      hn::Store(hn::ConcatLowerUpper(d, both, both), d, row[axis][1]);
    }
  }

  /// Adds the bit of `ray` to children that it meets.
  HWY_INLINE void meet(const BundleSlab& slab, std::uint32_t ray, hn::Vec<MaskTag>* rays) const {
    const Tag d;
    const BoxTag half;
    const MaskTag dm;
    auto both = hn::IfThenElse(hn::FirstN(d, kWidth), hn::Set(d, slab.begin[ray]),
                               hn::Set(d, slab.minus_end[ray]));
    for (int axis = 0; axis < 3; ++axis) {
      both = hn::Max(both, hn::Mul(hn::Load(d, row[axis][slab.side[axis][ray]]),
                                   hn::Set(d, slab.inverse[axis][ray])));
    }
    const auto meets = hn::Le(hn::LowerHalf(half, both), hn::Neg(hn::UpperHalf(half, both)));
    rays[0] =
        hn::IfThenElse(hn::RebindMask(dm, meets), hn::Or(rays[0], hn::Set(dm, 1u << ray)), rays[0]);
  }
};
#else
/// Lower sides of eight boxes and negative upper sides, minus the origin.
struct NodePlanes {
  HWY_ALIGN float row[3][2][kWidth];

  HWY_INLINE NodePlanes(const WideNode& node, const BundleSlab& slab) {
    const BoxTag d;
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t part = 0; part < kWidth; part += hn::MaxLanes(d)) {
        const auto lower = planes(node, axis, 0, part), upper = planes(node, axis, 1, part);
        hn::Store(hn::Sub(lower, hn::Set(d, slab.from_lower[axis])), d, row[axis][0] + part);
        hn::Store(hn::Sub(hn::Set(d, slab.from_upper[axis]), upper), d, row[axis][1] + part);
      }
    }
  }

  /// Adds the bit of `ray` to children that it meets.
  HWY_INLINE void meet(const BundleSlab& slab, std::uint32_t ray, hn::Vec<MaskTag>* rays) const {
    const BoxTag d;
    const MaskTag dm;
    constexpr std::size_t kLanes = hn::MaxLanes(d);
    const auto inverse_x = hn::Set(d, slab.inverse[0][ray]);
    const auto inverse_y = hn::Set(d, slab.inverse[1][ray]);
    const auto inverse_z = hn::Set(d, slab.inverse[2][ray]);
    const std::int32_t x = slab.side[0][ray], y = slab.side[1][ray], z = slab.side[2][ray];
    const auto bit = hn::Set(dm, 1u << ray);
    for (std::size_t part = 0; part < kWidth; part += kLanes) {
      const auto farther = [&](const auto& t, int axis, std::int32_t side,
                               const auto& inverse) HWY_ATTR {
        return hn::Max(t, hn::Mul(hn::Load(d, row[axis][side] + part), inverse));
      };
      auto enter = hn::Set(d, slab.begin[ray]);
      auto minus_leave = hn::Set(d, slab.minus_end[ray]);
      enter = farther(enter, 0, x, inverse_x);
      minus_leave = farther(minus_leave, 0, 1 - x, inverse_x);
      enter = farther(enter, 1, y, inverse_y);
      minus_leave = farther(minus_leave, 1, 1 - y, inverse_y);
      enter = farther(enter, 2, z, inverse_z);
      minus_leave = farther(minus_leave, 2, 1 - z, inverse_z);
      const auto meets = hn::RebindMask(dm, hn::Le(enter, hn::Neg(minus_leave)));
      rays[part / kLanes] = hn::Or(rays[part / kLanes], hn::IfThenElseZero(meets, bit));
    }
  }
};
#endif

/// The children that one ray alone meets, without the detour through memory.
HWY_INLINE void meet_alone(const WideNode& node, const BundleSlab& slab, std::uint32_t ray,
                           hn::Vec<MaskTag>* rays) {
  const BoxTag d;
  const MaskTag dm;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const auto bit = hn::Set(dm, 1u << ray);
  for (std::size_t part = 0; part < kWidth; part += kLanes) {
    auto enter = hn::Set(d, slab.begin[ray]);
    auto leave = hn::Set(d, -slab.minus_end[ray]);
    for (int axis = 0; axis < 3; ++axis) {
      const int side = slab.side[axis][ray];
      const auto inverse = hn::Set(d, slab.signed_inverse[axis][ray]);
      const float from[2] = {slab.from_lower[axis], slab.from_upper[axis]};
      const auto t0 =
          hn::Mul(hn::Sub(planes(node, axis, side, part), hn::Set(d, from[side])), inverse);
      const auto t1 =
          hn::Mul(hn::Sub(planes(node, axis, 1 - side, part), hn::Set(d, from[1 - side])), inverse);
      enter = hn::Max(enter, t0);
      leave = hn::Min(leave, t1);
    }
    const auto meets = hn::RebindMask(dm, hn::Le(enter, leave));
    rays[part / kLanes] = hn::IfThenElseZero(meets, bit);
  }
}

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
HWY_INLINE void visit_node(const WideNode& node, const BundleSlab& slab, std::uint32_t rays,
                           Waiting& waiting) {
  const MaskTag dm;
  const hn::Rebind<std::uint8_t, MaskTag> d8;
  constexpr std::size_t kLanes = hn::MaxLanes(dm);
  hn::Vec<MaskTag> met[kWidth / kLanes];
  if ((rays & (rays - 1)) == 0) {
    meet_alone(node, slab, static_cast<std::uint32_t>(__builtin_ctz(rays)), met);
  } else {
    for (auto& m : met) m = hn::Zero(dm);
    const NodePlanes planes_of(node, slab);
    for (; rays != 0; rays &= rays - 1) {
      planes_of.meet(slab, static_cast<std::uint32_t>(__builtin_ctz(rays)), met);
    }
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
