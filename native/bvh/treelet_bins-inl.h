// Splits by the surface-area heuristic, binned (Wald 2007), of items on the desk and of clusters.
// Included once per instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// Items of a treelet in the order of `ids`. What parts a range asks for box, centre and weight of
/// the item at a position, and writes every item to both sides (see split_range).
struct ItemList {
  Treelet& t;
  HWY_INLINE std::uint32_t at(std::uint32_t i) const { return t.ids[i]; }
  HWY_INLINE Lanes box(std::uint32_t id) const { return load_box(t.box[id].v); }
  HWY_INLINE Vector4 centre(std::uint32_t id) const { return hn::Load(Float4(), t.centre[id]); }
  HWY_INLINE std::uint32_t weight(std::uint32_t id) const {
    return (std::bit_cast<std::uint32_t>(t.centre[id][3]) & 3u) + 1;
  }
  HWY_INLINE void put(std::uint32_t id, std::uint32_t left, std::uint32_t right) const {
    t.ids[left] = id;
    t.moved[right] = id;
  }
  HWY_INLINE void bring_back(std::uint32_t from, std::uint32_t to) const {
    t.ids[to] = t.moved[from];
  }
};

/// Clusters, which move themselves: there are too many for a cache, and so each is read where the
/// one before it was.
struct ClusterList {
  BinaryNode* cluster;
  BinaryNode* moved;
  HWY_INLINE const BinaryNode& at(std::uint32_t i) const { return cluster[i]; }
  HWY_INLINE Lanes box(const BinaryNode& it) const { return node_box(it); }
  HWY_INLINE Vector4 centre(const BinaryNode& it) const { return centre_and_side_of(node_box(it)); }
  HWY_INLINE std::uint32_t weight(const BinaryNode& it) const {
    return ClusterInfo(it.info).triangles;
  }
  HWY_INLINE void put(const BinaryNode& it, std::uint32_t left, std::uint32_t right) const {
    const Lanes all = load_box(it.lo);
    store_box(all, cluster[left].lo);
    store_box(all, moved[right].lo);
  }
  HWY_INLINE void bring_back(std::uint32_t from, std::uint32_t to) const {
    cluster[to] = moved[from];
  }
};

struct Range {
  std::uint32_t begin, end;
  std::uint32_t triangles;
  Lanes centres;  ///< their bounds; lane 3 of the low corner: minus the longest side of a box
};

template <class List>
Range measure_range(const List& list, std::uint32_t begin, std::uint32_t end) {
  Range range{begin, end, 0, empty_lanes()};
  for (std::uint32_t i = begin; i < end; ++i) {
    range.centres = merge(range.centres, point_box(list.centre(list.at(i))));
    range.triangles += list.weight(list.at(i));
  }
  return range;
}

/// Halves by position: what is left where no plane parts the centres.
template <class List>
void split_in_halves(const List& list, const Range& range, Range* left, Range* right) {
  const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
  *left = measure_range(list, range.begin, middle);
  *right = measure_range(list, middle, range.end);
}

constexpr int kBinBits = 6, kMostBins = 1 << kBinBits;
/// Keeps the last centre in the last bin.
constexpr float kInside = 0.9999f / kMostBins;

struct Bins {
  alignas(32) float box[3][kMostBins][8];
  std::uint32_t items[3][kMostBins];
};

struct Plane {
  int axis = -1;
  std::uint32_t bin = 0;  ///< first bin on the right
};

/// Counted with the items of a side: what a leaf costs beside what is in it.
constexpr float kLeafItems = 4.0f;

/// The cheapest plane between bins: area × (items + kLeafItems) on both sides.
HWY_INLINE Plane cheapest_plane(const Bins& bins, const float* side, int count, float scale) {
  Plane plane;
  float best = kFloatMax;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(side[axis] > 0.0f)) continue;
    float right_cost[kMostBins];
    Lanes right = empty_lanes();
    std::uint32_t items = 0;
    for (int k = count - 1; k > 0; --k) {
      right = merge(right, load_box(bins.box[axis][k]));
      items += bins.items[axis][k];
      right_cost[k] =
          items > 0 ? area_of(right, scale) * (static_cast<float>(items) + kLeafItems) : kFloatMax;
    }
    Lanes left = empty_lanes();
    items = 0;
    for (int k = 1; k < count; ++k) {
      left = merge(left, load_box(bins.box[axis][k - 1]));
      items += bins.items[axis][k - 1];
      if (items == 0) continue;
      const float cost =
          area_of(left, scale) * (static_cast<float>(items) + kLeafItems) + right_cost[k];
      if (cost < best) {
        best = cost;
        plane.axis = axis;
        plane.bin = static_cast<std::uint32_t>(k);
      }
    }
  }
  return plane;
}

