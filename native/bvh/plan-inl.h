// The plan of a treelet's wide nodes (bvh/wide_plan.h), in lanes. Included once per instruction set
// (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

#if HWY_MAX_BYTES >= 32
/// plan_inner, all sizes of a forest at once: lane i is that of i + 2 nodes.
class Planner {
 public:
  Planner() {
    for (std::uint32_t by = 0; by < kPlanWidth; ++by) {
      alignas(32) std::uint32_t from[kPlanWidth];
      // The last lane of costs is kNoPlan, which is never best.
      for (std::uint32_t i = 0; i < kPlanWidth; ++i) from[i] = i < by ? kPlanWidth - 1 : i - by;
      up_[by] = hn::SetTableIndices(Float8(), from);
    }
  }

  HWY_INLINE std::uint32_t inner(float area, const PlanCost& left, const PlanCost& right,
                                 PlanCost* cost) const {
    const Float8 d;
    const hn::FixedTag<std::uint32_t, 8> du;
    const auto of_right = hn::Load(d, right.at);
    auto best = hn::Add(hn::Set(d, left.at[0]), of_right);
    auto share = hn::Set(du, 1u);
    for (std::uint32_t k = 2; k < kPlanWidth; ++k) {
      const auto c =
          hn::Add(hn::Set(d, left.at[k - 1]), hn::TableLookupLanes(of_right, up_[k - 1]));
      share = hn::IfThenElse(hn::RebindMask(du, hn::Lt(c, best)), hn::Set(du, k), share);
      best = hn::Min(c, best);
    }
    // The last lane stands for no size.
    const auto most = hn::Set(d, kNoPlan);
    const auto is_last = hn::Eq(hn::Iota(d, 0.0f), hn::Set(d, kPlanWidth - 1.0f));
    best = hn::IfThenElse(is_last, most, best);
    const auto least = hn::MinOfLanes(d, best);
    // Where costs are no numbers, none is the least.
    std::uint8_t is_least[8] = {};
    hn::StoreMaskBits(d, hn::Eq(best, least), is_least);
    const auto children = static_cast<std::uint32_t>(std::countr_zero(is_least[0] | 64u)) + 2;
    // Least costs so far: of the node itself, then with every size.
    const auto itself = hn::Add(hn::Set(d, area * kNodeCost), least);
    const auto is_first = hn::Eq(hn::Iota(d, 0.0f), hn::Zero(d));
    auto so_far = hn::IfThenElse(is_first, itself, hn::TableLookupLanes(best, up_[1]));
    for (const std::uint32_t by : {1u, 2u, 4u}) {
      const auto before = hn::TableLookupLanes(hn::IfThenElse(is_last, most, so_far), up_[by]);
      so_far = hn::Min(so_far, before);
    }
    hn::Store(hn::IfThenElse(is_last, most, so_far), d, cost->at);
    std::uint8_t no_worse[8] = {};
    hn::StoreMaskBits(d, hn::Le(so_far, best), no_worse);
    alignas(32) static constexpr std::uint32_t kPlaces[8] = {0, 3, 6, 9, 12, 15, 18, 31};
    alignas(32) static constexpr std::uint32_t kUsed[8] = {~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, 0u};
    const auto shares = hn::And(share << hn::Load(du, kPlaces), hn::Load(du, kUsed));
    const auto sum = hn::GetLane(hn::SumOfLanes(du, shares));
    return kInnerBit | sum | (no_worse[0] & 63u) << 21 | (children - 1) << 27;
  }

 private:
  hn::Indices256<float> up_[kPlanWidth];  ///< moves lanes up by so many
};
#else
struct Planner {
  HWY_INLINE std::uint32_t inner(float area, const PlanCost& left, const PlanCost& right,
                                 PlanCost* cost) const {
    return plan_inner(area, left, right, cost);
  }
};
#endif

/// Gives inner nodes their boxes, and all their costs. Children stand behind their parents.
void plan(float scale, Treelet& t) {
  const Planner planner;
  for (std::uint32_t i = t.node_count; i-- > 0;) {
    BinaryNode& node = t.nodes[i];
    if (node.is_leaf()) {
      t.cost[i] = plan_leaf(area_of(node_box(node), scale));
    } else {
      const Lanes box = merge(node_box(t.nodes[node.first]), node_box(t.nodes[node.first + 1]));
      const std::uint32_t info = planner.inner(area_of(box, scale), t.cost[node.first],
                                               t.cost[node.first + 1], &t.cost[i]);
      write_node(node, box, node.first, info);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
