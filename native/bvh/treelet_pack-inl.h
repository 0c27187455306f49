// A linear treelet: leaves and wide nodes are runs of the Morton order, one level over the other
// (as in Kamel, Faloutsos 1993, "On Packing R-trees"), without a binary tree. Included once per
// instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// What a node costs the levels above it, in mean areas of what it is made of. With two or five
/// trees cost within 2 % as much.
constexpr float kNodePrice = 3.0f;

class PackedTreelet {
 public:
  PackedTreelet(const Items& items, float scale, Treelet& t, WideTreelet& to)
      : items_(items), vertex_(items), scale_(scale), t_(t), to_(to) {}

  void build() {
    to_.root_count = 1;
    to_.node_count = to_.leaf_units = to_.depth = 0;
    to_.leaves = to_.root_leaves;
    to_.cost = 0.0f;
    std::uint32_t count = make_leaves();
    if (count == 1) {
      to_.cost = area_of(node_box(t_.nodes[0]), scale_) * kLeafCost;
      place_leaf(t_.nodes[0]);
      to_.leaves += to_.leaf_units * items_.leaf_unit();
      to_.leaf_units = 0;
      to_.nodes = to_.root_nodes;
    } else {
      to_.nodes = to_.root_nodes + 1;
      for (bool alone = true; count > 1; ++to_.depth) {
        const std::uint32_t before = count;
        count = make_nodes(count, alone && count > kWidth);
        alone = 3 * count < 2 * before;  // or it could go on for ever
      }
      to_.root_nodes[0] = t_.staged[t_.nodes[0].first];
    }
    to_.root[0] = t_.nodes[0];
  }

 private:
  /// Leaves as t_.nodes, `first` being the unit of t_.staged_leaves in which the record begins.
  /// Returns how many.
  std::uint32_t make_leaves() {
    const LeafLengths length(t_, items_.leaf);
    const std::uint32_t count = t_.triangle_count;
    std::uint32_t leaves = 0, unit = 0;
    for (std::uint32_t begin = 0; begin < count;) {
      const std::uint32_t most = length[begin];
      const std::uint32_t end = begin + most < count ? length.cut(begin, most) : count;
      const WrittenLeaf leaf = write_leaf(begin, end - begin, length.firsts(begin),
                                          t_.staged_leaves + unit * items_.leaf_unit());
      write_node(t_.nodes[leaves++], leaf.box, unit, leaf.info);
      unit += items_.leaf_units(leaf.info & 255u, leaf.info >> 8);
      begin = end;
    }
    return leaves;
  }

  HWY_INLINE WrittenLeaf write_leaf(std::uint32_t begin, std::uint32_t count, std::uint32_t firsts,
                                    std::byte* record) {
    const std::uint32_t* const primitives = &t_.primitive[begin];
    if (items_.are_triangles()) {
      return write_cluster(vertex_, count, &t_.corner[begin], firsts, primitives, record);
    }
    std::memcpy(record, primitives, sizeof(std::uint32_t));
    return {1, instance_box(items_.boxes[*primitives])};
  }

  /// Wide nodes over the first `count` of t_.nodes, and in their place in it. Returns how many.
  std::uint32_t make_nodes(std::uint32_t count, bool alone) {
    cuts_.find(t_.nodes, count, kNodePrice, scale_, alone);
    if (to_.depth == 0) to_.cost = cuts_.sum_of_areas() * kLeafCost;
    std::uint32_t begin = 0;
    for (std::uint32_t i = 0; i < cuts_.count(); ++i) {
      const std::uint32_t end = cuts_.end(i);
      // It is read before it is overwritten: i ≤ begin.
      if (end - begin == 1) {
        t_.nodes[i] = t_.nodes[begin];
      } else {
        make_node(begin, end, t_.nodes[i]);
      }
      begin = end;
    }
    return cuts_.count();
  }

  HWY_INLINE void make_node(std::uint32_t begin, std::uint32_t end, BinaryNode& to) {
    const int count = static_cast<int>(end - begin);
    alignas(32) std::int32_t key[kPlanWidth];
    std::uint32_t place[kPlanWidth], child[kPlanWidth];
    int inner = 0;
    Lanes box = node_box(t_.nodes[begin]);
    for (int i = 0; i < kPlanWidth; ++i) {
      const std::uint32_t at = begin + static_cast<std::uint32_t>(i < count ? i : count - 1);
      const BinaryNode& node = t_.nodes[at];
      box = merge(box, node_box(node));
      const std::uint32_t inner_bit = node.info & kInnerBit;
      inner += i < count && inner_bit != 0 ? 1 : 0;
      key[i] = i < count ? area_key(cuts_.area(at), inner_bit, i)
                         : std::numeric_limits<std::int32_t>::max();
    }
    store_places(key, place);
    for (int i = 0; i < count; ++i) child[place[i]] = begin + static_cast<std::uint32_t>(i);

    WideNode& wide = t_.staged[staged_];
    wide.counts = static_cast<std::uint8_t>(inner | count << 4);
    wide.first_child = to_.node_count;
    wide.first_leaf = to_.leaf_units;
    std::memset(wide.leaf, 0, sizeof(wide.leaf));
    quantise_children(t_.nodes, child, count, wide);
    for (int i = 0; i < inner; ++i) {
      to_.nodes[to_.node_count++] = t_.staged[t_.nodes[child[i]].first];
    }
    for (int i = inner; i < count; ++i) {
      wide.leaf[i] = static_cast<std::uint8_t>(to_.leaf_units - wide.first_leaf);
      place_leaf(t_.nodes[child[i]]);
    }
    to_.cost += cuts_.area_of_run(end - 1) * kNodeCost;
    write_node(to, box, staged_++, kInnerBit);
  }

  HWY_INLINE void place_leaf(const BinaryNode& leaf) {
    // What is too much the next one overwrites.
    const hn::CappedTag<std::uint8_t, 64> d;
    const auto* const from =
        reinterpret_cast<const std::uint8_t*>(t_.staged_leaves + leaf.first * items_.leaf_unit());
    auto* const to =
        reinterpret_cast<std::uint8_t*>(to_.leaves + to_.leaf_units * items_.leaf_unit());
    for (std::size_t i = 0; i < kLeafCopied; i += hn::Lanes(d)) {
      hn::StoreU(hn::LoadU(d, from + i), d, to + i);
    }
    to_.leaf_units += items_.leaf_units(leaf.leaf_count(), leaf.leaf_vertices());
  }

  const Items& items_;
  const VertexReader vertex_;
  float scale_;
  Treelet& t_;
  WideTreelet& to_;
  RunCuts cuts_;
  std::uint32_t staged_ = 0;
};

void pack_treelet(const Items& items, float scale, Treelet& t, WideTreelet& to) {
  PackedTreelet(items, scale, t, to).build();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
