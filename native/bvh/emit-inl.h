// Wide nodes and leaves out of a planned binary tree. Included once per instruction set (no include
// guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// One axis of a node's grid: the traversal's own arithmetic (WideNode::plane) in lanes.
struct LaneGrid {
  Vector4 origin, step;
  HWY_INLINE Vector4 at(Vector4 q) const { return hn::Add(origin, hn::Mul(q, step)); }
};

/// Four planes: the last that is not above x (`kLower`), or the first that is not below. The guess
/// is off by what rounding does, as in bvh/quantise.cpp, whose planes these are.
template <bool kLower>
HWY_INLINE void store_planes(const LaneGrid& grid, float inverse_step, const float* x,
                             std::uint8_t* to) {
  const Float4 d;
  const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d), last = hn::Set(d, 255.0f);
  const auto wanted = hn::Load(d, x);
  const auto place = hn::Mul(hn::Sub(wanted, grid.origin), hn::Set(d, inverse_step));
  auto q = hn::Floor(hn::Min(hn::Max(place, zero), last));
  while (true) {
    const auto next = kLower ? hn::Add(q, one) : hn::Sub(q, one);
    const auto fits = kLower ? hn::And(hn::Le(grid.at(next), wanted), hn::Lt(q, last))
                             : hn::And(hn::Ge(grid.at(next), wanted), hn::Gt(q, zero));
    if (hn::AllFalse(d, fits)) break;
    q = hn::IfThenElse(fits, next, q);
  }
  while (true) {
    const auto fails = kLower ? hn::And(hn::Gt(grid.at(q), wanted), hn::Gt(q, zero))
                              : hn::And(hn::Lt(grid.at(q), wanted), hn::Lt(q, last));
    if (hn::AllFalse(d, fails)) break;
    q = hn::IfThenElse(fails, kLower ? hn::Sub(q, one) : hn::Add(q, one), q);
  }
  const auto whole = hn::ConvertTo(hn::FixedTag<std::int32_t, 4>(), q);
  hn::StoreU(hn::U8FromU32(hn::BitCast(hn::FixedTag<std::uint32_t, 4>(), whole)),
             hn::FixedTag<std::uint8_t, 4>(), to);
}

/// As bvh/quantise.h: the same planes to the bit.
HWY_INLINE void quantise_lanes(const BinaryNode* nodes, const std::uint32_t* children, int count,
                               WideNode& wide) {
  alignas(32) float lo[3][kWidth], hi[3][kWidth];
  for (int i = 0; i < kWidth; ++i) {
    const BinaryNode& child = nodes[children[i < count ? i : 0]];
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis][i] = child.lo[axis];
      hi[axis][i] = -child.minus_hi[axis];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    float least = lo[axis][0], most = hi[axis][0];
    for (int i = 1; i < count; ++i) {
      least = min_of(least, lo[axis][i]);
      most = max_of(most, hi[axis][i]);
    }
    wide.origin[axis] = least;
    wide.exponent[axis] = choose_grid_exponent(least, most);
    const float step = wide.step(axis);
    const LaneGrid grid{hn::Set(Float4(), least), hn::Set(Float4(), step)};
    for (int part = 0; part < kWidth; part += 4) {
      store_planes<true>(grid, 1.0f / step, lo[axis] + part, wide.q[axis][0] + part);
      store_planes<false>(grid, 1.0f / step, hi[axis] + part, wide.q[axis][1] + part);
    }
    for (int i = count; i < kWidth; ++i) {
      wide.q[axis][0][i] = 255;
      wide.q[axis][1][i] = 0;
    }
  }
}

