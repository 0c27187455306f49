// Leaves: what fits into one, and their records. Included once per instruction set (no include
// guard).

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// Corners of up to eight triangles in lanes: corner k of triangle i is lane 4i + k.
class LeafCorners {
 public:
  /// @param corner  returns triangle i's three corners and kNone, 16-byte aligned
  template <class Corner>
  HWY_INLINE LeafCorners(std::uint32_t count, const Corner& corner)
      : vectors_((4 * count + kLanes - 1) / kLanes) {
    for (std::uint32_t v = 0; v < vectors_; ++v) {
      lanes_[v] = triangles(v * kLanes / 4, count, corner);
    }
  }

  /// The lanes that hold this vertex, one bit each.
  HWY_INLINE std::uint32_t where(std::uint32_t vertex) const {
    const auto wanted = hn::Set(Tag(), vertex);
    std::uint32_t bits = mask_bits(hn::Eq(lanes_[0], wanted));
    for (std::uint32_t v = 1; v < vectors_; ++v) {
      bits |= mask_bits(hn::Eq(lanes_[v], wanted)) << (v * kLanes);
    }
    return bits;
  }

 private:
  using Tag = hn::CappedTag<std::uint32_t, 16>;
  using Mask = hn::Mask<Tag>;
  static constexpr std::uint32_t kLanes = HWY_MAX_BYTES >= 64 ? 16 : HWY_MAX_BYTES >= 32 ? 8 : 4;

  static HWY_INLINE std::uint32_t mask_bits(Mask mask) {
    std::uint8_t bytes[8];
    hn::StoreMaskBits(Tag(), mask, bytes);
    if constexpr (kLanes < 16) return bytes[0];
    std::uint16_t bits;
    std::memcpy(&bits, bytes, 2);
    return bits;
  }

  /// The vector from triangle `first` on; behind the last one stands the last again.
  template <class Corner>
  static HWY_INLINE hn::Vec<Tag> triangles(std::uint32_t first, std::uint32_t count,
                                           const Corner& corner) {
    const hn::FixedTag<std::uint32_t, 4> d;
    const auto one = [&](std::uint32_t i) {
      return hn::Load(d, corner(first + i < count ? first + i : count - 1));
    };
#if HWY_MAX_BYTES >= 64
    const hn::FixedTag<std::uint32_t, 8> half;
    return hn::Combine(Tag(), hn::Combine(half, one(3), one(2)), hn::Combine(half, one(1), one(0)));
#elif HWY_MAX_BYTES >= 32
    return hn::Combine(Tag(), one(1), one(0));
#else
    return one(0);
#endif
  }

  std::uint32_t vectors_;
  hn::Vec<Tag> lanes_[32 / kLanes];
};

/// How many different vertices a run of triangles has; 0 for more than `most` (≤ 8).
HWY_INLINE std::uint32_t few_vertices(const Treelet& t, const std::uint32_t* ids,
                                      std::uint32_t count, std::uint32_t most) {
  if (count == 1) return 3;
  // Different bits are different vertices: most sets with too many are seen here.
  std::uint64_t seen = 0;
  for (std::uint32_t i = 0; i < count; ++i) seen |= t.vertex_bits[ids[i]];
  if (static_cast<std::uint32_t>(std::popcount(seen)) > most) return 0;
  const LeafCorners corners(count, [&](std::uint32_t i) { return t.corner[ids[i]]; });
  std::uint32_t firsts = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t* corner = t.corner[ids[i]];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t same = corners.where(corner[k]);
      firsts |= same & (0u - same);
    }
  }
  const auto vertices = static_cast<std::uint32_t>(std::popcount(firsts));
  return vertices <= most ? vertices : 0;
}

/// BinaryNode::info of a leaf over the run, or 0 if that would hold too much.
HWY_INLINE std::uint32_t leaf_info(const Treelet& t, std::uint32_t begin, std::uint32_t end,
                                   LeafLimit limit) {
  const std::uint32_t count = end - begin;
  if (count > limit.items) return 0;
  if (limit.vertices == kNone) return count;
  const std::uint32_t vertices = few_vertices(t, t.ids + begin, count, limit.vertices);
  return vertices > 0 ? count | vertices << 8 : 0;
}

/// Writes a leaf's record (bvh/triangle_cluster.h); vertices are told apart by their index and
/// stand in the order of their first corners.
/// @param corner  as LeafCorners has it
/// @param triangles  their indices in the mesh
template <class Corner>
HWY_INLINE void write_cluster(const float* vtx2xyz, std::uint32_t count, std::uint32_t vertices,
                              const Corner& corner, const std::uint32_t* triangles,
                              std::byte* record) {
  // Unused bytes at the end are null, so that equal trees are equal in every byte.
  const std::size_t bytes = ClusterView::units(count, vertices) * kClusterUnit;
  std::memset(record + bytes - kClusterUnit, 0, kClusterUnit);
  const std::size_t start = ClusterView::coordinates_offset(count);
  std::memset(record + start - 4, 0, 4);
  record[0] = static_cast<std::byte>(count);
  record[1] = static_cast<std::byte>(vertices);

  const LeafCorners corners(count, corner);
  std::uint32_t firsts = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t packed = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t same = corners.where(corner(i)[k]);
      const std::uint32_t first = same & (0u - same);
      firsts |= first;
      packed |= static_cast<std::uint32_t>(std::popcount(firsts & (first - 1))) << (3 * k);
    }
    const auto three = static_cast<std::uint16_t>(packed);
    std::memcpy(record + 2 + 2 * std::size_t{i}, &three, 2);
  }
  std::byte* out = record + start;
  for (; firsts != 0; firsts &= firsts - 1, out += 4) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(firsts));
    const float* xyz = vtx2xyz + 3 * std::size_t{corner(lane / 4)[lane % 4]};
    std::memcpy(out, xyz, 4);
    std::memcpy(out + 4 * std::size_t{vertices}, xyz + 1, 4);
    std::memcpy(out + 8 * std::size_t{vertices}, xyz + 2, 4);
  }
  std::byte* primitives = record + ClusterView::primitives_offset(count, vertices);
  for (std::uint32_t i = 0; i < count; ++i) std::memcpy(primitives + 4 * i, triangles + i, 4);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
