// Splits of few items by the surface-area heuristic, exactly: every plane through a centre is
// tried. Included once per instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// Ranges of so many items are split by this. Bins would cost more than what is put into them.
constexpr std::uint32_t kFewItems = 16;

using FewTag = hn::CappedTag<float, kFewItems>;
using Few = hn::Vec<FewTag>;

/// Six minima: low corner, negated high corner.
struct FewBoxes {
  Few side[6];
};

HWY_INLINE void add_where(hn::Mask<FewTag> where, const Few* box, FewBoxes& to) {
  for (int k = 0; k < 6; ++k) {
    to.side[k] = hn::IfThenElse(where, hn::Min(to.side[k], box[k]), to.side[k]);
  }
}

/// Area × (items + kLeafItems), in units of 1 / scale².
HWY_INLINE Few cost_of(const FewBoxes& boxes, Few items, float scale) {
  const FewTag d;
  Few side[3];
  for (int axis = 0; axis < 3; ++axis) {
    const auto sum = hn::Add(boxes.side[axis], boxes.side[3 + axis]);
    side[axis] = hn::Mul(hn::Neg(sum), hn::Set(d, scale));
  }
  const auto xy_xz = hn::Mul(side[0], hn::Add(side[1], side[2]));
  const auto area = hn::Add(xy_xz, hn::Mul(side[1], side[2]));
  return hn::Mul(area, hn::Add(items, hn::Set(d, kLeafItems)));
}

/// Lane j stands for the plane through item j's centre: on the left is what lies before or on it.
/// Ranges get no centres: who is to be split next is as few.
HWY_INLINE void split_few(Treelet& t, float scale, const Range& range, Range* left, Range* right) {
  const FewTag d;
  const std::uint32_t count = range.end - range.begin;
  std::uint32_t* const ids = t.ids + range.begin;
  alignas(64) float centre[3][kFewItems];
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) centre[axis][i] = t.centre[ids[i]][axis];
  }
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  for (std::uint32_t i = count; i < (count + lanes - 1) / lanes * lanes; ++i) {
    for (int axis = 0; axis < 3; ++axis) centre[axis][i] = kFloatMax;  // nothing on the right
  }
  float best = kFloatMax;
  float plane = 0.0f;
  int best_axis = -1;
  const auto most = hn::Set(d, kFloatMax), one = hn::Set(d, 1.0f);
  for (std::uint32_t first = 0; first < count; first += lanes) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto planes = hn::Load(d, centre[axis] + first);
      FewBoxes before, behind;
      for (int k = 0; k < 6; ++k) before.side[k] = behind.side[k] = most;
      auto items = hn::Zero(d);
      for (std::uint32_t i = 0; i < count; ++i) {
        const float* const v = t.box[ids[i]].v;
        const Few box[6] = {hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2]),
                            hn::Set(d, v[4]), hn::Set(d, v[5]), hn::Set(d, v[6])};
        const auto is_before = hn::Le(hn::Set(d, centre[axis][i]), planes);
        add_where(is_before, box, before);
        add_where(hn::Not(is_before), box, behind);
        items = hn::IfThenElse(is_before, hn::Add(items, one), items);
      }
      const auto others = hn::Sub(hn::Set(d, static_cast<float>(count)), items);
      const auto sum = hn::Add(cost_of(before, items, scale), cost_of(behind, others, scale));
      // No number, or nothing on the right: no plane.
      const auto is_plane = hn::And(hn::Lt(sum, most), hn::Gt(others, hn::Zero(d)));
      const auto cost = hn::IfThenElse(is_plane, sum, most);
      const float least = hn::GetLane(hn::MinOfLanes(d, cost));
      if (least < best) {
        best = least;
        best_axis = axis;
        const auto lane = hn::FindFirstTrue(d, hn::Eq(cost, hn::Set(d, least)));
        plane = centre[axis][first + static_cast<std::uint32_t>(lane)];
      }
    }
  }
  const ItemList list{t, t.ids, t.moved};
  if (best_axis < 0) return split_in_halves(list, range, left, right);
  std::uint32_t to_left = 0, to_right = 0;
  std::uint32_t moved[kFewItems];
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t id = ids[i];
    const std::uint32_t is_right = centre[best_axis][i] > plane ? 1 : 0;
    ids[to_left] = id;
    moved[to_right] = id;
    to_left += 1u - is_right;
    to_right += is_right;
  }
  for (std::uint32_t k = 0; k < to_right; ++k) ids[to_left + k] = moved[k];
  *left = Range{range.begin, range.begin + to_left, to_left, empty_lanes()};
  *right = Range{range.begin + to_left, range.end, to_right, empty_lanes()};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
