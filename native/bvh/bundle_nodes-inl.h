// One wide node and many rays. Included once per instruction set by traverse_simd.cpp, without a
// guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kMany = 16;  ///< rays that are better in lanes themselves

/// Rays waiting to visit a child: bit i for ray i.
struct Waiting {
  static constexpr std::uint32_t kLeaf = 0x80000000u;  ///< bit of a child that is a leaf
  /// As much again for walks that take turns, until one goes on by itself.
  static constexpr std::size_t kRoom = 2 * kStackSize + 8 * kWidth;

  std::uint32_t size = 0;
  std::uint32_t child[kRoom];
  std::uint32_t rays[kRoom];
  float begin[kRoom];  ///< for closest hits: where the first of the rays enters it
};

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
/// @param reach  of all the rays that walk
template <bool kNearest>
HWY_INLINE void visit_node(const WideNode& node, const WalkingRays& walking, const Reach& reach,
                           std::uint32_t rays, Waiting& waiting) {
  const MaskTag dm;
  const hn::Rebind<std::uint8_t, MaskTag> d8;
  constexpr std::size_t kLanes = hn::MaxLanes(dm);
  hn::Vec<MaskTag> met[kWidth / kLanes];
  BoxVec begins[kWidth / kLanes];
  const Sides sides(node, walking);
  if (__builtin_popcount(rays) >= kMany) {
    meet_in_lanes<kNearest>(node, sides, walking, reach, rays, met, begins);
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
