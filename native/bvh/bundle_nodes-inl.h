// One wide node and many rays. Included once per instruction set by traverse_simd.cpp, without a
// guard.
//
// Decoding the boxes is done once for all rays; what is left for each is three sums, products and
// maxima on either side, the very operations of slab_interval. Of few rays the eight boxes stand in
// lanes, and the rays take turns. Of many rays these stand in lanes, and those boxes take turns
// that are in reach of any: two of five.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using MaskTag = hn::RebindToUnsigned<BoxTag>;

inline constexpr int kMany = 16;  ///< rays that are better in lanes themselves

/// Rays waiting to visit a child: bit i for ray i.
struct Waiting {
  static constexpr std::uint32_t kLeaf = 0x80000000u;  ///< bit of a child that is a leaf

  std::uint32_t size = 0;
  std::uint32_t child[kStackSize + kWidth];
  std::uint32_t rays[kStackSize + kWidth];
  float begin[kStackSize + kWidth];  ///< for closest hits: where the first of the rays enters it
};

/// Those of `rays` that point to the same octant as the first one.
HWY_INLINE std::uint32_t same_octant(const BundleSlab& slab, std::uint32_t rays) {
  const std::uint32_t first = rays & (0u - rays);
  for (const std::uint32_t backward : slab.backward) {
    rays &= (backward & first) != 0 ? backward : ~backward;
  }
  return rays;
}

/// Rays of one octant as a node's boxes meet them: what is to be added to the side met first of a
/// box and to the other one (−from_lower to a lower side, from_upper to a negative upper one).
class WalkingRays {
 public:
  HWY_INLINE WalkingRays(const BundleSlab& slab, std::uint32_t rays)
      : WalkingRays(slab, rays, slab.minus_end) {}

  /// Rays that end at −minus_end, which stays the caller's.
  HWY_INLINE WalkingRays(const BundleSlab& slab, std::uint32_t rays, const float* minus_end) {
    for (int axis = 0; axis < 3; ++axis) {
      backward[axis] = (slab.backward[axis] & rays) != 0;
      column_[axis] = backward[axis] ? slab.from_upper[axis] : slab.minus_from_lower[axis];
      column_[3 + axis] = backward[axis] ? slab.minus_from_lower[axis] : slab.from_upper[axis];
      column_[6 + axis] = slab.inverse[axis];
    }
    column_[kBegin] = slab.begin;
    column_[kMinusEnd] = minus_end;
    if constexpr (kCopied) {
      for (; rays != 0; rays &= rays - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
        for (int k = 0; k < kColumns; ++k) {
          hn::Store(hn::Set(BoxTag(), column_[k][i]), BoxTag(), copies_[i][k]);
        }
      }
    }
  }

  /// The caller has changed ray i's minus_end.
  HWY_INLINE void update_end(std::uint32_t i) {
    if constexpr (kCopied) {
      hn::Store(hn::Set(BoxTag(), column_[kMinusEnd][i]), BoxTag(), copies_[i][kMinusEnd]);
    }
  }

  bool backward[3];

  HWY_INLINE BoxVec first(std::uint32_t i, int axis) const { return get(i, axis); }
  HWY_INLINE BoxVec last(std::uint32_t i, int axis) const { return get(i, 3 + axis); }
  HWY_INLINE BoxVec inverse(std::uint32_t i, int axis) const { return get(i, 6 + axis); }
  HWY_INLINE BoxVec begin(std::uint32_t i) const { return get(i, kBegin); }
  HWY_INLINE BoxVec minus_end(std::uint32_t i) const { return get(i, kMinusEnd); }

  /// Numbers of kRayLanes rays from i on.
  HWY_INLINE RayVec first_of(std::uint32_t i, int axis) const { return load(i, axis); }
  HWY_INLINE RayVec last_of(std::uint32_t i, int axis) const { return load(i, 3 + axis); }
  HWY_INLINE RayVec inverse_of(std::uint32_t i, int axis) const { return load(i, 6 + axis); }
  HWY_INLINE RayVec begin_of(std::uint32_t i) const { return load(i, kBegin); }
  HWY_INLINE RayVec minus_end_of(std::uint32_t i) const { return load(i, kMinusEnd); }

 private:
  static constexpr int kBegin = 9, kMinusEnd = 10, kColumns = 11;
  /// Where setting all lanes takes more than a load, each number is kept as often as needed.
  static constexpr bool kCopied = hn::MaxLanes(BoxTag()) == 4;

  HWY_INLINE BoxVec get(std::uint32_t i, int column) const {
    if constexpr (kCopied) return hn::Load(BoxTag(), copies_[i][column]);
    return hn::Set(BoxTag(), column_[column][i]);
  }

  HWY_INLINE RayVec load(std::uint32_t i, int column) const {
    return hn::Load(RayTag(), column_[column] + i);
  }

