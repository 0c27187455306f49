// A treelet by Morton codes. Included once per instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

class LinearTreelet {
 public:
  LinearTreelet(LeafLimit limit, float largest_leaf, Treelet& t)
      : limit_(limit), largest_leaf_(largest_leaf), t_(t) {}

  void build() {
    // split() looks at a few codes behind the last.
    for (std::uint32_t i = 0; i < kCodesBehind; ++i) t_.code[t_.count + i] = kLastCode;
    t_.node_count = 1;
    add(0, 0, t_.count);
  }

 private:
  void add(std::uint32_t index, std::uint32_t begin, std::uint32_t end) {
    if (const std::uint32_t info = leaf_info(t_, begin, end, limit_); info != 0) {
      const Lanes box = box_of_run(t_, begin, end);
      if (end - begin == 1 || largest_leaf_ == 0.0f || area_of(box, 1.0f) <= largest_leaf_) {
        write_node(t_.nodes[index], box, begin, info);
        return;
      }
    }
    const std::uint32_t middle = split(begin, end);
    const std::uint32_t child = t_.node_count;
    t_.node_count += 2;
    t_.nodes[index].first = child;
    t_.nodes[index].info = kInnerBit;
    add(child, begin, middle);
    add(child + 1, middle, end);
  }

  /// Where the highest bit changes in which the codes of the range differ.
  HWY_INLINE std::uint32_t split(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t* const codes = t_.code;
    const std::uint32_t last = codes[end - 1], differ = codes[begin] ^ last;
    if (differ == 0) return split_equal(begin, end);
    // The first code on the right has that bit, and below it nothing is known.
    const auto bit = static_cast<std::uint32_t>(31 - std::countl_zero(differ));
    const std::uint32_t least = last >> bit << bit;
    std::uint32_t length = end - begin;
    while (length > kCodesBehind) {
      const std::uint32_t half = length / 2;
      begin += codes[begin + half - 1] < least ? half : 0;
      length -= half;
    }
    // What lies behind the range is not smaller: the order goes on.
    const hn::CappedTag<std::int32_t, kCodesBehind> d;
    const auto wanted = hn::Set(d, static_cast<std::int32_t>(least));
    std::size_t smaller = 0;
    for (std::size_t i = 0; i < kCodesBehind; i += hn::Lanes(d)) {
      const auto some = hn::LoadU(d, reinterpret_cast<const std::int32_t*>(codes + begin + i));
      smaller += hn::CountTrue(d, hn::Lt(some, wanted));
    }
    return begin + static_cast<std::uint32_t>(smaller);
  }

  /// Items of one cell: halves along the axis on which their centres spread most.
  std::uint32_t split_equal(std::uint32_t begin, std::uint32_t end) {
    Lanes centres = point_box(centre_of(load_box(t_.box[t_.ids[begin]].v)));
    for (std::uint32_t i = begin + 1; i < end; ++i) {
      centres = merge(centres, point_box(centre_of(load_box(t_.box[t_.ids[i]].v))));
    }
    alignas(16) float side[4];
    hn::Store(hn::Neg(hn::Add(low(centres), minus_high(centres))), Float4(), side);
    const int axis = side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    // By (centre, index), by insertion: few items, and the same order wherever it runs.
    const auto key = [&](std::uint32_t id) {
      return 0.5f * t_.box[id].v[axis] - 0.5f * t_.box[id].v[axis + 4];
    };
    partial_order(begin, middle, end, key);
    return middle;
  }

  /// Quick select: afterwards nothing before `middle` comes after anything behind it.
  template <class Key>
  void partial_order(std::uint32_t begin, std::uint32_t middle, std::uint32_t end, const Key& key) {
    std::uint32_t* ids = t_.ids;
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      const float ka = key(a), kb = key(b);
      return ka != kb ? ka < kb : a < b;
    };
    const auto target = static_cast<std::int64_t>(middle);
    auto first = static_cast<std::int64_t>(begin), last = static_cast<std::int64_t>(end) - 1;
    while (first < last) {
      const std::uint32_t pivot = ids[first + (last - first) / 2];
      std::int64_t i = first, j = last;
      while (i <= j) {
        while (before(ids[i], pivot)) ++i;
        while (before(pivot, ids[j])) --j;
        if (i > j) break;
        const std::uint32_t swapped = ids[i];
        ids[i++] = ids[j];
        ids[j--] = swapped;
      }
      // Everything up to j is before or at the pivot, everything from i on at or behind it.
      if (target <= j) {
        last = j;
      } else if (target >= i) {
        first = i;
      } else {
        return;
      }
    }
  }

  LeafLimit limit_;
  float largest_leaf_;
  Treelet& t_;
};

void linear(LeafLimit limit, float largest_leaf, Treelet& treelet) {
  LinearTreelet(limit, largest_leaf, treelet).build();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
