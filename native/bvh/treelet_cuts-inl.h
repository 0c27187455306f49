// The best way to cut a sequence of boxes into wide nodes. Included once per instruction set (no
// include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// Cuts a sequence of boxes into runs of up to eight so that the runs' areas, and a price for each,
/// come to the least sum: dynamic programming from the front, over the length of the run that ends
/// at each box. A box alone costs no area, as it needs no node: it is left to the level above, so
/// one large box does not blow up node after node.
class RunCuts {
 public:
  /// `count` ≤ kMost boxes of `nodes`; each run costs `price` × their mean area besides. Unless
  /// `alone` is set, no run is of one.
  void find(const BinaryNode* nodes, std::uint32_t count, float price, float scale, bool alone) {
    take_boxes(nodes, count);
    measure(count, scale);
    sum_areas(count);
    choose(count, price * sum_ / static_cast<float>(count), alone);
    ends_ = 0;
    for (std::uint32_t end = count; end > 0; end -= length_[end - 1]) end_[ends_++] = end;
  }
  std::uint32_t count() const { return ends_; }
  /// The end of run i.
  std::uint32_t end(std::uint32_t i) const { return end_[ends_ - 1 - i]; }
  /// The area of a box; of the run that ends with it; of all boxes.
  float area(std::uint32_t i) const { return area_[0][kBefore + i]; }
  float area_of_run(std::uint32_t i) const { return area_[length_[i] - 1][kBefore + i]; }
  float sum_of_areas() const { return sum_; }

  static constexpr std::uint32_t kMost = kTreeletSize;

 private:
  using Tag = hn::CappedTag<float, 16>;
  using Numbers = hn::Vec<Tag>;
  static constexpr std::uint32_t kBefore = kWidth;
  static constexpr std::uint32_t kRoom = kBefore + kMost + kBehindDesk;

  /// A coordinate a row; before the first stands what changes no box.
  void take_boxes(const BinaryNode* nodes, std::uint32_t count) {
    const Float4 d;
    for (auto& row : side_) std::fill_n(row, kBefore, kFloatMax);
    for (std::uint32_t i = 0; i < count; i += 4) {
      const auto node = [&](std::uint32_t k) -> const BinaryNode& {
        return nodes[i + k < count ? i + k : count - 1];
      };
      Vector4 lo[3], minus_hi[3];
      transpose(hn::Load(d, node(0).lo), hn::Load(d, node(1).lo), hn::Load(d, node(2).lo),
                hn::Load(d, node(3).lo), lo);
      transpose(hn::Load(d, node(0).minus_hi), hn::Load(d, node(1).minus_hi),
                hn::Load(d, node(2).minus_hi), hn::Load(d, node(3).minus_hi), minus_hi);
      for (int axis = 0; axis < 3; ++axis) {
        hn::StoreU(lo[axis], d, side_[axis] + kBefore + i);
        hn::StoreU(minus_hi[axis], d, side_[3 + axis] + kBefore + i);
      }
    }
  }

  /// Areas of all runs.
  void measure(std::uint32_t count, float scale) {
    const Tag d;
    const auto in_units = hn::Set(d, -scale), large = hn::Set(d, 1e12f);
    for (std::uint32_t i = kBefore; i < kBefore + count; i += kLanes) {
      Numbers box[6];
      for (int k = 0; k < 6; ++k) box[k] = hn::LoadU(d, side_[k] + i);
      for (std::uint32_t length = 1; length <= kWidth; ++length) {
        Numbers side[3];
        for (int k = 0; k < 6; ++k) {
          box[k] = hn::Min(box[k], hn::LoadU(d, side_[k] + i - (length - 1)));
        }
        for (int axis = 0; axis < 3; ++axis) {
          side[axis] = hn::Mul(hn::Add(box[axis], box[3 + axis]), in_units);
        }
        const auto xy_xz = hn::Mul(side[0], hn::Add(side[1], side[2]));
        // What is no number is large too: sums must stay below that of what cannot be.
        const auto area = hn::Add(xy_xz, hn::Mul(side[1], side[2]));
        hn::StoreU(hn::IfThenElse(hn::Lt(area, large), area, large), d, area_[length - 1] + i);
      }
    }
  }

  /// In sixteen parts, whatever the number of lanes.
  void sum_areas(std::uint32_t count) {
    const Tag d;
    constexpr std::uint32_t kParts = 16 / kLanes;
    float* const area = area_[0] + kBefore;
    std::fill_n(area + count, kBehindDesk, 0.0f);
    Numbers sum[kParts];
    for (auto& part : sum) part = hn::Zero(d);
    for (std::uint32_t i = 0; i < count; i += 16) {
      for (std::uint32_t p = 0; p < kParts; ++p) {
        sum[p] = hn::Add(sum[p], hn::LoadU(d, area + i + p * kLanes));
      }
    }
    alignas(64) float part[16];
    for (std::uint32_t p = 0; p < kParts; ++p) hn::Store(sum[p], d, part + p * kLanes);
    sum_ = 0.0f;
    for (const float its : part) sum_ += its;
  }

  void choose(std::uint32_t count, float price, bool alone) {
    // Costs are not negative: their bits have their order, and the lowest three hold the length.
    // One lane: each cost waits for the one before, and would wait longer on its way to integers.
    const hn::FixedTag<float, 1> d;
    const hn::FixedTag<std::uint32_t, 1> du;
    constexpr std::uint32_t kLength = kWidth - 1;
    const auto of_cost = hn::Set(du, ~kLength);
    std::fill_n(cost_, kBefore, kFloatMax);
    cost_[kBefore - 1] = 0.0f;
    const auto node_price = hn::Set(d, price), alone_price = hn::Set(d, alone ? price : kFloatMax);
    auto last = hn::Zero(d);
    for (std::uint32_t i = kBefore; i < kBefore + count; ++i) {
      auto best = hn::Set(du, ~0u);
      for (std::uint32_t k = kWidth - 1; k > 0; --k) {
        const auto run = hn::Add(hn::Load(d, area_[k] + i), node_price);
        const auto cost = hn::BitCast(du, hn::Add(hn::Load(d, cost_ + i - 1 - k), run));
        best = hn::Min(best, hn::Or(hn::And(cost, of_cost), hn::Set(du, k)));
      }
      best = hn::Min(best, hn::And(hn::BitCast(du, hn::Add(last, alone_price)), of_cost));
      last = hn::BitCast(d, hn::And(best, of_cost));
      hn::Store(hn::Add(hn::AndNot(of_cost, best), hn::Set(du, 1u)), du, length_ + i - kBefore);
      hn::Store(last, d, cost_ + i);
    }
  }

  float side_[6][kRoom];
  float area_[kWidth][kRoom];  ///< of the run of k + 1 boxes that ends at each
  float cost_[kRoom];
  std::uint32_t length_[kMost];
  std::uint32_t end_[kMost];
  std::uint32_t ends_ = 0;
  float sum_ = 0.0f;
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
