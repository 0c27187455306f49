// Strips of triangles (bvh/strip.h) and their Morton codes. Included once per instruction set (no
// include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

using BlockTag = hn::CappedTag<float, 16>;
using BlockIndexTag = hn::Rebind<std::uint32_t, BlockTag>;
using BlockLanes = hn::Vec<BlockTag>;
using BlockIndices = hn::Vec<BlockIndexTag>;

/// Strips are looked for in blocks of so many triangles, a bit each.
constexpr std::uint32_t kBlock = 64;
/// Fewer in a block are hardly neighbours: no two are looked for that could be one.
constexpr int kManyPairs = 6;
/// What is read or written behind a block.
constexpr std::uint32_t kBehindBlock = 16;

HWY_INLINE BlockIndices spread_bits(BlockIndices x) {
  const BlockIndexTag d;
  x = hn::And(hn::Or(x, hn::ShiftLeft<16>(x)), hn::Set(d, 0x030000ffu));
  x = hn::And(hn::Or(x, hn::ShiftLeft<8>(x)), hn::Set(d, 0x0300f00fu));
  x = hn::And(hn::Or(x, hn::ShiftLeft<4>(x)), hn::Set(d, 0x030c30c3u));
  return hn::And(hn::Or(x, hn::ShiftLeft<2>(x)), hn::Set(d, 0x09249249u));
}

/// Of neighbours i and i + 1 that may become one (bit i) those that do: every other one of a run.
HWY_INLINE std::uint64_t every_other(std::uint64_t bits) {
  constexpr std::uint64_t kEven = 0x5555555555555555u;
  const std::uint64_t starts = bits & ~(bits << 1);
  // The sum carries through runs that start at an even bit, and clears them.
  const std::uint64_t from_even = bits & ~(bits + (starts & kEven));
  return (from_even & kEven) | (bits & ~from_even & ~kEven);
}

/// The strips of a block of triangles.
class StripBlock {
 public:
  std::uint32_t count;  ///< of strips
  alignas(64) float lo[3][kBlock + kBehindBlock];
  alignas(64) float minus_hi[3][kBlock + kBehindBlock];
  alignas(64) std::uint32_t strip[kBlock + kBehindBlock];

