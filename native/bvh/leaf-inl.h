// Leaves: what fits into one, and their records. Included once per instruction set (no include
// guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// Vertex k as a triangle's corner: a lane each, as ClusterView::corners packs them.
struct CornerPlaces {
  alignas(64) std::uint32_t of[kClusterVertices][16];
  constexpr CornerPlaces() : of() {
    for (std::uint32_t k = 0; k < kClusterVertices; ++k) {
      for (std::uint32_t lane = 0; lane < 16; ++lane) {
        of[k][lane] = lane % 4 < 3 ? k << (3 * (lane % 4)) : 0;
      }
    }
  }
};
constexpr CornerPlaces kCornerPlaces;

/// Corners of up to eight triangles in lanes: corner k of triangle i is lane 4i + k.
class LeafCorners {
 public:
  /// @param corner  [8], whatever stands behind those that are used
  HWY_INLINE explicit LeafCorners(const Corners4* corner) : corner_(corner[0]) {
    for (std::uint32_t v = 0; v < kVectors; ++v) {
      lanes_[v] = hn::LoadU(Tag(), corner_ + v * kLanes);
    }
  }

  /// The first corner of each vertex, one bit each.
  HWY_INLINE std::uint32_t firsts(std::uint32_t count) const {
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t same = where(corner_[4 * i + k]);
        bits |= same & (0u - same);
      }
    }
    return bits;
  }

  /// Vertices of up to eight first corners: indices in the mesh, the last one over and over.
  /// @param to  [kListRoom], of which eight count
  HWY_INLINE void list_vertices(std::uint32_t firsts, std::uint32_t* to) const {
    const auto last = hn::Set(Tag(), corner_[31 - std::countl_zero(firsts)]);
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < kVectors; ++v, firsts >>= kLanes) {
      const std::uint32_t here = firsts & kAllLanes;
      hn::StoreU(hn::Compress(lanes_[v], mask_of(Tag(), here)), Tag(), to + count);
      count += static_cast<std::uint32_t>(std::popcount(here));
    }
    for (std::uint32_t k = 0; k < kClusterVertices; k += kLanes) {
      hn::StoreU(last, Tag(), to + count + k);
    }
  }
  static constexpr std::uint32_t kListRoom = 2 * kClusterVertices + 16;

  /// Eight 16-bit entries as ClusterView::corners has them, null behind the last triangle.
  /// @param vertex  as list_vertices() lists them
  HWY_INLINE void store(const std::uint32_t* vertex, std::uint32_t count, std::byte* to) const {
    const Tag d;
    Indices place[kVectors];
    for (auto& p : place) p = hn::Zero(d);
    // Of equal ones the first counts.
    for (std::uint32_t k = kClusterVertices; k-- > 0;) {
      const auto wanted = hn::Set(d, vertex[k]), its = hn::Load(d, kCornerPlaces.of[k]);
      for (std::uint32_t v = 0; v < kVectors; ++v) {
        place[v] = hn::IfThenElse(hn::Eq(lanes_[v], wanted), its, place[v]);
      }
    }
    alignas(64) std::uint32_t packed[32];
    for (std::uint32_t v = 0; v < kVectors; ++v) {
      const auto pairs = hn::Or(place[v], hn::Shuffle2301(place[v]));
      hn::Store(hn::Or(pairs, hn::Shuffle1032(pairs)), d, packed + v * kLanes);
    }
    for (std::uint32_t i = 0; i < kClusterTriangles; ++i) {
      const auto three = static_cast<std::uint16_t>(i < count ? packed[4 * i] : 0);
      std::memcpy(to + 2 * std::size_t{i}, &three, 2);
    }
  }

 private:
  using Tag = hn::CappedTag<std::uint32_t, 16>;
  using Indices = hn::Vec<Tag>;
  static constexpr std::uint32_t kVectors = 32 / kLanes;

  /// The corners that have this vertex; what is behind the last triangle comes last.
  HWY_INLINE std::uint32_t where(std::uint32_t vertex) const {
    const auto wanted = hn::Set(Tag(), vertex);
    std::uint32_t bits = 0;
    for (std::uint32_t v = 0; v < kVectors; ++v) {
      bits |= bits_of(Tag(), hn::Eq(lanes_[v], wanted)) << (v * kLanes);
    }
    return bits;
  }
  const std::uint32_t* corner_;
  Indices lanes_[kVectors];
};

