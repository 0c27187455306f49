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

/// A plane through the centre of each item on each axis, a lane each, axis by axis: on the left is
/// what lies before or on it. Ranges get no centres: who is to be split next is as few.
HWY_INLINE void split_few(Treelet& t, float scale, const Range& range, Range* left, Range* right) {
  const FewTag d;
  constexpr std::uint32_t kPlanes = 3 * kFewItems;
  const std::uint32_t count = range.end - range.begin, planes = 3 * count;
  std::uint32_t* const ids = t.ids + range.begin;
  alignas(64) float plane[kPlanes + kFewItems];
  float weight[kFewItems];
  for (std::uint32_t i = 0; i < count; ++i) {
    weight[i] = static_cast<float>(t.triangles[ids[i]]);
    for (std::uint32_t axis = 0; axis < 3; ++axis) plane[axis * count + i] = t.centre[ids[i]][axis];
  }
  hn::StoreU(hn::Set(d, kFloatMax), d, plane + planes);  // nothing on the right of these
  float best = kFloatMax;
  std::uint32_t best_plane = planes;
  const auto most = hn::Set(d, kFloatMax);
  const auto all = hn::Set(d, static_cast<float>(range.triangles));
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  for (std::uint32_t first = 0; first < planes; first += lanes) {
    const auto at = hn::Load(d, plane + first);
    const auto number = hn::Add(hn::Set(d, static_cast<float>(first)), hn::Iota(d, 0.0f));
    const auto is_x = hn::Lt(number, hn::Set(d, static_cast<float>(count)));
    const auto is_y = hn::Lt(number, hn::Set(d, static_cast<float>(2 * count)));
    FewBoxes before, behind;
    for (int k = 0; k < 6; ++k) before.side[k] = behind.side[k] = most;
    auto triangles = hn::Zero(d);
    for (std::uint32_t i = 0; i < count; ++i) {
      const float* const v = t.box[ids[i]].v;
      const Few box[6] = {hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2]),
                          hn::Set(d, v[4]), hn::Set(d, v[5]), hn::Set(d, v[6])};
      const auto y_or_z =
          hn::IfThenElse(is_y, hn::Set(d, plane[count + i]), hn::Set(d, plane[2 * count + i]));
      const auto centre = hn::IfThenElse(is_x, hn::Set(d, plane[i]), y_or_z);
      const auto is_before = hn::Le(centre, at);
      add_where(is_before, box, before);
      add_where(hn::Not(is_before), box, behind);
      triangles = hn::IfThenElse(is_before, hn::Add(triangles, hn::Set(d, weight[i])), triangles);
    }
    const auto others = hn::Sub(all, triangles);
    const auto sum = hn::Add(cost_of(before, triangles, scale), cost_of(behind, others, scale));
    // No number, or nothing on the right: no plane.
    const auto is_plane = hn::And(hn::Lt(sum, most), hn::Gt(others, hn::Zero(d)));
    const auto cost = hn::IfThenElse(is_plane, sum, most);
    const float least = hn::GetLane(hn::MinOfLanes(d, cost));
    if (least < best) {
      best = least;
      const auto lane = hn::FindFirstTrue(d, hn::Eq(cost, hn::Set(d, least)));
      best_plane = first + static_cast<std::uint32_t>(lane);
    }
  }
  if (best_plane == planes) return split_in_halves(ItemList{t}, range, left, right);
  const float* const centre = plane + best_plane / count * count;
  const float where = plane[best_plane];
  std::uint32_t to_left = 0, to_right = 0, left_triangles = 0;
  std::uint32_t moved[kFewItems];
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t id = ids[i];
    const std::uint32_t is_right = centre[i] > where ? 1 : 0;
    ids[to_left] = id;
    moved[to_right] = id;
    to_left += 1u - is_right;
    to_right += is_right;
    left_triangles += (1u - is_right) * t.triangles[id];
  }
  for (std::uint32_t k = 0; k < to_right; ++k) ids[to_left + k] = moved[k];
  *left = Range{range.begin, range.begin + to_left, left_triangles, empty_lanes()};
  *right = Range{range.begin + to_left, range.end, range.triangles - left_triangles, empty_lanes()};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