  /// From `begin` on; returns how many triangles no ray can meet.
  std::uint32_t read(const Items& items, const VertexReader& vertex, std::uint32_t begin,
                     std::uint32_t triangles, float scale) {
    const std::uint64_t all = triangles < kBlock ? (std::uint64_t{1} << triangles) - 1 : ~0ull;
    const std::uint32_t* corners = items.tri2vtx.data() + 3 * std::size_t{begin};
    if (triangles < kBlock) {
      for (std::uint32_t i = 0; i < kBlock; ++i) {
        const std::uint32_t from = i < triangles ? i : triangles - 1;
        std::copy_n(corners + 3 * std::size_t{from}, 3, last_ + 3 * std::size_t{i});
      }
      corners = last_;
    }
    load(corners, vertex);
    std::uint64_t suspects = 0;
    const BlockIndexTag d;
    for (std::uint32_t i = 0; i < kBlock; i += kLanes) {
      suspects |= bound(i) << i;
      hn::Store(hn::Iota(d, begin + i), d, strip + i);
    }
    std::uint64_t left_out = 0;
    for (suspects &= all; suspects != 0; suspects &= suspects - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(suspects));
      if (items.is_left_out(begin + i)) left_out |= std::uint64_t{1} << i;
    }
    const std::uint64_t kept = all & ~left_out;
    count = kBlock;
    const std::uint64_t pairs =
        every_other(small_unions(scale) & common_edges() & kept & kept >> 1 & all >> 1);
    if (pairs != 0 || kept != ~0ull) join(pairs, kept);
    if (std::popcount(pairs) >= kManyPairs) {
      const std::uint64_t there = (count < kBlock ? std::uint64_t{1} << count : 0) - 1;
      join(every_other(small_unions(scale) & neighbours() & there >> 1), there);
    }
    return static_cast<std::uint32_t>(std::popcount(left_out));
  }

 private:
  /// Vertices of all corners, an axis a row.
  HWY_INLINE void load(const std::uint32_t* corners, const VertexReader& vertex) {
    const BlockIndexTag du;
    auto highest = hn::Zero(du);
    for (std::uint32_t i = 0; i < kBlock; i += kLanes) {
      BlockIndices corner[3];
      hn::LoadInterleaved3(du, corners + 3 * std::size_t{i}, corner[0], corner[1], corner[2]);
      for (int k = 0; k < 3; ++k) {
        hn::Store(corner[k], du, corner_[k] + i);
        highest = hn::Max(highest, corner[k]);
      }
    }
    if (HWY_LIKELY(hn::AllTrue(du, hn::Lt(highest, hn::Set(du, vertex.last()))))) {
      load_vertices(corners, [&](std::uint32_t k) { return vertex.inner(k); });
    } else {
      load_vertices(corners, vertex);
    }
  }

  template <class Vertex>
  HWY_INLINE void load_vertices(const std::uint32_t* corners, const Vertex& vertex) {
    const Float4 d;
    for (std::uint32_t i = 0; i < kBlock; i += 4) {
      const std::uint32_t* const corner = corners + 3 * std::size_t{i};
      for (std::uint32_t k = 0; k < 3; ++k) {
        Vector4 xyz[3];
        transpose(vertex(corner[k]), vertex(corner[3 + k]), vertex(corner[6 + k]),
                  vertex(corner[9 + k]), xyz);
        for (int axis = 0; axis < 3; ++axis) hn::Store(xyz[axis], d, at_[k][axis] + i);
      }
    }
  }

  /// Boxes of some triangles; returns which of them may be degenerate. Not so is one whose normal
  /// is certainly not null, as is_degenerate would find in double: each side is rounded once and
  /// each product once, far less than the bound here.
  HWY_INLINE std::uint64_t bound(std::uint32_t i) {
    const BlockTag d;
    BlockLanes u[3], v[3];
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = hn::Load(d, at_[0][axis] + i), b = hn::Load(d, at_[1][axis] + i),
                 c = hn::Load(d, at_[2][axis] + i);
      hn::Store(hn::Min(hn::Min(a, b), c), d, lo[axis] + i);
      hn::Store(hn::Neg(hn::Max(hn::Max(a, b), c)), d, minus_hi[axis] + i);
      u[axis] = hn::Sub(b, a);
      v[axis] = hn::Sub(c, a);
    }
    auto has_area = hn::MaskFromVec(hn::Zero(d));
    for (int axis = 0; axis < 3; ++axis) {
      const auto p = hn::Mul(u[axis], v[(axis + 1) % 3]), q = hn::Mul(u[(axis + 1) % 3], v[axis]);
      const auto most = hn::Add(hn::Abs(p), hn::Abs(q));
      const auto error = hn::Add(hn::Mul(most, hn::Set(d, 1e-5f)), hn::Set(d, 1e-30f));
      has_area = hn::Or(has_area, hn::Gt(hn::Abs(hn::Sub(p, q)), error));
    }
    return bits_of(d, hn::Not(has_area));
  }

  HWY_INLINE static BlockLanes area(const BlockLanes* box, BlockLanes scale) {
    BlockLanes side[3];
    for (int axis = 0; axis < 3; ++axis) {
      side[axis] = hn::Mul(hn::Add(box[axis], box[3 + axis]), scale);
    }
    const auto xy_xz = hn::Mul(side[0], hn::Add(side[1], side[2]));
    return hn::Add(xy_xz, hn::Mul(side[1], side[2]));
  }
  HWY_INLINE void load_boxes(std::uint32_t i, BlockLanes* box) const {
    for (int axis = 0; axis < 3; ++axis) {
      box[axis] = hn::LoadU(BlockTag(), lo[axis] + i);
      box[3 + axis] = hn::LoadU(BlockTag(), minus_hi[axis] + i);
    }
  }

  /// Bit i: i and i + 1 are hardly larger together.
  HWY_INLINE std::uint64_t small_unions(float scale) {
    const BlockTag d;
    const auto minus_scale = hn::Set(d, -scale);
    BlockLanes box[6], next[6];
    for (std::uint32_t i = 0; i < count; i += kLanes) {
      load_boxes(i, box);
      hn::Store(area(box, minus_scale), d, area_ + i);
    }
    std::uint64_t small = 0;
    for (std::uint32_t i = 0; i < count; i += kLanes) {
      load_boxes(i, box);
      load_boxes(i + 1, next);
      for (int k = 0; k < 6; ++k) box[k] = hn::Min(box[k], next[k]);
      const auto both = area(box, minus_scale);
      const auto one = hn::Load(d, area_ + i), other = hn::LoadU(d, area_ + i + 1);
      const auto most =
          hn::Add(hn::Max(one, other), hn::Mul(hn::Min(one, other), hn::Set(d, kOfSmaller)));
      const auto fits = hn::And(hn::Le(both, most), hn::Le(both, hn::Set(d, kLargestStrip)));
      small |= std::uint64_t{bits_of(d, fits)} << i;
    }
    return small;
  }

  /// Bit i: triangles i and i + 1 have two corners in common.
  HWY_INLINE std::uint64_t common_edges() {
    const BlockIndexTag d;
    std::uint64_t common = 0;
    for (std::uint32_t i = 0; i < kBlock; i += kLanes) {
      auto equal = hn::Zero(d);
      for (int k = 0; k < 3; ++k) {
        const auto corner = hn::Load(d, corner_[k] + i);
        for (int next = 0; next < 3; ++next) {
          const auto other = hn::LoadU(d, corner_[next] + i + 1);
          equal = hn::Sub(equal, hn::VecFromMask(d, hn::Eq(corner, other)));
        }
      }
      // −1 was subtracted for each.
      const auto two = hn::Gt(equal, hn::Set(d, 1u));
      common |= std::uint64_t{bits_of(d, two)} << i;
    }
    return common;
  }

  /// Bit i: strips i and i + 1 may be one, nothing was left out between them.
  HWY_INLINE std::uint64_t neighbours() {
    const BlockIndexTag d;
    std::uint64_t near = 0;
    for (std::uint32_t i = 0; i < count; i += kLanes) {
      const auto own = hn::Load(d, strip + i), next = hn::LoadU(d, strip + i + 1);
      const auto end = hn::Add(hn::Add(own, hn::ShiftRight<kStripShift>(own)), hn::Set(d, 1u));
      const auto gap = hn::ShiftLeft<32 - kStripShift>(hn::Sub(next, end));
      // Two triangles without a common edge could have six vertices.
      const auto is_pair = hn::Gt(hn::Or(own, next), hn::Set(d, strip_first(~0u)));
      const auto fits = hn::And(is_pair, hn::Eq(gap, hn::Zero(d)));
      near |= std::uint64_t{bits_of(d, fits)} << i;
    }
    return near;
  }

  /// Joins i with i + 1 where bit i is set, and leaves out what is not kept.
  HWY_INLINE void join(std::uint64_t joined, std::uint64_t kept) {
    const BlockTag d;
    const BlockIndexTag du;
    const std::uint64_t stay = kept & ~(joined << 1);
    std::uint32_t to = 0;
    for (std::uint32_t i = 0; i < count; i += kLanes) {
      const auto is_joined = mask_of(d, joined >> i), stays = mask_of(d, stay >> i);
      for (float(*const rows)[kBlock + kBehindBlock] : {lo, minus_hi}) {
        for (int axis = 0; axis < 3; ++axis) {
          const auto own = hn::Load(d, rows[axis] + i), next = hn::LoadU(d, rows[axis] + i + 1);
          const auto both = hn::IfThenElse(is_joined, hn::Min(own, next), own);
          hn::CompressStore(both, stays, d, rows[axis] + to);
        }
      }
      const auto own = hn::Load(du, strip + i), next = hn::LoadU(du, strip + i + 1);
      const auto one = hn::Set(du, 1u << kStripShift);
      const auto others =
          hn::Add(hn::ShiftLeft<kStripShift>(hn::ShiftRight<kStripShift>(next)), one);
      const auto both = hn::IfThenElse(hn::RebindMask(du, is_joined), hn::Add(own, others), own);
      hn::CompressStore(both, hn::RebindMask(du, stays), du, strip + to);
      to += static_cast<std::uint32_t>(std::popcount(stay >> i & kAllLanes));
    }
    count = to;
  }

  alignas(64) float at_[3][3][kBlock];  ///< [corner][axis]
  alignas(64) float area_[kBlock + kBehindBlock];
  alignas(64) std::uint32_t corner_[3][kBlock + kBehindBlock];
  alignas(64) std::uint32_t last_[3 * kBlock];  ///< corners of a block that is not full
};

