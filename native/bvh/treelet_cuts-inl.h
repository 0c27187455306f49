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
    float sum = 0.0f;
    for (std::uint32_t i = 0; i < count; ++i) sum += area(i);
    choose(count, price * sum / static_cast<float>(count), alone);
    ends_ = 0;
    for (std::uint32_t end = count; end > 0; end -= length_[end - 1]) end_[ends_++] = end;
  }
  std::uint32_t count() const { return ends_; }
  /// The end of run i.
  std::uint32_t end(std::uint32_t i) const { return end_[ends_ - 1 - i]; }
  /// The area of a box; of the run that ends with it.
  float area(std::uint32_t i) const { return area_[0][kBefore + i]; }
  float area_of_run(std::uint32_t i) const { return area_[length_[i] - 1][kBefore + i]; }

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

  void choose(std::uint32_t count, float price, bool alone) {
    // Costs are not negative: their bits have their order, and the lowest three hold the length.
    constexpr std::uint32_t kLength = kWidth - 1;
    std::fill_n(cost_, kBefore, kFloatMax);
    cost_[kBefore - 1] = 0.0f;
    const float alone_price = alone ? price : kFloatMax;
    for (std::uint32_t i = kBefore; i < kBefore + count; ++i) {
      std::uint32_t best = std::bit_cast<std::uint32_t>(cost_[i - 1] + alone_price) & ~kLength;
      for (std::uint32_t k = 1; k < kWidth; ++k) {
        const float cost = cost_[i - 1 - k] + (area_[k][i] + price);
        const std::uint32_t bits = (std::bit_cast<std::uint32_t>(cost) & ~kLength) | k;
        best = bits < best ? bits : best;
      }
      length_[i - kBefore] = (best & kLength) + 1;
      cost_[i] = std::bit_cast<float>(best & ~kLength);
    }
  }

  static constexpr std::uint32_t kLanes = HWY_MAX_BYTES >= 64 ? 16 : HWY_MAX_BYTES >= 32 ? 8 : 4;
  float side_[6][kRoom];
  float area_[kWidth][kRoom];  ///< of the run of k + 1 boxes that ends at each
  float cost_[kRoom];
  std::uint32_t length_[kMost];
  std::uint32_t end_[kMost];
  std::uint32_t ends_ = 0;
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
