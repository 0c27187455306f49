// Wide nodes and leaves out of a planned binary tree. Included once per instruction set (no include
// guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// is_coarse (bvh/wide_plan.h) in lanes.
class CoarseNodes {
 public:
  explicit HWY_INLINE CoarseNodes(Vector4 step)
      : growth_(make_box(hn::Zero(Float4()), hn::Neg(hn::Add(step, step)))) {}
  /// In a wide node that stands for `node`.
  static HWY_INLINE CoarseNodes within(const BinaryNode& node) {
    const Lanes box = node_box(node);
    const auto sides = hn::Neg(hn::Add(low(box), minus_high(box)));
    return CoarseNodes(hn::Div(sides, hn::Set(Float4(), 255.0f)));
  }
  HWY_INLINE bool operator()(const BinaryNode& node) const {
    const Lanes box = node_box(node);
    return area_of(sum(box, growth_), 1.0f) > 1.25f * area_of(box, 1.0f);
  }

 private:
  Lanes growth_;
};

/// Areas, whose order is that of their bits; the lowest tell equal ones apart.
HWY_INLINE std::int32_t area_key(float area, std::uint32_t inner, int index) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(area), last_bits = kPlanWidth - 1;
  return static_cast<std::int32_t>(((bits | inner) & ~last_bits) |
                                   static_cast<std::uint32_t>(index));
}

/// Where each key stands when they are sorted.
HWY_INLINE void store_places(const std::int32_t* key, std::uint32_t* place) {
  const hn::CappedTag<std::int32_t, kPlanWidth> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (std::size_t first = 0; first < kPlanWidth; first += hn::Lanes(d)) {
    const auto keys = hn::Load(d, key + first);
    auto places = hn::Zero(d);
    for (int k = 0; k < kPlanWidth; ++k) {
      places = hn::Sub(places, hn::VecFromMask(d, hn::Lt(hn::Set(d, key[k]), keys)));
    }
    hn::StoreU(hn::BitCast(du, places), du, place + first);
  }
}

struct PlannedChildren {
  int count, inner;
};

/// The children of the wide node that stands for `node`, which is inner, in ChildOrder
/// (bvh/wide_plan.h): inner ones first, of either kind the larger ones last.
HWY_INLINE PlannedChildren planned_children(const BinaryNode* nodes, std::uint32_t node,
                                            std::uint32_t* children) {
  const CoarseNodes is_coarse = CoarseNodes::within(nodes[node]);
  OpenNodes open(nodes);
  open.push_wide(node);
  PlannedChildren planned{0, 0};
  std::uint32_t all[kPlanWidth];
  alignas(32) std::int32_t key[kPlanWidth];
  std::uint32_t place[kPlanWidth];
  for (std::int32_t& k : key) k = std::numeric_limits<std::int32_t>::max();
  std::uint32_t next = 0;
  int room = 0, size = 0;
  while (open.next(&next, &room, &size)) {
    const BinaryNode& child = nodes[next];
    if (size > 1 && !is_coarse(child)) {
      open.push_children(next, size);
      continue;
    }
    all[planned.count] = next;
    key[planned.count] =
        area_key(area_of(node_box(child), 1.0f), child.is_leaf() ? 0 : kInnerBit, planned.count);
    planned.inner += child.is_leaf() ? 0 : 1;
    ++planned.count;
  }
  store_places(key, place);
  for (int i = 0; i < planned.count; ++i) children[place[i]] = all[i];
  return planned;
}

/// What a leaf holds: primitives, and their corners as LeafCorners wants them.
struct LeafItems {
  alignas(64) Corners4 corner[kClusterTriangles];
  std::uint32_t firsts;
  std::uint32_t primitive[kClusterTriangles];
};

/// Leaves of a treelet.
struct TreeletLeaves {
  const Treelet& t;
  const bool have_corners;
  HWY_INLINE void get(const BinaryNode& leaf, LeafItems& to) const {
    to.firsts = t.moved[leaf.first];
    for_each_of_leaf(t, leaf.first, leaf.leaf_count(), [&](std::uint32_t i, std::uint32_t k) {
      to.primitive[k] = t.primitive[i];
      if (have_corners) copy_corners(t.corner[i], to.corner[k]);
    });
  }
};

