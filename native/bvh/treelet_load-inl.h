// Items onto the desk. Included once per instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// Four numbers a triangle: its vertices, and kNone.
using Corners4 = std::uint32_t[4];

/// Reads vertices as four lanes; the last one has no float behind it that could be read.
class VertexReader {
 public:
  explicit VertexReader(const Items& items) : items_(items), last_(0) {
    if (items.vtx2xyz.size() < 3) return;
    last_ = static_cast<std::uint32_t>(items.vtx2xyz.size() / 3 - 1);
    for (std::size_t k = 0; k < 3; ++k) tail_[k] = items.vtx2xyz[3 * std::size_t{last_} + k];
  }
  /// x, y, z and anything.
  HWY_INLINE Vector4 operator()(std::uint32_t vertex) const {
    return hn::LoadU(Float4(), vertex == last_ ? tail_ : at(vertex));
  }
  std::uint32_t last() const { return last_; }
  /// The same of one that is not the last.
  HWY_INLINE Vector4 inner(std::uint32_t vertex) const { return hn::LoadU(Float4(), at(vertex)); }

 private:
  HWY_INLINE const float* at(std::uint32_t vertex) const {
    return items_.vtx2xyz.data() + 3 * std::size_t{vertex};
  }

  const Items& items_;
  std::uint32_t last_;
  float tail_[4] = {};
};

/// From `lo` to `hi`, padded as triangle_bounds does it. The fourth lanes are not looked at.
HWY_INLINE Lanes padded_box(Vector4 low_corner, Vector4 high_corner) {
  const auto lo = three_lanes(low_corner), minus_hi = three_lanes(hn::Neg(high_corner));
  const auto size = hn::Max(hn::Abs(lo), hn::Abs(minus_hi));
  const auto most = hn::Max(size, hn::Max(hn::Shuffle0321(size), hn::Shuffle1032(size)));
  const float padding = hn::GetLane(most) * kPadding;
  const auto by = three_lanes(hn::Set(Float4(), padding));
  return make_box(hn::Sub(lo, by), hn::Sub(minus_hi, by));
}

/// The padded box of a triangle, to the bit that of triangle_bounds.
HWY_INLINE Lanes triangle_box(Vector4 a, Vector4 b, Vector4 c) {
  return padded_box(hn::Min(hn::Min(a, b), c), hn::Max(hn::Max(a, b), c));
}

/// Strips lie anywhere in the mesh's arrays: their indices are asked for first, then vertices.
constexpr std::uint32_t kIndicesAhead = 32, kVerticesAhead = 16;
static_assert(kIndicesAhead <= kFetchedAhead);

/// Every strip's triangles, four for each, as the next strip's take the place of what is too much:
/// how many a strip has cannot be predicted.
template <bool kWithCodes>
void list_triangles(const KeyIndex<std::uint32_t>* strips, std::uint32_t count, Treelet& t) {
  const hn::FixedTag<std::uint32_t, kMostInStrip> d;
  const auto following = hn::Iota(d, 0);
  std::uint32_t at = 0, begin = 0, items = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t key = strips[i].key, strip = strips[i].index;
    hn::StoreU(hn::Add(hn::Set(d, strip_first(strip)), following), d, t.primitive + at);
    if (kWithCodes) hn::StoreU(hn::Set(d, key), d, t.code + at);
    const bool is_new = kWithCodes || key == 0;
    items += is_new ? 1 : 0;
    begin = is_new ? at : begin;
    at += strip_count(strip);
    t.start[items - 1] = begin;
    t.triangles[items - 1] = at - begin;
  }
  t.count = items;
  t.triangle_count = at;
  std::fill_n(t.primitive + at, kFetchedAhead, t.primitive[at - 1]);
}

/// The box of an instance.
HWY_INLINE Lanes instance_box(const Aabb& box) {
  alignas(16) float lo[4] = {box.lo.x, box.lo.y, box.lo.z, 0.0f};
  alignas(16) float minus_hi[4] = {-box.hi.x, -box.hi.y, -box.hi.z, 0.0f};
  return make_box(hn::Load(Float4(), lo), hn::Load(Float4(), minus_hi));
}

/// To the second cache: what a whole treelet reads has no place in the first.
template <class T>
HWY_INLINE void fetch_near(const T* at) {
#if defined(__GNUC__)
  __builtin_prefetch(at, 0, 2);
#else
  hwy::Prefetch(at);
#endif
}