/// Codes of a block's strips in one grid of 2^10 cells a side.
HWY_INLINE void code_block(const StripBlock& block, const CellGrid& grid,
                           KeyIndex<std::uint32_t>* out) {
  const BlockTag d;
  const BlockIndexTag du;
  const auto half = hn::Set(d, 0.5f);
  for (std::uint32_t i = 0; i < block.count; i += kLanes) {
    auto code = hn::Zero(du);
    for (int axis = 0; axis < 3; ++axis) {
      const auto centre = hn::Sub(hn::Mul(hn::Load(d, block.lo[axis] + i), half),
                                  hn::Mul(hn::Load(d, block.minus_hi[axis] + i), half));
      const auto scaled =
          hn::Mul(hn::Sub(centre, hn::Set(d, grid.lo[axis])), hn::Set(d, grid.cells_per_unit));
      const auto inside = hn::Min(hn::Max(scaled, hn::Zero(d)), hn::Set(d, grid.cells - 1.0f));
      const auto cell =
          hn::BitCast(du, hn::ConvertTo(hn::Rebind<std::int32_t, BlockTag>(), inside));
      code = hn::Or(hn::ShiftLeft<1>(code), spread_bits(cell));
    }
    alignas(64) std::uint32_t codes[16];
    hn::Store(code, du, codes);
    for (std::uint32_t k = 0; k < kLanes && i + k < block.count; ++k) {
      out[i + k] = {codes[k], block.strip[i + k]};
    }
  }
}

