// A linear BVH (Lauterbach et al. 2009): Morton codes, one sort, and a hierarchy over runs of that
// order, treelet by treelet in a worker's caches.
#include "bvh/grove.h"
#include "bvh/morton_order.h"

namespace komorebi {

WideTree grow_linear(const Items& items, ThreadPool& pool, const Cancel& cancel) {
  WideTree wide;
  TreeRoom room(items);
  const MortonOrder order = order_by_morton(items, room.leaves(), pool, cancel);
  if (order.count > 0) {
    RunTree top;
    room.back(pool, [&] { top.cut(order, kRunSize); });
    Grove grove(items, static_cast<std::uint32_t>(top.runs.size()), order.scale(), pool, cancel);
    for (std::uint32_t i = 0; i < top.nodes.size(); ++i) {
      const RunTree::Node& node = top.nodes[i];
      if (node.is_run) {
        grove.mark_treelet(i, node.first);
      } else {
        grove.node(i).first = node.first;
        grove.node(i).info = kInnerBit;
      }
    }
    const BuildKernel& kernel = build_kernel();
    const auto load = [&](std::uint32_t i, Treelet& t) {
      KeyIndex<std::uint32_t> narrow[kRunSize];
      const Run run = top.runs[i];
      kernel.load_corners(items, order.narrow_run(run, narrow), run.count, t);
    };
    grove.grow(static_cast<std::uint32_t>(top.runs.size()), load, kernel.pack_treelet,
               std::move(room));
    wide = grove.finish();
  }
  wide.left_out = order.left_out;
  return wide;
}

}  // namespace komorebi
