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

/// Those of `rays` that point to the same octant as the first one.
HWY_INLINE std::uint32_t same_octant(const BundleSlab& slab, std::uint32_t rays) {
  const std::uint32_t first = rays & (0u - rays);
  for (const std::uint32_t backward : slab.backward) {
    rays &= (backward & first) != 0 ? backward : ~backward;
  }
  return rays;
}

#if HWY_TARGET == HWY_AVX3
/// Rays of one octant as a node's boxes meet them. Both ends of a ray stand in one vector: eight
/// times that of the sides met first, eight times that of the others.
struct WalkingRays {
  using Tag = hn::FixedTag<float, 2 * kWidth>;
  bool backward[3];
  HWY_ALIGN float range[kBundle][2 * kWidth];    ///< begin, −end
  HWY_ALIGN float from[kBundle][3][2 * kWidth];  ///< −from_lower, from_upper, or turned round
  float inverse[kBundle][3];

  HWY_INLINE WalkingRays(const BundleSlab& slab, std::uint32_t rays) {
    const Tag d;
    const auto is_first = hn::FirstN(d, kWidth);
    for (int axis = 0; axis < 3; ++axis) backward[axis] = (slab.backward[axis] & rays) != 0;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      hn::Store(hn::IfThenElse(is_first, hn::Set(d, slab.begin[i]), hn::Set(d, slab.minus_end[i])),
                d, range[i]);
      for (int axis = 0; axis < 3; ++axis) {
        const auto lower = hn::Neg(hn::Set(d, slab.from_lower[axis][i]));
        const auto upper = hn::Set(d, slab.from_upper[axis][i]);
        hn::Store(backward[axis] ? hn::IfThenElse(is_first, upper, lower)
                                 : hn::IfThenElse(is_first, lower, upper),
                  d, from[i][axis]);
        inverse[i][axis] = slab.inverse[axis][i];
      }
    }
  }
};

/// For each child of a node, those of `rays` that meet its box.
HWY_INLINE void meet(const WideNode& node, const WalkingRays& walking, std::uint32_t rays,
                     hn::Vec<MaskTag>* met) {
  const WalkingRays::Tag d;
  const hn::Rebind<std::int32_t, WalkingRays::Tag> di;
  const hn::Rebind<std::uint8_t, WalkingRays::Tag> d8;
  const BoxTag half;
  const MaskTag dm;
  const auto sign = hn::IfThenElseZero(hn::Not(hn::FirstN(d, kWidth)), hn::Set(d, -0.0f));
  const auto sides = [&](int axis) HWY_ATTR {  // [lower, −upper], or [−upper, lower]
    const auto q = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, node.q[axis][0])));
    const auto plane = hn::MulAdd(q, hn::Set(d, node.step(axis)), hn::Set(d, node.origin[axis]));
    const auto both = hn::Xor(plane, sign);
    return walking.backward[axis] ? hn::ConcatLowerUpper(d, both, both) : both;
  };
  const auto x = sides(0), y = sides(1), z = sides(2);
  auto all = hn::Zero(dm);
  for (; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
    const auto distance = [&](const auto& plane, int axis) HWY_ATTR {
      return hn::Mul(hn::Add(plane, hn::Load(d, walking.from[i][axis])),
                     hn::Set(d, walking.inverse[i][axis]));
    };
    const auto xy = hn::Max(distance(x, 0), distance(y, 1));
    const auto both = hn::Max(hn::Max(hn::Load(d, walking.range[i]), distance(z, 2)), xy);
    const auto meets = hn::Le(hn::LowerHalf(half, both), hn::Neg(hn::UpperHalf(half, both)));
    all = hn::Or(all, hn::IfThenElseZero(hn::RebindMask(dm, meets), hn::Set(dm, 1u << i)));
  }
  met[0] = all;
}
#else
/// Rays of one octant as a node's boxes meet them.
struct WalkingRays {
  /// Where setting all lanes takes more than a load, numbers stand there as often as needed.
  static constexpr std::size_t kCopies = hn::MaxLanes(BoxTag()) == 4 ? 4 : 1;
  struct OneRay {
    HWY_ALIGN float first[3][kCopies];  ///< to be added to the sides met first, as they are below
    float last[3][kCopies];             ///< to the others
    float inverse[3][kCopies];
    float begin[kCopies], minus_end[kCopies];
  };
  bool backward[3];
  OneRay ray[kBundle];

  static HWY_INLINE void set(float* to, float x) {
    for (std::size_t k = 0; k < kCopies; ++k) to[k] = x;
  }
  static HWY_INLINE BoxVec get(const float* from) {
    if constexpr (kCopies == 1) return hn::Set(BoxTag(), *from);
    return hn::Load(BoxTag(), from);
  }

  HWY_INLINE WalkingRays(const BundleSlab& slab, std::uint32_t rays) {
    for (int axis = 0; axis < 3; ++axis) backward[axis] = (slab.backward[axis] & rays) != 0;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      for (int axis = 0; axis < 3; ++axis) {
        const float lower = -slab.from_lower[axis][i], upper = slab.from_upper[axis][i];
        set(ray[i].first[axis], backward[axis] ? upper : lower);
        set(ray[i].last[axis], backward[axis] ? lower : upper);
        set(ray[i].inverse[axis], slab.inverse[axis][i]);
      }
      set(ray[i].begin, slab.begin[i]);
      set(ray[i].minus_end, slab.minus_end[i]);
    }
  }
};

/// For each child of a node, those of `rays` that meet its box.
HWY_INLINE void meet(const WideNode& node, const WalkingRays& walking, std::uint32_t rays,
                     hn::Vec<MaskTag>* met) {
  const BoxTag d;
  const MaskTag dm;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  HWY_ALIGN float first[3][kWidth], last[3][kWidth];  // lower sides, and negative upper ones
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t part = 0; part < kWidth; part += kLanes) {
      const auto lower = planes(node, axis, 0, part);
      const auto minus_upper = hn::Neg(planes(node, axis, 1, part));
      hn::Store(lower, d, (walking.backward[axis] ? last : first)[axis] + part);
      hn::Store(minus_upper, d, (walking.backward[axis] ? first : last)[axis] + part);
    }
  }
  for (std::size_t part = 0; part < kWidth; part += kLanes) met[part / kLanes] = hn::Zero(dm);
  for (; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
    const WalkingRays::OneRay& ray = walking.ray[i];
    for (std::size_t part = 0; part < kWidth; part += kLanes) {
      const auto farther = [&](const BoxVec& t, const float* side, const float* from,
                               const float* inverse) HWY_ATTR {
        const auto distance = hn::Add(hn::Load(d, side + part), WalkingRays::get(from));
        return hn::Max(t, hn::Mul(distance, WalkingRays::get(inverse)));
      };
      auto enter = WalkingRays::get(ray.begin), minus_leave = WalkingRays::get(ray.minus_end);
      for (int axis = 0; axis < 3; ++axis) {
        enter = farther(enter, first[axis], ray.first[axis], ray.inverse[axis]);
        minus_leave = farther(minus_leave, last[axis], ray.last[axis], ray.inverse[axis]);
      }
      const auto meets = hn::RebindMask(dm, hn::Le(enter, hn::Neg(minus_leave)));
      auto& to = met[part / kLanes];
      to = hn::Or(to, hn::IfThenElseZero(meets, hn::Set(dm, 1u << i)));
    }
  }
}
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
  meet(node, walking, rays, met);
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
