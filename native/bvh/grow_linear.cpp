// A linear BVH (Lauterbach et al. 2009): Morton codes, one sort, and a hierarchy that follows from
// the codes alone, treelet by treelet in a worker's caches.
#include "bvh/grove.h"
#include "bvh/morton_order.h"
#include "bvh/topology.h"

namespace komorebi {

BinaryTree grow_linear(const Items& items, ThreadPool& pool, const Cancel& cancel,
                       std::uint32_t* left_out) {
  const MortonOrder order = order_by_morton(items, pool, cancel);
  *left_out = order.left_out;
  if (order.count == 0) return {};
  RunTree top;
  top.cut(order, kRunSize);

  Grove grove(order.count, 1.0f / max_of(order.largest_side, 1e-30f));
  grove.claim(static_cast<std::uint32_t>(top.nodes.size()) - 1);
  for (std::uint32_t i = 0; i < top.nodes.size(); ++i) {
    const RunTree::Node& node = top.nodes[i];
    if (node.is_run) {
      grove.mark_treelet(i, node.first);
    } else {
      grove.node(i).first = node.first;
      grove.node(i).info = kInnerBit;
    }
  }
  std::vector<BinaryNode> roots(top.runs.size());
  std::vector<PlanCost> costs(top.runs.size());
  const BuildKernel& kernel = build_kernel();
  pool.for_each_chunk(top.runs.size(), 4, [&](std::size_t begin, std::size_t end) {
    Scratch<Treelet> desk(1);
    Treelet& t = desk[0];
    std::uint32_t indices[kRunSize];
    for (std::size_t i = begin; i < end && !cancel.raised(); ++i) {
      const RunTree::Run run = top.runs[i];
      for (std::uint32_t k = 0; k < run.count; ++k) {
        indices[k] = order.item(run.first + k);
        t.code[k] = order.code(run.first + k);
      }
      t.count = 0;
      kernel.load(items, indices, run.count, t);
      kernel.linear(t.code, items.leaf, 0.0f, t);
      grove.plant(t, run.first, &roots[i], &costs[i]);
    }
  });
  check(cancel);
  return grove.finish(roots, costs);
}

}  // namespace komorebi