/// Calls body(i, corner) for the desk's triangles, having asked for what it reads.
template <class Body>
HWY_INLINE void for_each_triangle(const Items& items, const Treelet& t, const Body& body) {
  const auto corners = [&](std::uint32_t i) {
    return &items.tri2vtx[3 * std::size_t{t.primitive[i]}];
  };
  for (std::uint32_t i = 0; i < t.triangle_count; ++i) {
    hwy::Prefetch(corners(i + kIndicesAhead));
    const std::uint32_t* const later = corners(i + kVerticesAhead);
    for (int k = 0; k < 3; ++k) fetch_near(&items.vtx2xyz[3 * std::size_t{later[k]}]);
    body(i, corners(i));
  }
}

HWY_INLINE void put_corners(const std::uint32_t* corner, std::uint32_t i, Treelet& t) {
  for (int k = 0; k < 3; ++k) t.corner[i][k] = corner[k];
  t.corner[i][3] = kNone;
}

/// The boxes of all triangles, and corners too if wanted.
template <bool kWithCorners>
void load_boxes(const Items& items, Treelet& t) {
  if (!items.are_triangles()) {
    for (std::uint32_t i = 0; i < t.count; ++i) {
      store_box(instance_box(items.boxes[t.primitive[i]]), t.triangle_box[i].v);
    }
    return;
  }
  const VertexReader vertex(items);
  for_each_triangle(items, t, [&](std::uint32_t i, const std::uint32_t* corner) {
    if (kWithCorners) put_corners(corner, i, t);
    store_box(triangle_box(vertex(corner[0]), vertex(corner[1]), vertex(corner[2])),
              t.triangle_box[i].v);
  });
}

void load(const Items& items, const KeyIndex<std::uint32_t>* strips, std::uint32_t count,
          Treelet& t) {
  list_triangles<false>(strips, count, t);
  load_boxes<true>(items, t);
}

/// Four triangles of the mesh, each with kNone behind its corners.
HWY_INLINE void put_four(const std::uint32_t* corner, Corners4* to) {
  const hn::FixedTag<std::uint32_t, 4> d;
  alignas(16) static constexpr std::uint32_t kFourth[4] = {0, 0, 0, kNone};
  const auto fourth = hn::Load(d, kFourth);
  for (int k = 0; k < 4; ++k) hn::Store(hn::Or(hn::LoadU(d, corner + 3 * k), fourth), d, to[k]);
}

/// Each strip has four triangles, of which the next strip's take the place of what is too much:
/// how many it has cannot be predicted.
void load_corners(const Items& items, const KeyIndex<std::uint32_t>* strips, std::uint32_t count,
                  Treelet& t) {
  if (!items.are_triangles()) return list_triangles<true>(strips, count, t);
  const hn::FixedTag<std::uint32_t, kMostInStrip> d;
  const auto following = hn::Iota(d, 0);
  const std::uint32_t* const corners = items.tri2vtx.data();
  const float* const vertices = items.vtx2xyz.data();
  const std::size_t triangles = items.count();
  const auto strip_later = [&](std::uint32_t i) { return strips[i < count ? i : count - 1].index; };
  const auto corners_of = [&](std::uint32_t triangle) {
    return corners + 3 * std::size_t{triangle};
  };
  std::uint32_t at = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t* const far = corners_of(strip_first(strip_later(i + kIndicesAhead)));
    hwy::Prefetch(far);
    hwy::Prefetch(far + 3 * kMostInStrip);
    const std::uint32_t near = strip_later(i + kVerticesAhead);
    const std::uint32_t* const next = corners_of(strip_first(near));
    for (int k = 0; k < 3; ++k) fetch_near(vertices + 3 * std::size_t{next[k]});
    const std::uint32_t* const last = next + 3 * (near >> kStripShift);
    for (int k = 0; k < 3; ++k) fetch_near(vertices + 3 * std::size_t{last[k]});

    const std::uint32_t strip = strips[i].index, first = strip_first(strip);
    hn::StoreU(hn::Add(hn::Set(d, first), following), d, t.primitive + at);
    hn::StoreU(hn::Set(d, strips[i].key), d, t.code + at);
    // One number is read behind the last corner.
    if (HWY_LIKELY(first + kMostInStrip < triangles)) {
      put_four(corners_of(first), t.corner + at);
    } else {
      std::uint32_t end[3 * kMostInStrip + 1] = {};
      std::copy_n(corners_of(first), 3 * strip_count(strip), end);
      put_four(end, t.corner + at);
    }
    at += strip_count(strip);
  }
  t.triangle_count = at;
}