/// Calls body(triangle, k) for the first, k = 0, … of the triangles of the items at positions
/// `begin` and on.
template <class Body>
HWY_INLINE void for_each_of_leaf(const Treelet& t, std::uint32_t begin, std::uint32_t count,
                                 const Body& body) {
  for (std::uint32_t i = begin, k = 0; k < count; ++i) {
    const std::uint32_t first = t.start[t.ids[i]], end = first + t.triangles[t.ids[i]];
    for (std::uint32_t triangle = first; triangle < end; ++triangle) body(triangle, k++);
  }
}

HWY_INLINE void copy_corners(const Corners4& from, Corners4& to) {
  const hn::FixedTag<std::uint32_t, 4> d;
  hn::Store(hn::Load(d, from), d, to);
}

/// BinaryNode::info of a leaf over so many triangles at positions [begin, end), or 0 if that would
/// hold too much. Its first corners go to t.moved[begin], which nobody else needs.
HWY_INLINE std::uint32_t leaf_info(Treelet& t, std::uint32_t begin, std::uint32_t end,
                                   std::uint32_t triangles, LeafLimit limit) {
  if (triangles > limit.items) return 0;
  if (limit.vertices == kNone) return triangles;
  if (triangles == 1) {
    t.moved[begin] = 7;
    return 1u | 3u << 8;
  }
  std::uint64_t seen = 0;
  for (std::uint32_t i = begin; i < end; ++i) seen |= t.vertex_bits[t.ids[i]];
  // Different bits are different vertices: most sets with too many are seen here.
  if (static_cast<std::uint32_t>(std::popcount(seen)) > limit.vertices) return 0;
  alignas(64) Corners4 corner[kClusterTriangles];
  for_each_of_leaf(t, begin, triangles, [&](std::uint32_t triangle, std::uint32_t k) {
    copy_corners(t.corner[triangle], corner[k]);
  });
  const std::uint32_t firsts = LeafCorners(corner).firsts(triangles);
  const auto vertices = static_cast<std::uint32_t>(std::popcount(firsts));
  t.moved[begin] = firsts;
  return vertices <= limit.vertices ? triangles | vertices << 8 : 0;
}

struct WrittenLeaf {
  std::uint32_t info;  ///< BinaryNode::info
  Lanes box;           ///< contains those of the triangles
};

/// Writes a leaf's record (bvh/triangle_cluster.h), and up to kClusterSlack bytes behind it;
/// vertices are told apart by their index and stand in the order of their first corners.
/// @param corner  as LeafCorners has it
/// @param firsts  of the triangles, and perhaps of some behind them, as LeafCorners has it
/// @param primitives  [8], triangles' indices in the mesh
HWY_INLINE WrittenLeaf write_cluster(const VertexReader& vertex, std::uint32_t count,
                                     const Corners4* corner, std::uint32_t firsts,
                                     const std::uint32_t* primitives, std::byte* record) {
  firsts &= 0xffffffffu >> (32 - 4 * count);
  const auto vertices = static_cast<std::uint32_t>(std::popcount(firsts));
  std::uint32_t index[LeafCorners::kListRoom];
  const LeafCorners corners(corner);
  corners.list_vertices(firsts, index);
  const std::size_t start = ClusterView::coordinates_offset(count);
  record[0] = static_cast<std::byte>(count);
  record[1] = static_cast<std::byte>(vertices);
  std::memset(record + 16, 0, 4);  // behind eight triangles' corners two bytes are unused
  corners.store(index, count, record + 2);
  // Each row of coordinates is written as a whole; what is too much the next one overwrites.
  const Float4 d;
  Vector4 v[kClusterVertices];
  for (std::uint32_t k = 0; k < kClusterVertices; ++k) v[k] = vertex(index[k]);
  Vector4 lo = v[0], hi = v[0];
  for (std::uint32_t k = 1; k < kClusterVertices; ++k) {
    lo = hn::Min(lo, v[k]);
    hi = hn::Max(hi, v[k]);
  }
  Vector4 row[2][3];
  transpose(v[0], v[1], v[2], v[3], row[0]);
  transpose(v[4], v[5], v[6], v[7], row[1]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto* const to = reinterpret_cast<float*>(record + start + axis * 4 * vertices);
    hn::StoreU(row[0][axis], d, to);
    hn::StoreU(row[1][axis], d, to + 4);
  }
  std::byte* const last = record + ClusterView::primitives_offset(count, vertices);
  std::memcpy(last, primitives, 4 * kClusterTriangles);
  // Unused bytes at the end are null, so that equal trees are equal in every byte.
  std::memset(last + 4 * std::size_t{count}, 0, kClusterUnit - 4);
  return {count | vertices << 8, padded_box(lo, hi)};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