HWY_INLINE int bin_count(std::uint32_t length) {
  return length > 1024 ? kMostBins : length > 512 ? kMostBins / 2 : length > 32 ? 16 : 8;
}

/// Of longer ranges so many items choose the plane, evenly spread along the list…
constexpr std::uint32_t kMostSamples = 1024;
/// …if none is longer than this share of the range. A few walls among small things decide what a
/// plane costs, and a sample misses them.
constexpr float kLargestSampled = 1.0f / 16.0f;

template <class List>
HWY_INLINE void split_range(const List& list, float scale, const Range& range, Range* left,
                            Range* right) {
  const std::uint32_t length = range.end - range.begin;
  const int count = bin_count(length);
  const auto start = low(range.centres);
  alignas(16) float side[4];
  alignas(16) float factor[4];
  hn::Store(hn::Neg(hn::Add(start, minus_high(range.centres))), Float4(), side);
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    // Sides of which the reciprocal or the product overflows do not take part.
    if (!(side[axis] > 1e-36f && side[axis] < kFloatMax)) side[axis] = 0.0f;
    factor[axis] = side[axis] > 0.0f ? static_cast<float>(count) * kInside / side[axis] : 0.0f;
    any = any || side[axis] > 0.0f;
  }
  factor[3] = 0.0f;
  if (!any) return split_in_halves(list, range, left, right);

  Bins bins;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < count; ++k) {
      store_box(empty_lanes(), bins.box[axis][k]);
      bins.items[axis][k] = 0;
    }
  }
  const auto factors = hn::Load(Float4(), factor);
  const hn::FixedTag<std::uint32_t, 4> du;
  // In [1, 2): the highest bits of the mantissa are the bin.
  const auto place_of = [&](Vector4 centre) {
    return hn::Add(hn::Mul(hn::Sub(centre, start), factors), hn::Set(Float4(), 1.0f));
  };
  const auto put_into_bins = [&](std::uint32_t i) {
    const auto& item = list.at(i);
    const Lanes box = list.box(item);
    const auto bits = hn::BitCast(du, place_of(list.centre(item)));
    const auto bin = hn::And(hn::ShiftRight<23 - kBinBits>(bits), hn::Set(du, kMostBins - 1u));
    const auto bytes = hn::U8FromU32(bin);
    std::uint32_t packed = hn::GetLane(hn::BitCast(hn::FixedTag<std::uint32_t, 1>(), bytes));
    const std::uint32_t weight = list.weight(item);
    for (int axis = 0; axis < 3; ++axis, packed >>= 8) {
      float* const sum = bins.box[axis][packed & 255u];
      store_box(merge(load_box(sum), box), sum);
      bins.items[axis][packed & 255u] += weight;
    }
  };
  // Neighbours are often in the same bins and would wait for each other: so from four places.
  const std::uint32_t part = length / 4;
  alignas(16) float corner[4];
  hn::Store(start, Float4(), corner);
  const float longest = max_of(side[0], max_of(side[1], side[2]));
  const bool all_small = -corner[3] < kLargestSampled * longest;
  const std::uint32_t step = all_small ? (length + kMostSamples - 1) / kMostSamples : 1;
  for (std::uint32_t i = 0; i < part; i += step) {
    for (std::uint32_t from = range.begin; from < range.begin + 4 * part; from += part) {
      put_into_bins(from + i);
    }
  }
  for (std::uint32_t i = range.begin + 4 * part; i < range.end; ++i) put_into_bins(i);
  const Plane plane = cheapest_plane(bins, side, count, scale);
  if (plane.axis < 0) return split_in_halves(list, range, left, right);

  // Parted without a branch that nobody could predict: every item is written to both sides.
  Lanes left_centres = empty_lanes(), right_centres = left_centres;
  const Lanes nothing = left_centres;
  std::uint32_t to_left = range.begin, to_right = range.begin, left_triangles = 0;
  const auto first_right = hn::Set(Float4(), 1.0f + static_cast<float>(plane.bin) / kMostBins);
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    const auto& item = list.at(i);
    const auto centre = list.centre(item);
    std::uint8_t right_of[8];
    hn::StoreMaskBits(Float4(), hn::Ge(place_of(centre), first_right), right_of);
    const std::uint32_t is_right = (right_of[0] >> plane.axis) & 1u;
    const Lanes point = point_box(centre);
    left_centres = merge(left_centres, choose(is_right, nothing, point));
    right_centres = merge(right_centres, choose(is_right, point, nothing));
    left_triangles += (1u - is_right) * list.weight(item);
    list.put(item, to_left, to_right);
    to_left += 1u - is_right;
    to_right += is_right;
  }
  for (std::uint32_t k = range.begin; k < to_right; ++k) {
    list.bring_back(k, to_left + k - range.begin);
  }
  *left = Range{range.begin, to_left, left_triangles, left_centres};
  *right = Range{to_left, range.end, range.triangles - left_triangles, right_centres};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
