// Boxes and leaf tests in lanes. Included once per instruction set (no include guard), like
// traverse_simd-inl.h.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Numbers in a vector of up to sixteen.
constexpr std::uint32_t kLanes = HWY_MAX_BYTES >= 64 ? 16 : HWY_MAX_BYTES >= 32 ? 8 : 4;
constexpr std::uint32_t kAllLanes = (1u << kLanes) - 1;

/// One bit for each lane of such a vector.
template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, 4);
  return bits & kAllLanes;
}
/// Other bits than those of lanes are not looked at.
template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, std::uint64_t bits) {
  std::uint8_t bytes[8];
  std::memcpy(bytes, &bits, 8);
  return hn::LoadMaskBits(d, bytes);
}

using Float4 = hn::FixedTag<float, 4>;
using Vector4 = hn::Vec<Float4>;

/// A box as eight lanes: low corner, negated high corner, each with a lane to spare that is zero.
#if HWY_MAX_BYTES >= 32
using Float8 = hn::FixedTag<float, 8>;
using Lanes = hn::Vec<Float8>;

HWY_INLINE Lanes load_box(const float* box) {
  return hn::Load(Float8(), box);
}
HWY_INLINE void store_box(Lanes box, float* to) {
  hn::Store(box, Float8(), to);
}
HWY_INLINE Lanes merge(Lanes a, Lanes b) {
  return hn::Min(a, b);
}
HWY_INLINE Vector4 low(Lanes box) {
  return hn::LowerHalf(Float4(), box);
}
HWY_INLINE Vector4 minus_high(Lanes box) {
  return hn::UpperHalf(Float4(), box);
}
HWY_INLINE Lanes sum(Lanes a, Lanes b) {
  return hn::Add(a, b);
}
HWY_INLINE Lanes make_box(Vector4 lo, Vector4 minus_hi) {
  return hn::Combine(Float8(), minus_hi, lo);
}
/// The first for 1, the second for 0.
HWY_INLINE Lanes choose(std::uint32_t first, Lanes a, Lanes b) {
  const auto bits = hn::Set(hn::RebindToUnsigned<Float8>(), 0u - first);
  return hn::IfThenElse(hn::MaskFromVec(hn::BitCast(Float8(), bits)), a, b);
}
#else
struct Lanes {
  Vector4 lo, minus_hi;
};

HWY_INLINE Lanes load_box(const float* box) {
  return {hn::Load(Float4(), box), hn::Load(Float4(), box + 4)};
}
HWY_INLINE void store_box(Lanes box, float* to) {
  hn::Store(box.lo, Float4(), to);
  hn::Store(box.minus_hi, Float4(), to + 4);
}
HWY_INLINE Lanes merge(Lanes a, Lanes b) {
  return {hn::Min(a.lo, b.lo), hn::Min(a.minus_hi, b.minus_hi)};
}
HWY_INLINE Vector4 low(Lanes box) {
  return box.lo;
}
HWY_INLINE Vector4 minus_high(Lanes box) {
  return box.minus_hi;
}
HWY_INLINE Lanes sum(Lanes a, Lanes b) {
  return {hn::Add(a.lo, b.lo), hn::Add(a.minus_hi, b.minus_hi)};
}
HWY_INLINE Lanes make_box(Vector4 lo, Vector4 minus_hi) {
  return {lo, minus_hi};
}
HWY_INLINE Lanes choose(std::uint32_t first, Lanes a, Lanes b) {
  const auto bits = hn::Set(hn::RebindToUnsigned<Float4>(), 0u - first);
  const auto mask = hn::MaskFromVec(hn::BitCast(Float4(), bits));
  return {hn::IfThenElse(mask, a.lo, b.lo), hn::IfThenElse(mask, a.minus_hi, b.minus_hi)};
}
#endif

HWY_INLINE Lanes empty_lanes() {
  const auto most = hn::Set(Float4(), kFloatMax);
  return make_box(most, most);
}

/// Half the surface of a box that is not empty, in units of 1 / scale².
HWY_INLINE float area_of(Lanes box, float scale) {
  const auto sides = hn::Mul(hn::Neg(hn::Add(low(box), minus_high(box))), hn::Set(Float4(), scale));
  const auto next = hn::Mul(sides, hn::Shuffle0321(sides));   // xy yz .. ..
  const auto other = hn::Mul(sides, hn::Shuffle1032(sides));  // xz .. .. ..
  const auto sum = hn::Add(next, other);
  return hn::GetLane(hn::Add(sum, hn::Shuffle2301(sum)));
}

/// The centre; halved before the sum, so that it cannot overflow.
HWY_INLINE Vector4 centre_of(Lanes box) {
  const auto half = hn::Set(Float4(), 0.5f);
  return hn::Sub(hn::Mul(low(box), half), hn::Mul(minus_high(box), half));
}

/// The centre, and in lane 3 minus the box's longest side. `box` has nothing in its spare lanes.
HWY_INLINE Vector4 centre_and_side_of(Lanes box) {
  const auto minus_side = hn::Add(low(box), minus_high(box));
  const auto pairs = hn::Min(minus_side, hn::Shuffle1032(minus_side));
  const auto least = hn::Min(pairs, hn::Shuffle2301(pairs));
  return hn::IfThenElse(hn::FirstN(Float4(), 3), centre_of(box), least);
}

/// The box of one point.
HWY_INLINE Lanes point_box(Vector4 p) {
  return make_box(p, hn::Neg(p));
}

HWY_INLINE Vector4 three_lanes(Vector4 v) {
  alignas(16) static constexpr std::uint32_t kMask[4] = {~0u, ~0u, ~0u, 0u};
  const auto mask = hn::Load(hn::FixedTag<std::uint32_t, 4>(), kMask);
  return hn::And(v, hn::BitCast(Float4(), mask));
}

/// x, y and z of four points.
HWY_INLINE void transpose(Vector4 a, Vector4 b, Vector4 c, Vector4 e, Vector4* xyz) {
  const Float4 d;
  const auto ab = hn::InterleaveLower(d, a, b), ce = hn::InterleaveLower(d, c, e);
  xyz[0] = hn::ConcatLowerLower(d, ce, ab);
  xyz[1] = hn::ConcatUpperUpper(d, ce, ab);
  xyz[2] = hn::ConcatLowerLower(d, hn::InterleaveUpper(d, c, e), hn::InterleaveUpper(d, a, b));
}

/// The box of a node, whose spare lanes hold something else.
HWY_INLINE Lanes node_box(const BinaryNode& node) {
  const Lanes box = load_box(node.lo);
  return make_box(three_lanes(low(box)), three_lanes(minus_high(box)));
}

HWY_INLINE void write_node(BinaryNode& node, Lanes box, std::uint32_t first, std::uint32_t info) {
  store_box(box, node.lo);
  node.first = first;
  node.info = info;
}

HWY_INLINE Lanes box_of_run(const Treelet& t, std::uint32_t begin, std::uint32_t end) {
  Lanes box = load_box(t.box[t.ids[begin]].v);
  for (std::uint32_t i = begin + 1; i < end; ++i) box = merge(box, load_box(t.box[t.ids[i]].v));
  return box;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
