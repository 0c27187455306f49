// Boxes of a node's children onto its grid, in lanes. Included once per instruction set (no include
// guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

using GridTag = hn::CappedTag<float, kWidth>;
using GridLanes = hn::Vec<GridTag>;
constexpr int kGridLanes = HWY_MAX_BYTES >= 32 ? 8 : 4;

/// One axis of a node's grid: the traversal's own arithmetic (WideNode::plane) in lanes.
struct LaneGrid {
  GridLanes origin, step;
  HWY_INLINE GridLanes at(GridLanes q) const { return hn::Add(origin, hn::Mul(q, step)); }
};

/// The last plane that is not above x (`kLower`), or the first that is not below. The guess is off
/// by what rounding does, as in bvh/quantise.cpp, whose planes these are.
template <bool kLower>
HWY_INLINE void store_planes(const LaneGrid& grid, float inverse_step, GridLanes x,
                             hn::Mask<GridTag> is_used, std::uint8_t* to) {
  const GridTag d;
  const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d), last = hn::Set(d, 255.0f);
  const auto place = hn::Mul(hn::Sub(x, grid.origin), hn::Set(d, inverse_step));
  const auto inside = hn::Min(hn::Max(place, zero), last);
  auto q = kLower ? hn::Floor(inside) : hn::Ceil(inside);
  while (true) {
    const auto next = kLower ? hn::Add(q, one) : hn::Sub(q, one);
    const auto fits = kLower ? hn::And(hn::Le(grid.at(next), x), hn::Lt(q, last))
                             : hn::And(hn::Ge(grid.at(next), x), hn::Gt(q, zero));
    if (HWY_LIKELY(hn::AllFalse(d, fits))) break;
    q = hn::IfThenElse(fits, next, q);
  }
  while (true) {
    const auto fails = kLower ? hn::And(hn::Gt(grid.at(q), x), hn::Gt(q, zero))
                              : hn::And(hn::Lt(grid.at(q), x), hn::Lt(q, last));
    if (HWY_LIKELY(hn::AllFalse(d, fails))) break;
    q = hn::IfThenElse(fails, kLower ? hn::Sub(q, one) : hn::Add(q, one), q);
  }
  q = hn::IfThenElse(is_used, q, kLower ? last : zero);
  const hn::Rebind<std::int32_t, GridTag> di;
  const auto whole = hn::BitCast(hn::RebindToUnsigned<decltype(di)>(), hn::ConvertTo(di, q));
  hn::StoreU(hn::U8FromU32(whole), hn::Rebind<std::uint8_t, GridTag>(), to);
}

/// x, y and z of the low or negated high corners of some children, from `first` on.
struct Corners {
  GridLanes axis[3];
};

/// `corner(i)` are four lanes of child i.
template <class Corner>
HWY_INLINE Corners corners_of(int first, const Corner& corner) {
  Vector4 near[3];
  transpose(corner(first), corner(first + 1), corner(first + 2), corner(first + 3), near);
  Corners all;
#if HWY_MAX_BYTES >= 32
  Vector4 far[3];
  transpose(corner(first + 4), corner(first + 5), corner(first + 6), corner(first + 7), far);
  for (int k = 0; k < 3; ++k) all.axis[k] = hn::Combine(GridTag(), far[k], near[k]);
#else
  for (int k = 0; k < 3; ++k) all.axis[k] = near[k];
#endif
  return all;
}

/// As quantise (bvh/quantise.h), to the bit.
void quantise_children(const BinaryNode* nodes, const std::uint32_t* children, int count,
                       WideNode& wide) {
  constexpr int kParts = kWidth / kGridLanes;
  alignas(32) static constexpr float kNumbers[kWidth] = {0, 1, 2, 3, 4, 5, 6, 7};
  const GridTag d;
  const auto child = [&](int i) -> const BinaryNode& { return nodes[children[i < count ? i : 0]]; };
  Corners lo[kParts], minus_hi[kParts];
  for (int p = 0; p < kParts; ++p) {
    lo[p] = corners_of(p * kGridLanes, [&](int i) { return hn::Load(Float4(), child(i).lo); });
    minus_hi[p] =
        corners_of(p * kGridLanes, [&](int i) { return hn::Load(Float4(), child(i).minus_hi); });
  }
  for (int axis = 0; axis < 3; ++axis) {
    auto least = lo[0].axis[axis], minus_most = minus_hi[0].axis[axis];
    for (int p = 1; p < kParts; ++p) {
      least = hn::Min(least, lo[p].axis[axis]);
      minus_most = hn::Min(minus_most, minus_hi[p].axis[axis]);
    }
    const float origin = hn::GetLane(hn::MinOfLanes(d, least));
    wide.origin[axis] = origin;
    wide.exponent[axis] = choose_grid_exponent(origin, -hn::GetLane(hn::MinOfLanes(d, minus_most)));
    const float step = wide.step(axis);
    const LaneGrid grid{hn::Set(d, origin), hn::Set(d, step)};
    for (int p = 0; p < kParts; ++p) {
      std::uint8_t* const lower = wide.q[axis][0] + p * kGridLanes;
      std::uint8_t* const upper = wide.q[axis][1] + p * kGridLanes;
      const auto number = hn::Add(hn::Load(d, kNumbers), hn::Set(d, float(p * kGridLanes)));
      const auto is_used = hn::Lt(number, hn::Set(d, static_cast<float>(count)));
      store_planes<true>(grid, 1.0f / step, lo[p].axis[axis], is_used, lower);
      store_planes<false>(grid, 1.0f / step, hn::Neg(minus_hi[p].axis[axis]), is_used, upper);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
