// How much a leaf can hold that begins at each triangle of a treelet.
// Included once per instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// A full leaf gives up to so many triangles to the next one if codes part more there.
constexpr std::uint32_t kLeafSlack = 3;

/// For each triangle, what a leaf that begins with it can be; what is said of the last ones goes
/// beyond the treelet's end. All at once in lanes: which corners of a triangle stand in one of
/// those before.
class LeafLengths {
 public:
  LeafLengths(const Treelet& t, LeafLimit limit) {
    find_cuts(t);
    if (limit.vertices == kNone) {
      std::fill_n(length_, t.triangle_count, limit.items);
      return;
    }
    const std::uint32_t count = t.triangle_count;
    for (std::uint32_t first = 0; first < count; first += kPart) {
      const std::uint32_t part = count - first < kPart ? count - first : kPart;
      take_corners(t, first);
      find_new_corners(part + kBefore);
      store_lengths(part, limit, first);
    }
  }
  /// How many triangles fit into it, at least one.
  std::uint32_t operator[](std::uint32_t i) const { return length_[i]; }
  /// Where it is best cut if it can be `most` triangles long, and there are more.
  HWY_INLINE std::uint32_t cut(std::uint32_t begin, std::uint32_t most) const {
    if (HWY_LIKELY(most > kLeafSlack)) return cut_[begin + most];
    std::uint32_t best = begin + most;
    for (std::uint32_t end = best - 1; end > begin; --end) {
      best = jump_[end] > jump_[best] ? end : best;
    }
    return best;
  }
  /// Its first corners, as LeafCorners has them, of eight triangles.
  std::uint32_t firsts(std::uint32_t i) const { return firsts_[i]; }

 private:
  using Tag = hn::CappedTag<std::uint32_t, 16>;
  using Indices = hn::Vec<Tag>;
  static constexpr std::uint32_t kPart = 256;
  static constexpr std::uint32_t kBefore = kClusterTriangles;  ///< more than a leaf looks back
  static constexpr std::uint32_t kRoom = kPart + 2 * kBefore + kBehindDesk;

  /// Where codes part most, of each place and those kLeafSlack before it; the later one of equals.
  void find_cuts(const Treelet& t) {
    const Tag d;
    jump_[0] = 0;
    for (std::uint32_t i = 1; i < t.triangle_count; i += kLanes) {
      const auto jump = hn::Xor(hn::LoadU(d, t.code + i - 1), hn::LoadU(d, t.code + i));
      hn::StoreU(jump, d, jump_ + i);
    }
    const auto numbers = hn::Iota(d, 0);
    for (std::uint32_t i = kLeafSlack; i < t.triangle_count; i += kLanes) {
      auto best = hn::Add(hn::Set(d, i), numbers), highest = hn::LoadU(d, jump_ + i);
      auto end = best;
      for (std::uint32_t slack = 1; slack <= kLeafSlack; ++slack) {
        const auto jump = hn::LoadU(d, jump_ + i - slack);
        end = hn::Sub(end, hn::Set(d, 1u));
        const auto is_higher = hn::Gt(jump, highest);
        best = hn::IfThenElse(is_higher, end, best);
        highest = hn::Max(highest, jump);
      }
      hn::StoreU(best, d, cut_ + i);
    }
  }

  /// Corners of the triangles from `first` on, and of those that a leaf may reach behind the part.
  void take_corners(const Treelet& t, std::uint32_t first) {
    const Tag d;
    const std::uint32_t wanted = kPart + kBefore, there = t.triangle_count - first;
    const std::uint32_t end = wanted < there ? wanted : there;
    for (std::uint32_t i = 0; i < end; i += kLanes) {
      Indices corner[3], nothing;
      hn::LoadInterleaved4(d, t.corner[first + i], corner[0], corner[1], corner[2], nothing);
      for (int k = 0; k < 3; ++k) hn::StoreU(corner[k], d, corner_[k] + kBefore + i);
    }
  }

  /// new_[i]: for n = 1…7 in three bits each which corners of i are in none of the n before it.
  void find_new_corners(std::uint32_t count) {
    const Tag d;
    for (std::uint32_t i = kBefore; i < kBefore + count; i += kLanes) {
      Indices corner[3],
          fresh[3] = {hn::Set(d, 1u << 18), hn::Set(d, 2u << 18), hn::Set(d, 4u << 18)};
      for (int k = 0; k < 3; ++k) corner[k] = hn::LoadU(d, corner_[k] + i);
      auto packed = hn::Zero(d);
      for (std::uint32_t n = 1; n < kClusterTriangles; ++n) {
        for (int other = 0; other < 3; ++other) {
          const auto before = hn::LoadU(d, corner_[other] + i - n);
          for (int k = 0; k < 3; ++k) {
            fresh[k] = hn::IfThenZeroElse(hn::Eq(corner[k], before), fresh[k]);
          }
        }
        // The last one ends highest.
        packed = hn::Or(hn::ShiftRight<3>(packed), hn::Or(fresh[0], hn::Or(fresh[1], fresh[2])));
      }
      hn::StoreU(packed, d, new_ + i);
    }
  }

  void store_lengths(std::uint32_t count, LeafLimit limit, std::uint32_t first) {
    const Tag d;
    const auto too_many = hn::Set(d, limit.vertices + 1);
    for (std::uint32_t i = 0; i < count; i += kLanes) {
      auto vertices = hn::Set(d, 3u), fitting = hn::Set(d, 1u), firsts = hn::Set(d, 7u);
      const std::uint32_t* next = new_ + kBefore + i;
      const auto add = [&](auto fresh, auto place) {
        fresh = hn::And(fresh, hn::Set(d, 7u));
        firsts = hn::Or(firsts, hn::ShiftLeft<decltype(place)::value>(fresh));
        // The number of bits.
        vertices = hn::Add(vertices, fresh);
        vertices = hn::Sub(vertices, hn::Add(hn::ShiftRight<1>(fresh), hn::ShiftRight<2>(fresh)));
        // −1 is subtracted for each that still fits.
        fitting = hn::Sub(fitting, hn::VecFromMask(d, hn::Lt(vertices, too_many)));
      };
      const auto load = [&] { return hn::LoadU(d, ++next); };
      add(load(), std::integral_constant<int, 4>());
      add(hn::ShiftRight<3>(load()), std::integral_constant<int, 8>());
      add(hn::ShiftRight<6>(load()), std::integral_constant<int, 12>());
      add(hn::ShiftRight<9>(load()), std::integral_constant<int, 16>());
      add(hn::ShiftRight<12>(load()), std::integral_constant<int, 20>());
      add(hn::ShiftRight<15>(load()), std::integral_constant<int, 24>());
      add(hn::ShiftRight<18>(load()), std::integral_constant<int, 28>());
      hn::StoreU(hn::Min(fitting, hn::Set(d, limit.items)), d, length_ + first + i);
      hn::StoreU(firsts, d, firsts_ + first + i);
    }
  }

  std::uint32_t corner_[3][kRoom] = {};
  std::uint32_t new_[kRoom] = {};
  std::uint32_t length_[kTreeletSize + kBehindDesk];
  std::uint32_t firsts_[kTreeletSize + kBehindDesk];
  std::uint32_t jump_[kTreeletSize + kBehindDesk];
  std::uint32_t cut_[kTreeletSize + kBehindDesk];
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
