// Which of a node's eight boxes rays meet. Included once per instruction set by traverse_simd.cpp,
// without a guard.
//
// Decoding the boxes is done once for all rays; what is left for each is three sums, products and
// maxima on either side, the very operations of slab_interval. Of few rays the eight boxes stand in
// lanes, and the rays take turns. Of many rays these stand in lanes, and those boxes take turns
// that some of the rays may meet and others may not: one of three.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using MaskTag = hn::RebindToUnsigned<BoxTag>;

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

  HWY_INLINE BoxVec get(std::uint32_t i, int column) const {
    return hn::Set(BoxTag(), column_[column][i]);
  }

  HWY_INLINE RayVec load(std::uint32_t i, int column) const {
    return hn::Load(RayTag(), column_[column] + i);
  }

  const float* column_[kColumns];
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

/// Where the boxes are that rays can meet at all: which values sides met first, and the others, do
/// not exceed on each axis.
///
/// The slab test of a ray fails where (first + side) · inverse > end, in floats; so a side beyond
/// end / inverse − first of every ray is beyond them all. The padding is far above the few
/// roundings on the way, of at most 2⁻²⁴ of the largest of these numbers each.
class Reach {
 public:
  HWY_INLINE Reach(const WalkingRays& walking, const Bundle& bundle, std::uint32_t rays) {
    const RayTag d;
    RayVec reach[6], origins[6], largest[2] = {hn::Zero(d), hn::Zero(d)};
    for (int k = 0; k < 6; ++k) reach[k] = origins[k] = hn::Set(d, -kFloatMax);
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
        farthest(origins[axis], first);
        farthest(origins[3 + axis], last);
        farthest(largest[0], hn::Max(hn::Abs(first), hn::Abs(to_end)));
        farthest(largest[1], hn::Max(hn::Abs(last), hn::Abs(to_begin)));
      }
    }
    for (int k = 0; k < 6; ++k) {
      const float padding = hn::GetLane(hn::MaxOfLanes(d, largest[k / 3])) * kPadding;
      reach_[k] = hn::GetLane(hn::MaxOfLanes(d, reach[k])) + padding;
      origins_[k] = -hn::GetLane(hn::MaxOfLanes(d, origins[k]));
    }
  }

  /// Of boxes, a bit each: those that any of the rays may meet, and those that all of them begin
  /// in.
  HWY_INLINE unsigned met_by_some(const Sides& sides) const { return within(sides, reach_); }
  HWY_INLINE unsigned met_by_all(const Sides& sides) const { return within(sides, origins_); }

 private:
  static HWY_INLINE unsigned within(const Sides& sides, const float* bounds) {
    const BoxTag d;
    unsigned bits = 0;
    for (std::size_t part = 0; part < kWidth; part += hn::MaxLanes(d)) {
      auto beyond = hn::Gt(hn::Load(d, sides.first[0] + part), hn::Set(d, bounds[0]));
      for (int k = 1; k < 6; ++k) {
        const float* side = k < 3 ? sides.first[k] : sides.last[k - 3];
        beyond = hn::Or(beyond, hn::Gt(hn::Load(d, side + part), hn::Set(d, bounds[k])));
      }
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, hn::Not(beyond), bytes);
      bits |= static_cast<unsigned>(bytes[0]) << part;
    }
    return bits;
  }

  float reach_[6], origins_[6];
};

/// For each child of a node, those of `rays` that meet its box; with kNearest also where the first
/// of them enters it, or less. For many rays: these stand in lanes, and the boxes take turns.
/// @param reach  of all the rays that walk
template <bool kNearest>
HWY_INLINE void meet_in_lanes(const WideNode& node, const Sides& sides, const WalkingRays& walking,
                              const Reach& reach, std::uint32_t rays, hn::Vec<MaskTag>* met,
                              BoxVec* begins) {
  const RayTag d;
  const BoxTag db;
  const MaskTag dm;
  HWY_ALIGN std::uint32_t met_of[kWidth] = {};
  HWY_ALIGN float begin_of[kWidth];
  const unsigned some = ((1u << node.child_count()) - 1) & reach.met_by_some(sides);
  const unsigned all = some & reach.met_by_all(sides);
  for (unsigned left = some; left != 0; left &= left - 1) {
    const auto box = static_cast<std::uint32_t>(__builtin_ctz(left));
    if ((all >> box) & 1u) {
      met_of[box] = rays;
      begin_of[box] = -kFloatMax;
      continue;
    }
    RayVec first[3], last[3];
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = hn::Set(d, sides.first[axis][box]);
      last[axis] = hn::Set(d, sides.last[axis][box]);
    }
    RayVec nearest = hn::Set(d, kFloatMax);
    for (std::uint32_t i = 0; i < kBundle && (rays >> i) != 0; i += kRayLanes) {
      RayVec enter = walking.begin_of(i), minus_leave = walking.minus_end_of(i);
      for (int axis = 0; axis < 3; ++axis) {
        const RayVec inverse = walking.inverse_of(i, axis);
        const RayVec to_first = hn::Add(first[axis], walking.first_of(i, axis));
        const RayVec to_last = hn::Add(last[axis], walking.last_of(i, axis));
        enter = hn::Max(enter, hn::Mul(to_first, inverse));
        minus_leave = hn::Max(minus_leave, hn::Mul(to_last, inverse));
      }
      const auto meets = hn::Le(enter, hn::Neg(minus_leave));
      met_of[box] |= lane_bits(meets, i);
      if constexpr (kNearest) nearest = hn::IfThenElse(meets, hn::Min(nearest, enter), nearest);
    }
    if constexpr (kNearest) begin_of[box] = hn::GetLane(hn::MinOfLanes(d, nearest));
  }
  for (std::size_t part = 0; part < kWidth; part += hn::MaxLanes(dm)) {
    met[part / hn::MaxLanes(dm)] = hn::And(hn::Load(dm, met_of + part), hn::Set(dm, rays));
    if constexpr (kNearest) begins[part / hn::MaxLanes(dm)] = hn::Load(db, begin_of + part);
  }
}

/// The same for few rays, which take turns.
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

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
