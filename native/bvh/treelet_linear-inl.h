// A treelet by Morton codes. Included once per instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

class LinearTreelet {
 public:
  LinearTreelet(const std::uint64_t* codes, LeafLimit limit, float largest_leaf, Treelet& t)
      : codes_(codes), limit_(limit), largest_leaf_(largest_leaf), t_(t) {}

  void build() {
    t_.node_count = 1;
    add(0, 0, t_.count);
    // Children stand behind their parents, so this is bottom-up.
    for (std::uint32_t i = t_.node_count; i-- > 0;) {
      BinaryNode& node = t_.nodes[i];
      if (node.info != kInnerBit) continue;
      write_node(node,
                 merge(load_box(t_.nodes[node.first].lo), load_box(t_.nodes[node.first + 1].lo)),
                 node.first, kInnerBit);
    }
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
  std::uint32_t split(std::uint32_t begin, std::uint32_t end) {
    const std::uint64_t first = codes_[begin], differ = first ^ codes_[end - 1];
    if (differ == 0) return split_equal(begin, end);
    // All codes up to the split agree with the first in that bit and all above.
    std::uint32_t low = begin, high = end - 1;
    while (high - low > 1) {
      const std::uint32_t middle = (low + high) / 2;
      const std::uint64_t d = first ^ codes_[middle];
      if ((d ^ differ) < d) {
        high = middle;
      } else {
        low = middle;
      }
    }
    return high;
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

  const std::uint64_t* codes_;
  LeafLimit limit_;
  float largest_leaf_;
  Treelet& t_;
};

void linear(const std::uint64_t* codes, LeafLimit limit, float largest_leaf, Treelet& treelet) {
  LinearTreelet(codes, limit, largest_leaf, treelet).build();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