/// Two neighbours become one item if the area of the common box is at most that of the larger one
/// and this share of the smaller one's…
constexpr float kOfSmaller = 0.3f;
/// …and this share of a square over all items: single walls decide what planes cost.
constexpr float kLargestStrip = 1e-3f;

/// The box of up to four triangles.
HWY_INLINE Lanes strip_box(const Treelet& t, std::uint32_t item) {
  const std::uint32_t first = t.start[item], last = first + t.triangles[item] - 1;
  Lanes box = merge(load_box(t.triangle_box[first].v), load_box(t.triangle_box[last].v));
  for (std::uint32_t k = 1; k + 1 < kMostInStrip; ++k) {
    const std::uint32_t at = first + k < last ? first + k : last;
    box = merge(box, load_box(t.triangle_box[at].v));
  }
  return box;
}

/// Clusters have so many items at most: the top tree's planes cut between them.
constexpr std::uint32_t kClusterItems = 4;

/// Bit i of `joined`: strip i is one item with that before it.
void join_strips(const Treelet& t, float scale, std::uint8_t* joined) {
  Lanes last = load_box(t.box[0].v);
  float last_area = area_of(last, scale);
  joined[0] = 0;
  for (std::uint32_t i = 1; i < t.count; ++i) {
    const Lanes box = load_box(t.box[i].v);
    const float area = area_of(box, scale), both = area_of(merge(box, last), scale);
    const float most = max_of(area, last_area) + kOfSmaller * min_of(area, last_area);
    // Two of two triangles have eight vertices at most. (No &&: nobody could predict it.)
    const bool may = (both <= most) & (both <= kLargestStrip) & (t.triangles[i] <= 2) &
                     (t.triangles[i - 1] <= 2);
    joined[i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(may) & ~joined[i - 1]);
    last = box;
    last_area = area;
  }
}

std::uint32_t cluster(const Items& items, const KeyIndex<std::uint32_t>* strips,
                      std::uint32_t count, const ClusterLimits& limits, std::uint32_t first,
                      Treelet& t, BinaryNode* clusters) {
  list_triangles<true>(strips, count, t);
  load_boxes<false>(items, t);
  for (std::uint32_t i = 0; i < t.count; ++i) store_box(strip_box(t, i), t.box[i].v);
  std::uint8_t joined[kRunSize + kClusterItems] = {};
  if (items.are_triangles()) join_strips(t, limits.scale, joined);
  std::uint32_t made = 0;
  for (std::uint32_t begin = 0; begin < t.count;) {
    const std::uint32_t rest = t.count - begin;
    std::uint32_t length = rest < kClusterItems ? rest : kClusterItems;
    if (rest > kClusterItems) {
      // Where the codes part most: between the last triangles and the first ones of items.
      std::uint32_t highest = 0;
      for (std::uint32_t k = kClusterItems; k >= 1; --k) {
        const std::uint32_t next = t.start[begin + k], jump = t.code[next - 1] ^ t.code[next];
        length = jump > highest ? k : length;
        highest = jump > highest ? jump : highest;
      }
    }
    Lanes box = load_box(t.box[begin].v);
    for (std::uint32_t k = 1; k < kClusterItems; ++k) {
      box = merge(box, load_box(t.box[begin + (k < length ? k : length - 1)].v));
    }
    const std::uint32_t end = begin + length;
    const auto put = [&](std::uint32_t from, std::uint32_t to, Lanes its) {
      const std::uint32_t triangles = t.start[to - 1] + t.triangles[to - 1] - t.start[from];
      const std::uint32_t with_last =
          joined[from + 1] * 2u + joined[from + 2] * 4u + joined[from + 3] * 8u;
      const std::uint32_t its_own = (1u << (to - from)) - 1;
      write_node(clusters[made++], its, first + from,
                 ClusterInfo(to - from, with_last & its_own, triangles).packed());
    };
    if (area_of(box, 1.0f) <= limits.largest_area) {
      put(begin, end, box);
    } else {
      for (std::uint32_t i = begin; i < end; ++i) put(i, i + 1, load_box(t.box[i].v));
    }
    begin = end;
  }
  return made;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