HWY_INLINE void set_code(const MortonGrid& grid, const Aabb& box, std::uint32_t& code) {
  code = grid.code_30(box);
}
HWY_INLINE void set_code(const MortonGrid& grid, const Aabb& box, std::uint64_t& code) {
  code = grid.code_63(box);
}

template <class Key>
StripCount code(const Items& items, const MortonGrid& grid, std::uint32_t begin, std::uint32_t end,
                KeyIndex<Key>* out) {
  StripCount found{0, 0};
  if (!items.are_triangles()) {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (items.is_left_out(i)) {
        ++found.left_out;
      } else {
        KeyIndex<Key>& to = out[found.strips++];
        set_code(grid, items.box(i), to.key);
        to.index = i;
      }
    }
    return found;
  }
  const VertexReader vertex(items);
  StripBlock block;
  for (std::uint32_t first = begin; first < end; first += kBlock) {
    const std::uint32_t triangles = end - first < kBlock ? end - first : kBlock;
    found.left_out += block.read(items, vertex, first, triangles,
                                 grid.outer_grid.cells_per_unit / grid.outer_grid.cells);
    KeyIndex<Key>* const to = out + found.strips;
    found.strips += block.count;
    if constexpr (sizeof(Key) == sizeof(std::uint32_t)) {
      if (grid.is_one) {
        code_block(block, grid.core_grid, to);
        continue;
      }
    }
    for (std::uint32_t i = 0; i < block.count; ++i) {
      Aabb box;
      for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = block.lo[axis][i];
        box.hi[axis] = -block.minus_hi[axis][i];
      }
      set_code(grid, box, to[i].key);
      to[i].index = block.strip[i];
    }
  }
  return found;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