  const float* column_[kColumns];
  HWY_ALIGN float copies_[kCopied ? kBundle : 1][kColumns][kCopied ? 4 : 1];
};

/// Sides of a node's boxes as rays of one octant meet them.
struct Sides {
  HWY_ALIGN float first[3][kWidth], last[3][kWidth];  ///< lower sides, and negative upper ones

  HWY_INLINE Sides(const WideNode& node, const WalkingRays& walking) {
    const BoxTag d;
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t part = 0; part < kWidth; part += hn::MaxLanes(d)) {
        const auto lower = planes(node, axis, 0, part);
        const auto minus_upper = hn::Neg(planes(node, axis, 1, part));
        hn::Store(lower, d, (walking.backward[axis] ? last : first)[axis] + part);
        hn::Store(minus_upper, d, (walking.backward[axis] ? first : last)[axis] + part);
      }
    }
  }
};

/// Where the boxes are that rays can meet at all, on either side of each axis: what first + side
/// met first, and last + other side, must not exceed.
///
/// The slab test of a ray fails where (first + side) · inverse > end, in floats; so a side beyond
/// end / inverse − first of every ray is beyond them all. The padding is far above the few
/// roundings on the way, of at most 2⁻²⁴ of the largest of these numbers each.
class Reach {
 public:
  HWY_INLINE Reach(const WalkingRays& walking, const Bundle& bundle, std::uint32_t rays) {
    const RayTag d;
    RayVec reach[6], largest = hn::Zero(d);
    for (RayVec& of : reach) of = hn::Set(d, -kFloatMax);
    for (std::uint32_t i = 0; i < kBundle && (rays >> i) != 0; i += kRayLanes) {
      const auto used = lanes_of(rays >> i);
      const RayVec minus_begin = hn::Neg(walking.begin_of(i));
      const RayVec end = hn::Min(hn::Neg(walking.minus_end_of(i)), hn::Set(d, kFloatMax));
      for (int axis = 0; axis < 3; ++axis) {
        const RayVec first = walking.first_of(i, axis), last = walking.last_of(i, axis);
        // As slab_inverse; what that adds to tiny directions else is below the padding.
        const RayVec speed = hn::Max(hn::Abs(hn::Load(d, bundle.d[axis] + i)), hn::Set(d, 1e-37f));
        const RayVec to_end = hn::Mul(end, speed), to_begin = hn::Mul(minus_begin, speed);
        const auto farthest = [&](RayVec& of, const RayVec& value)
                                  HWY_ATTR { of = hn::IfThenElse(used, hn::Max(of, value), of); };
        farthest(reach[axis], hn::Sub(to_end, first));
        farthest(reach[3 + axis], hn::Sub(to_begin, last));
        farthest(largest, hn::Max(hn::Max(hn::Abs(first), hn::Abs(last)),
                                  hn::Max(hn::Abs(to_begin), hn::Abs(to_end))));
      }
    }
    const float padding = hn::GetLane(hn::MaxOfLanes(d, largest)) * kPadding;
    for (int k = 0; k < 6; ++k) reach_[k] = hn::GetLane(hn::MaxOfLanes(d, reach[k])) + padding;
  }

  /// Of boxes, a bit each that some ray may meet.
  HWY_INLINE unsigned boxes(const Sides& sides) const {
    const BoxTag d;
    unsigned bits = 0;
    for (std::size_t part = 0; part < kWidth; part += hn::MaxLanes(d)) {
      auto beyond = hn::Gt(hn::Load(d, sides.first[0] + part), hn::Set(d, reach_[0]));
      for (int k = 1; k < 6; ++k) {
        const float* side = k < 3 ? sides.first[k] : sides.last[k - 3];
        beyond = hn::Or(beyond, hn::Gt(hn::Load(d, side + part), hn::Set(d, reach_[k])));
      }
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, hn::Not(beyond), bytes);
      bits |= static_cast<unsigned>(bytes[0]) << part;
    }
    return bits;
  }

 private:
  float reach_[6];
};

/// `meet` for many rays: these stand in lanes, and the boxes take turns.
HWY_INLINE void meet_in_lanes(unsigned boxes, const Sides& sides, const WalkingRays& walking,
                              std::uint32_t rays, hn::Vec<MaskTag>* met) {
  const RayTag d;
  const MaskTag dm;
  HWY_ALIGN std::uint32_t met_of[kWidth] = {};
  for (std::uint32_t i = 0; i < kBundle && (rays >> i) != 0; i += kRayLanes) {
    const RayVec begin = walking.begin_of(i), minus_end = walking.minus_end_of(i);
    RayVec first[3], last[3], inverse[3];
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = walking.first_of(i, axis);
      last[axis] = walking.last_of(i, axis);
      inverse[axis] = walking.inverse_of(i, axis);
    }
    for (unsigned left = boxes; left != 0; left &= left - 1) {
      const int box = __builtin_ctz(left);
      RayVec enter = begin, minus_leave = minus_end;
      for (int axis = 0; axis < 3; ++axis) {
        const RayVec to_first = hn::Add(hn::Set(d, sides.first[axis][box]), first[axis]);
        const RayVec to_last = hn::Add(hn::Set(d, sides.last[axis][box]), last[axis]);
        enter = hn::Max(enter, hn::Mul(to_first, inverse[axis]));
        minus_leave = hn::Max(minus_leave, hn::Mul(to_last, inverse[axis]));
      }
      met_of[box] |= lane_bits(hn::Le(enter, hn::Neg(minus_leave)), i);
    }
  }
  for (std::size_t part = 0; part < kWidth; part += hn::MaxLanes(dm)) {
    met[part / hn::MaxLanes(dm)] = hn::And(hn::Load(dm, met_of + part), hn::Set(dm, rays));
  }
}

