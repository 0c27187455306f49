// Codes of items, and items onto the desk. Included once per instruction set (no include guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

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
    const float* at = items_.vtx2xyz.data() + 3 * std::size_t{vertex};
    return hn::LoadU(Float4(), vertex == last_ ? tail_ : at);
  }

 private:
  const Items& items_;
  std::uint32_t last_;
  float tail_[4] = {};
};

/// False only if the triangle's normal is certainly not null, as is_degenerate would find in
/// double: each side is rounded once and each product once, far less than the bound here.
HWY_INLINE bool may_be_degenerate(Vector4 a, Vector4 b, Vector4 c) {
  const auto u = hn::Sub(b, a), v = hn::Sub(c, a);
  const auto u_next = hn::Shuffle0321(u), v_next = hn::Shuffle0321(v);  // y z w x
  const auto p = three_lanes(hn::Mul(u, v_next)), q = three_lanes(hn::Mul(u_next, v));
  // Lanes 0 and 1 are z and x of the normal; y would need another turn and is left to the slow way.
  const auto normal = hn::Abs(hn::Sub(p, q));
  const auto bound = hn::Add(hn::Mul(hn::Add(hn::Abs(p), hn::Abs(q)), hn::Set(Float4(), 1e-5f)),
                             hn::Set(Float4(), 1e-30f));
  alignas(16) static constexpr float kTwo[4] = {1.0f, 1.0f, 0.0f, 0.0f};
  const auto used = hn::Gt(hn::Load(Float4(), kTwo), hn::Zero(Float4()));
  return hn::AllFalse(Float4(), hn::And(hn::Gt(normal, bound), used));
}

/// The padded box of a triangle, to the bit that of triangle_bounds.
HWY_INLINE Lanes triangle_box(Vector4 a, Vector4 b, Vector4 c) {
  const auto lo = three_lanes(hn::Min(hn::Min(a, b), c));
  const auto minus_hi = three_lanes(hn::Neg(hn::Max(hn::Max(a, b), c)));
  const auto size = hn::Max(hn::Abs(lo), hn::Abs(minus_hi));
  const auto most = hn::Max(size, hn::Max(hn::Shuffle0321(size), hn::Shuffle1032(size)));
  const float padding = hn::GetLane(most) * kPadding;
  const auto by = three_lanes(hn::Set(Float4(), padding));
  return make_box(hn::Sub(lo, by), hn::Sub(minus_hi, by));
}

HWY_INLINE hn::Vec<hn::FixedTag<std::uint32_t, 4>> spread_bits(
    hn::Vec<hn::FixedTag<std::uint32_t, 4>> x) {
  const hn::FixedTag<std::uint32_t, 4> d;
  x = hn::And(hn::Or(x, hn::ShiftLeft<16>(x)), hn::Set(d, 0x030000ffu));
  x = hn::And(hn::Or(x, hn::ShiftLeft<8>(x)), hn::Set(d, 0x0300f00fu));
  x = hn::And(hn::Or(x, hn::ShiftLeft<4>(x)), hn::Set(d, 0x030c30c3u));
  return hn::And(hn::Or(x, hn::ShiftLeft<2>(x)), hn::Set(d, 0x09249249u));
}

