// What the kernels of traversal share. Included once per instruction set (no include guard):
// everything lives in that set's own namespace, so that the linker can never put a copy with AVX
// instructions where the baseline calls it.
//
// No kernel decides anything that core/ does not: boxes are met by the operations of slab_interval,
// triangles by those of intersect_triangle. So hits are those of trace_scalar to the bit.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using BoxTag = hn::CappedTag<float, kWidth>;
using PlaneTag = hn::Rebind<std::uint8_t, BoxTag>;
using CornerTag = hn::Rebind<std::uint16_t, BoxTag>;
using IndexTag = hn::Rebind<std::int32_t, BoxTag>;
using BoxVec = hn::Vec<BoxTag>;

/// Planes of children part…part + lanes − 1, as WideNode::plane.
HWY_INLINE BoxVec planes(const WideNode& node, int axis, int side, std::size_t part) {
  const BoxTag d;
  const IndexTag di;
  const auto q = hn::PromoteTo(di, hn::LoadU(PlaneTag(), node.q[axis][side] + part));
  // The product is exact (a power of two), so that nothing depends on whether it is fused.
  return hn::MulAdd(hn::ConvertTo(d, q), hn::Set(d, node.step(axis)),
                    hn::Set(d, node.origin[axis]));
}

/// Asks for two cache lines that will be read soon, a node or the better part of a cluster: a third
/// of the time of a ray is waiting for memory.
HWY_INLINE void fetch_soon(const void* object) {
  __builtin_prefetch(object);
  __builtin_prefetch(static_cast<const char*>(object) + 64);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
