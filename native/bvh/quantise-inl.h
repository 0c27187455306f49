// Boxes of a node's children onto its grid, in lanes. Included once per instruction set (no include
// guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

using PlaneTag = hn::CappedTag<float, 2 * kWidth>;

/// A node's planes on one axis, the children's lower ones and then the upper ones, as
/// WideNode::q has them.
struct alignas(64) AxisPlanes {
  float at[2 * kWidth];
};

/// Upper planes are lower ones in a mirror.
struct MirrorSigns {
  alignas(64) std::uint32_t of[2 * kWidth];
  constexpr MirrorSigns() : of() {
    for (int i = 0; i < kWidth; ++i) of[kWidth + i] = 0x80000000u;
  }
};
constexpr MirrorSigns kMirrorSigns;

/// Which planes so many children have, as masks.
struct UsedPlanes {
  alignas(64) std::uint32_t of[kWidth + 1][2 * kWidth];
  constexpr UsedPlanes() : of() {
    for (int count = 0; count <= kWidth; ++count) {
      for (int i = 0; i < count; ++i) of[count][i] = of[count][kWidth + i] = ~0u;
    }
  }
};
constexpr UsedPlanes kUsedPlanes;

/// Where planes go on a grid, as bvh/quantise.cpp has it.
HWY_INLINE void store_planes(const AxisPlanes& planes, int count, float origin_of_all,
                             float step_of_all, std::uint8_t* to) {
  const PlaneTag d;
  const hn::RebindToUnsigned<PlaneTag> du;
  const auto origin = hn::Set(d, origin_of_all), step = hn::Set(d, step_of_all);
  const auto inverse_step = hn::Set(d, 1.0f / step_of_all);
  for (std::size_t i = 0; i < 2 * kWidth; i += hn::Lanes(d)) {
    const auto signs = hn::Load(du, kMirrorSigns.of + i);
    const auto mirrored = [&](auto v) { return hn::Xor(v, hn::BitCast(d, signs)); };
    // A child that is not there is an empty box.
    const auto is_used = hn::MaskFromVec(hn::BitCast(d, hn::Load(du, kUsedPlanes.of[count] + i)));
    const auto x =
        hn::IfThenElse(is_used, hn::Load(d, planes.at + i), mirrored(hn::Set(d, kFloatMax)));
    const auto place = hn::Mul(hn::Sub(x, origin), inverse_step);
    const auto inside = hn::Min(hn::Max(place, hn::Zero(d)), hn::Set(d, 255.0f));
    auto q = mirrored(hn::Floor(mirrored(inside)));
    while (true) {
      const auto at = hn::Add(origin, hn::Mul(q, step));
      const auto fails = hn::Gt(mirrored(at), mirrored(x));
      if (HWY_LIKELY(hn::AllFalse(d, fails))) break;
      q = hn::Sub(q, hn::IfThenElseZero(fails, mirrored(hn::Set(d, 1.0f))));
    }
    const hn::Rebind<std::int32_t, PlaneTag> di;
    const auto whole = hn::BitCast(hn::RebindToUnsigned<decltype(di)>(), hn::ConvertTo(di, q));
    hn::StoreU(hn::U8FromU32(whole), hn::Rebind<std::uint8_t, PlaneTag>(), to + i);
  }
}

/// choose_grid_exponent (bvh/quantise.h) for three axes.
HWY_INLINE hn::Vec<hn::RebindToUnsigned<Float4>> grid_exponents(Vector4 lo, Vector4 hi) {
  const Float4 d;
  const hn::RebindToUnsigned<Float4> du;
  const auto least = hn::Mul(hn::Sub(hi, lo), hn::Set(d, kGridShare));
  auto exponent = hn::Min(hn::Max(hn::ShiftRight<23>(hn::BitCast(du, least)), hn::Set(du, 1u)),
                          hn::Set(du, kFirstGridExponent));
  const auto axes = hn::FirstN(du, 3);
  while (true) {
    const auto step = hn::BitCast(d, hn::ShiftLeft<23>(exponent));
    const auto end = hn::Add(lo, hn::Mul(hn::Set(d, 255.0f), step));
    const auto reaches = hn::RebindMask(du, hn::Ge(end, hi));
    const auto is_short = hn::And(axes, hn::AndNot(reaches, hn::Lt(exponent, hn::Set(du, 254u))));
    if (hn::AllFalse(du, is_short)) return exponent;
    exponent = hn::Sub(exponent, hn::VecFromMask(du, is_short));
  }
}

/// As quantise (bvh/quantise.h), to the bit.
void quantise_children(const BinaryNode* nodes, const std::uint32_t* children, int count,
                       WideNode& wide) {
  const Float4 d;
  AxisPlanes planes[3];
  Vector4 least = hn::Set(d, kFloatMax), minus_most = least;
  for (int i = 0; i < kWidth; i += 4) {
    Vector4 lo[4], minus_hi[4];
    for (int k = 0; k < 4; ++k) {
      const BinaryNode& child = nodes[children[i + k < count ? i + k : count - 1]];
      lo[k] = hn::Load(d, child.lo);
      minus_hi[k] = hn::Load(d, child.minus_hi);
      least = hn::Min(least, lo[k]);
      minus_most = hn::Min(minus_most, minus_hi[k]);
    }
    Vector4 lower[3], minus_upper[3];
    transpose(lo[0], lo[1], lo[2], lo[3], lower);
    transpose(minus_hi[0], minus_hi[1], minus_hi[2], minus_hi[3], minus_upper);
    for (int axis = 0; axis < 3; ++axis) {
      hn::Store(lower[axis], d, planes[axis].at + i);
      hn::Store(hn::Neg(minus_upper[axis]), d, planes[axis].at + kWidth + i);
    }
  }
  // Their spare lanes are bits of integers: as floats so small that they take ages.
  least = three_lanes(least);
  minus_most = three_lanes(minus_most);
  alignas(16) float origin[4];
  alignas(16) std::uint32_t exponent[4];
  hn::Store(least, d, origin);
  hn::Store(grid_exponents(least, hn::Neg(minus_most)), hn::RebindToUnsigned<Float4>(), exponent);
  for (int axis = 0; axis < 3; ++axis) {
    wide.origin[axis] = origin[axis];
    wide.exponent[axis] = static_cast<std::uint8_t>(exponent[axis]);
    store_planes(planes[axis], count, origin[axis], wide.step(axis), wide.q[axis][0]);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