/// Codes of triangles in one grid of 2^10 cells a side, four at a time.
std::uint32_t code_triangles(const Items& items, const CellGrid& grid, std::uint32_t begin,
                             std::uint32_t end, std::uint32_t left_out,
                             KeyIndex<std::uint32_t>* out) {
  const Float4 d;
  const hn::FixedTag<std::uint32_t, 4> du;
  const VertexReader vertex(items);
  const std::uint32_t* corner = items.tri2vtx.data() + 3 * std::size_t{begin};
  alignas(16) float centre[4][4] = {};
  alignas(16) std::uint32_t code[4];
  std::uint32_t dropped = 0;
  const auto half = hn::Set(d, 0.5f);
  for (std::uint32_t i = begin; i < end; i += 4) {
    const std::uint32_t count = end - i < 4 ? end - i : 4;
    bool degenerate[4] = {};
    for (std::uint32_t k = 0; k < count; ++k, corner += 3) {
      const auto a = vertex(corner[0]), b = vertex(corner[1]), c = vertex(corner[2]);
      const auto lo = hn::Min(hn::Min(a, b), c), hi = hn::Max(hn::Max(a, b), c);
      hn::Store(hn::Add(hn::Mul(lo, half), hn::Mul(hi, half)), d, centre[k]);
      degenerate[k] = may_be_degenerate(a, b, c) && items.is_left_out(i + k);
    }
    hn::Vec<Float4> p[4];
    hn::LoadInterleaved4(d, centre[0], p[0], p[1], p[2], p[3]);
    auto sum = hn::Zero(du);
    for (int axis = 0; axis < 3; ++axis) {
      const auto scaled =
          hn::Mul(hn::Sub(p[axis], hn::Set(d, grid.lo[axis])), hn::Set(d, grid.cells_per_unit));
      const auto inside = hn::Min(hn::Max(scaled, hn::Zero(d)), hn::Set(d, grid.cells - 1.0f));
      const auto cell = hn::BitCast(du, hn::ConvertTo(hn::FixedTag<std::int32_t, 4>(), inside));
      sum = hn::Or(hn::ShiftLeft<1>(sum), spread_bits(cell));
    }
    hn::Store(sum, du, code);
    for (std::uint32_t k = 0; k < count; ++k) {
      out[i + k] = {degenerate[k] ? left_out : code[k], i + k};
      dropped += degenerate[k] ? 1 : 0;
    }
  }
  return dropped;
}

std::uint32_t code(const Items& items, const MortonGrid& grid, std::uint32_t begin,
                   std::uint32_t end, std::uint32_t left_out, KeyIndex<std::uint32_t>* out) {
  if (items.are_triangles() && grid.is_one) {
    return code_triangles(items, grid.core_grid, begin, end, left_out, out);
  }
  std::uint32_t dropped = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const bool left = items.is_left_out(i);
    out[i] = {left ? left_out : grid.code_30(items.box(i)), i};
    dropped += left ? 1 : 0;
  }
  return dropped;
}

/// One bit of 64: different bits are different vertices.
HWY_INLINE std::uint64_t vertex_bit(std::uint32_t vertex) {
  return std::uint64_t{1} << ((vertex * 0x9E3779B1u) >> 26);
}

template <bool kWithCorners>
void load(const Items& items, const std::uint32_t* indices, std::uint32_t count, Treelet& t) {
  const VertexReader vertex(items);
  const bool triangles = items.are_triangles();
  // Triangles lie anywhere in the mesh's arrays: indices are asked for first, then vertices.
  constexpr std::uint32_t kAhead = 32, kVerticesAhead = 16;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t at = t.count++;
    const std::uint32_t item = indices[i];
    if (triangles && i + kAhead < count) {
      hwy::Prefetch(&items.tri2vtx[3 * std::size_t{indices[i + kAhead]}]);
    }
    if (triangles && i + kVerticesAhead < count) {
      const std::uint32_t* later = &items.tri2vtx[3 * std::size_t{indices[i + kVerticesAhead]}];
      for (int k = 0; k < 3; ++k) hwy::Prefetch(&items.vtx2xyz[3 * std::size_t{later[k]}]);
    }
    t.item[at] = item;
    t.ids[at] = at;
    if (triangles) {
      const std::uint32_t* corner = &items.tri2vtx[3 * std::size_t{item}];
      if (kWithCorners) {
        for (int k = 0; k < 3; ++k) t.corner[at][k] = corner[k];
        t.corner[at][3] = kNone;
        t.vertex_bits[at] = vertex_bit(corner[0]) | vertex_bit(corner[1]) | vertex_bit(corner[2]);
      }
      store_box(triangle_box(vertex(corner[0]), vertex(corner[1]), vertex(corner[2])), t.box[at].v);
    } else {
      const Aabb& box = items.boxes[item];
      for (int k = 0; k < 3; ++k) {
        t.box[at].v[k] = box.lo[k];
        t.box[at].v[4 + k] = -box.hi[k];
      }
      t.box[at].v[3] = t.box[at].v[7] = 0.0f;
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
