// A treelet by the surface-area heuristic, and what parts clusters above it. Included once per
// instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// Deepest level of a treelet that is split by area; from there on halves, ten levels at most.
constexpr std::uint32_t kTreeletMedianDepth = 28;

/// One bit of 64: different bits are different vertices.
HWY_INLINE std::uint64_t vertex_bit(std::uint32_t vertex) {
  return std::uint64_t{1} << ((vertex * 0x9E3779B1u) >> 26);
}

void store_vertex_bits(Treelet& t) {
  std::uint64_t bits[kTreeletSize];
  for (std::uint32_t i = 0; i < t.triangle_count; ++i) {
    const std::uint32_t* const corner = t.corner[i];
    bits[i] = vertex_bit(corner[0]) | vertex_bit(corner[1]) | vertex_bit(corner[2]);
  }
  for (std::uint32_t i = 0; i < t.count; ++i) {
    const std::uint32_t first = t.start[i], last = first + t.triangles[i] - 1;
    const std::uint32_t second = first + 1 < last ? first + 1 : last;
    const std::uint32_t third = first + 2 < last ? first + 2 : last;
    t.vertex_bits[i] = bits[first] | bits[second] | bits[third] | bits[last];
    t.ids[i] = i;
  }
}

class SahTreelet {
 public:
  SahTreelet(LeafLimit limit, float scale, Treelet& t)
      : limit_(limit), scale_(scale), t_(t), list_{t} {}

  void build() {
    for (std::uint32_t i = 0; i < t_.count; ++i) {
      const Lanes box = strip_box(t_, i);
      store_box(box, t_.box[i].v);
      hn::Store(centre_and_side_of(box), Float4(), t_.centre[i]);
      // The last bits of the side are of no account, and so near the centre.
      const std::uint32_t side = std::bit_cast<std::uint32_t>(t_.centre[i][3]);
      t_.centre[i][3] = std::bit_cast<float>((side & ~3u) | (t_.triangles[i] - 1));
    }
    store_vertex_bits(t_);
    t_.node_count = 1;
    add(0, 0, measure_range(list_, 0, t_.count));
  }

 private:
  void add(std::uint32_t index, std::uint32_t depth, const Range& range) {
    const std::uint32_t count = range.end - range.begin;
    if (const std::uint32_t info = leaf_info(t_, range.begin, range.end, range.triangles, limit_);
        info != 0) {
      write_node(t_.nodes[index], box_of_run(t_, range.begin, range.end), range.begin, info);
      return;
    }
    Range left, right;
    if (depth >= kTreeletMedianDepth) {
      split_in_halves(list_, range, &left, &right);
    } else if (count <= kFewItems) {
      split_few(t_, scale_, range, &left, &right);
    } else {
      split_range(list_, scale_, range, &left, &right);
    }
    const std::uint32_t child = t_.node_count;
    t_.node_count += 2;
    t_.nodes[index].first = child;
    t_.nodes[index].info = kInnerBit;
    add(child, depth + 1, left);
    add(child + 1, depth + 1, right);
  }

  LeafLimit limit_;
  float scale_;
  Treelet& t_;
  ItemList list_;
};

ClusterList list_of(const Clusters& clusters) {
  return {clusters.cluster, clusters.moved};
}

void store_range(const Range& range, ClusterRange* to) {
  to->begin = range.begin;
  to->end = range.end;
  to->triangles = range.triangles;
  store_box(range.centres, to->centres.v);
}

void measure(const Clusters& clusters, ClusterRange& range) {
  store_range(measure_range(list_of(clusters), range.begin, range.end), &range);
}

void split(const Clusters& clusters, float scale, bool in_halves, const ClusterRange& range,
           ClusterRange* left, ClusterRange* right) {
  const Range whole{range.begin, range.end, range.triangles, load_box(range.centres.v)};
  Range parts[2];
  if (in_halves) {
    split_in_halves(list_of(clusters), whole, &parts[0], &parts[1]);
  } else {
    split_range(list_of(clusters), scale, whole, &parts[0], &parts[1]);
  }
  store_range(parts[0], left);
  store_range(parts[1], right);
}

void bound(const Clusters& clusters, const ClusterRange& range, WideBox* box) {
  Lanes all = empty_lanes();
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    all = merge(all, node_box(clusters.cluster[i]));
  }
  store_box(all, box->v);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