/// Leaves of a whole tree.
struct TreeLeaves {
  const Items& items;
  const std::uint32_t* order;
  void get(const BinaryNode& leaf, LeafItems& to) const {
    for (std::uint32_t i = 0; i < leaf.leaf_count(); ++i) {
      to.primitive[i] = order[leaf.first + i];
      if (!items.are_triangles()) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        to.corner[i][k] = items.tri2vtx[3 * std::size_t{to.primitive[i]} + k];
      }
      to.corner[i][3] = kNone;
    }
    if (items.are_triangles()) to.firsts = LeafCorners(to.corner).firsts(leaf.leaf_count());
  }
};

template <class Leaves>
class Emitter {
 public:
  Emitter(const Items& items, const BinaryNode* nodes, Leaves& leaves, WideTreelet& to)
      : items_(items), vertex_(items), nodes_(nodes), leaves_(leaves), to_(to) {}

  /// Nodes go to to.root_nodes and behind, leaves to to.root_leaves and behind.
  void emit() {
    std::uint32_t roots[kPlanWidth];
    OpenNodes open(nodes_);
    open.push(0, static_cast<int>(to_.room));
    int room = 0;
    to_.root_count = to_.node_count = to_.leaf_units = to_.depth = 0;
    std::uint32_t inner = 0;
    to_.leaves = to_.root_leaves;
    while (open.pop(to_.step, &roots[to_.root_count], &room)) {
      const BinaryNode& root = nodes_[roots[to_.root_count]];
      to_.root[to_.root_count++] = root;
      if (root.is_leaf()) {
        emit_leaf(root);
      } else {
        ++inner;
      }
    }
    to_.leaves += to_.leaf_units * items_.leaf_unit();
    to_.leaf_units = 0;
    to_.nodes = to_.root_nodes + inner;
    WideNode* next = to_.root_nodes;
    for (std::uint32_t i = 0; i < to_.root_count; ++i) {
      if (!to_.root[i].is_leaf()) emit_node(roots[i], 1, *next++);
    }
  }

 private:
  /// Writes one wide node, and all that is below it.
  void emit_node(std::uint32_t binary, std::uint32_t level, WideNode& wide) {
    std::uint32_t children[kWidth];
    const PlannedChildren planned = planned_children(nodes_, binary, children);
    wide.counts = static_cast<std::uint8_t>(planned.inner | planned.count << 4);
    wide.first_child = to_.node_count;
    wide.first_leaf = to_.leaf_units;
    std::memset(wide.leaf, 0, sizeof(wide.leaf));
    quantise_children(nodes_, children, planned.count, wide);
    for (int i = planned.inner; i < planned.count; ++i) {
      wide.leaf[i] = static_cast<std::uint8_t>(to_.leaf_units - wide.first_leaf);
      emit_leaf(nodes_[children[i]]);
    }
    to_.depth = level > to_.depth ? level : to_.depth;
    const std::uint32_t first = to_.node_count;
    to_.node_count += static_cast<std::uint32_t>(planned.inner);
    for (int i = 0; i < planned.inner; ++i) {
      emit_node(children[i], level + 1, to_.nodes[first + static_cast<std::uint32_t>(i)]);
    }
  }

  HWY_INLINE void emit_leaf(const BinaryNode& leaf) {
    LeafItems its;
    leaves_.get(leaf, its);
    std::byte* const record = to_.leaves + to_.leaf_units * items_.leaf_unit();
    if (items_.are_triangles()) {
      write_cluster(vertex_, leaf.leaf_count(), its.corner, its.firsts, its.primitive, record);
    } else {
      std::memcpy(record, its.primitive, sizeof(its.primitive[0]));
    }
    to_.leaf_units += items_.leaf_units(leaf.leaf_count(), leaf.leaf_vertices());
  }

  const Items& items_;
  const VertexReader vertex_;
  const BinaryNode* nodes_;
  Leaves& leaves_;
  WideTreelet& to_;
};

void sah_treelet(const Items& items, float scale, Treelet& t, WideTreelet& to) {
  SahTreelet(items.leaf, scale, t).build();
  plan(scale, t);
  TreeletLeaves leaves{t, items.are_triangles()};
  Emitter<TreeletLeaves>(items, t.nodes, leaves, to).emit();
  to.cost = t.cost[0].at[to.room - 1];
}

void emit_tree(const Items& items, const BinaryTree& tree, WideTreelet& to) {
  TreeLeaves leaves{items, tree.order.data()};
  Emitter<TreeLeaves>(items, tree.nodes.data(), leaves, to).emit();
  to.cost = 0.0f;  // nobody asks for it: nothing is above
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