/// Writes one leaf's record (bvh/triangle_cluster.h); vertices are told apart by their index.
HWY_INLINE void write_cluster(const Items& items, const std::uint32_t* triangles,
                              std::uint32_t count, std::uint32_t vertices, std::byte* record) {
  const hn::FixedTag<std::uint32_t, 4> d;
  auto first = hn::Set(d, kNone), second = first;
  const auto place = hn::Iota(d, 0);
  std::uint32_t vertex[kClusterVertices], used = 0;
  std::uint16_t corners[kClusterTriangles];
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t* corner = &items.tri2vtx[3 * std::size_t{triangles[i]}];
    std::uint32_t packed = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto v = hn::Set(d, corner[k]);
      std::intptr_t at = hn::FindFirstTrue(d, hn::Eq(first, v));
      if (at < 0) {
        at = hn::FindFirstTrue(d, hn::Eq(second, v));
        if (at >= 0) {
          at += 4;
        } else {
          at = static_cast<std::intptr_t>(used);
          vertex[used] = corner[k];
          first = hn::IfThenElse(hn::Eq(place, hn::Set(d, used)), v, first);
          second = hn::IfThenElse(hn::Eq(place, hn::Set(d, used - 4)), v, second);
          ++used;
        }
      }
      packed |= static_cast<std::uint32_t>(at) << (3 * k);
    }
    corners[i] = static_cast<std::uint16_t>(packed);
  }
  // Unused bytes at the end are null, so that equal trees are equal in every byte.
  const std::size_t bytes = ClusterView::units(count, vertices) * kClusterUnit;
  std::memset(record + bytes - kClusterUnit, 0, kClusterUnit);
  const std::size_t start = ClusterView::coordinates_offset(count);
  std::memset(record + start - 4, 0, 4);
  record[0] = static_cast<std::byte>(count);
  record[1] = static_cast<std::byte>(vertices);
  std::memcpy(record + 2, corners, 2 * std::size_t{count});
  std::byte* out = record + start;
  for (std::uint32_t v = 0; v < vertices; ++v, out += 4) {
    const float* xyz = &items.vtx2xyz[3 * std::size_t{vertex[v]}];
    std::memcpy(out, xyz, 4);
    std::memcpy(out + 4 * std::size_t{vertices}, xyz + 1, 4);
    std::memcpy(out + 8 * std::size_t{vertices}, xyz + 2, 4);
  }
  std::memcpy(record + ClusterView::primitives_offset(count, vertices), triangles,
              4 * std::size_t{count});
}

void fetch_indices(const EmitTarget& to, const std::uint32_t* children, PlannedChildren planned) {
  for (int i = planned.inner; i < planned.count; ++i) {
    const BinaryNode& leaf = to.nodes[children[i]];
    for (std::uint32_t k = 0; k < leaf.leaf_count(); ++k) {
      hwy::Prefetch(&to.items->tri2vtx[3 * std::size_t{to.order[leaf.first + k]}]);
    }
  }
}

void fetch_vertices(const EmitTarget& to, const std::uint32_t* children, PlannedChildren planned) {
  for (int i = planned.inner; i < planned.count; ++i) {
    const BinaryNode& leaf = to.nodes[children[i]];
    for (std::uint32_t k = 0; k < leaf.leaf_count(); ++k) {
      const std::uint32_t* corner = &to.items->tri2vtx[3 * std::size_t{to.order[leaf.first + k]}];
      for (int c = 0; c < 3; ++c) hwy::Prefetch(&to.items->vtx2xyz[3 * std::size_t{corner[c]}]);
    }
  }
}

/// Writes the wide node at `place.node`, and all below it behind `place.next_node`.
void emit(const EmitTarget& to, std::uint32_t binary, bool below, EmitPlace& place) {
  std::uint32_t children[kWidth];
  const PlannedChildren planned = planned_children(to.nodes, binary, children);
  WideNode& wide = to.wide[place.node];
  wide.counts = static_cast<std::uint8_t>(planned.inner | planned.count << 4);
  wide.first_child = place.next_node;
  wide.first_leaf = place.next_leaf;
  std::memset(wide.leaf, 0, sizeof(wide.leaf));
  // Triangles lie anywhere in the mesh's arrays: ask for all of a node's at once, indices first.
  if (to.clusters != nullptr) fetch_indices(to, children, planned);
  quantise_lanes(to.nodes, children, planned.count, wide);
  if (to.clusters != nullptr) fetch_vertices(to, children, planned);
  for (int i = planned.inner; i < planned.count; ++i) {
    const BinaryNode& leaf = to.nodes[children[i]];
    wide.leaf[i] = static_cast<std::uint8_t>(place.next_leaf - wide.first_leaf);
    const std::uint32_t* items = to.order + leaf.first;
    if (to.clusters == nullptr) {
      to.entries[place.next_leaf++] = *items;
    } else {
      write_cluster(*to.items, items, leaf.leaf_count(), leaf.leaf_vertices(),
                    to.clusters + place.next_leaf * kClusterUnit);
      place.next_leaf += leaf_units(leaf);
    }
  }
  const std::uint32_t first = place.next_node;
  place.next_node += static_cast<std::uint32_t>(planned.inner);
  for (int i = 0; below && i < planned.inner; ++i) {
    place.node = first + static_cast<std::uint32_t>(i);
    emit(to, children[i], true, place);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