/// For each child of a node, those of `rays` that meet its box; with kNearest also where the first
/// of them enters it.
template <bool kNearest>
HWY_INLINE void meet(const Sides& sides, const WalkingRays& walking, std::uint32_t rays,
                     hn::Vec<MaskTag>* met, BoxVec* begins) {
  const BoxTag d;
  const MaskTag dm;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  for (std::size_t part = 0; part < kWidth; part += kLanes) {
    met[part / kLanes] = hn::Zero(dm);
    if constexpr (kNearest) begins[part / kLanes] = hn::Set(d, kFloatMax);
  }
  for (; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
    for (std::size_t part = 0; part < kWidth; part += kLanes) {
      auto enter = walking.begin(i), minus_leave = walking.minus_end(i);
      for (int axis = 0; axis < 3; ++axis) {
        const auto inverse = walking.inverse(i, axis);
        const auto to_first =
            hn::Add(hn::Load(d, sides.first[axis] + part), walking.first(i, axis));
        const auto to_last = hn::Add(hn::Load(d, sides.last[axis] + part), walking.last(i, axis));
        enter = hn::Max(enter, hn::Mul(to_first, inverse));
        minus_leave = hn::Max(minus_leave, hn::Mul(to_last, inverse));
      }
      const auto meets = hn::Le(enter, hn::Neg(minus_leave));
      auto& to = met[part / kLanes];
      to = hn::Or(to, hn::IfThenElseZero(hn::RebindMask(dm, meets), hn::Set(dm, 1u << i)));
      if constexpr (kNearest) {
        auto& begin = begins[part / kLanes];
        begin = hn::IfThenElse(meets, hn::Min(begin, enter), begin);
      }
    }
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

/// What was pushed from `bottom` on, the nearest to the top.
HWY_INLINE void sort_from(std::uint32_t bottom, Waiting& waiting) {
  for (std::uint32_t k = bottom + 1; k < waiting.size; ++k) {
    const float begin = waiting.begin[k];
    const std::uint32_t child = waiting.child[k], rays = waiting.rays[k];
    std::uint32_t place = k;
    for (; place > bottom && waiting.begin[place - 1] < begin; --place) {
      waiting.begin[place] = waiting.begin[place - 1];
      waiting.child[place] = waiting.child[place - 1];
      waiting.rays[place] = waiting.rays[place - 1];
    }
    waiting.begin[place] = begin;
    waiting.child[place] = child;
    waiting.rays[place] = rays;
  }
}

/// Sends `rays` through a node: every child that one of them meets is pushed, leaves on top, or
/// with kNearest that which is entered first.
/// @param reach  of all the rays that walk; null: everywhere
template <bool kNearest>
HWY_INLINE void visit_node(const WideNode& node, const WalkingRays& walking, const Reach* reach,
                           std::uint32_t rays, Waiting& waiting) {
  const MaskTag dm;
  const hn::Rebind<std::uint8_t, MaskTag> d8;
  constexpr std::size_t kLanes = hn::MaxLanes(dm);
  hn::Vec<MaskTag> met[kWidth / kLanes];
  BoxVec begins[kWidth / kLanes];
  const Sides sides(node, walking);
  if (!kNearest && __builtin_popcount(rays) >= kMany) {
    const unsigned used = (1u << node.child_count()) - 1;
    const unsigned boxes = reach == nullptr ? used : used & reach->boxes(sides);
    meet_in_lanes(boxes, sides, walking, rays, met);
  } else {
    meet<kNearest>(sides, walking, rays, met, begins);
  }
  [[maybe_unused]] const std::uint32_t bottom = waiting.size;
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
    if constexpr (kNearest) {
      const auto begin = pack(hn::BitCast(dm, begins[part / kLanes]), some);
      hn::StoreU(hn::BitCast(BoxTag(), begin), BoxTag(), waiting.begin + waiting.size);
    }
    waiting.size += static_cast<std::uint32_t>(__builtin_popcount(some));
  }
  if constexpr (kNearest) sort_from(bottom, waiting);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
