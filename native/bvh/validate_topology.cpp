#include "bvh/validate.h"

namespace komorebi {
namespace {

/// Walks down from the root with an explicit stack; the first complaint wins.
class TopologyValidator {
 public:
  TopologyValidator(const Topology& topology, std::span<const Aabb> boxes)
      : topology_(topology), boxes_(boxes), seen_(topology.left.size(), false) {}

  std::string run() {
    const std::size_t count = boxes_.size();
    const std::size_t inner = count > 1 ? count - 1 : 0;
    if (topology_.order.size() != count) return "order has not one position per item";
    if (topology_.left.size() != inner || topology_.right.size() != inner ||
        topology_.first.size() != inner || topology_.last.size() != inner ||
        topology_.bounds.size() != inner) {
      return "there is not one inner node less than items";
    }
    std::vector<bool> placed(count, false);
    for (const std::uint32_t item : topology_.order) {
      if (item >= count) return "order names item " + std::to_string(item);
      if (placed[item]) return "item " + std::to_string(item) + " has two positions";
      placed[item] = true;
    }
    if (count == 0) return topology_.root == kNone ? "" : "an empty tree has a root";
    return descend();
  }

 private:
  struct Visit {
    std::uint32_t node, first, last, level;
    const Aabb* parent;
  };

  std::string descend() {
    const auto last = static_cast<std::uint32_t>(boxes_.size() - 1);
    std::vector<Visit> stack{{topology_.root, 0, last, 0, nullptr}};
    std::uint32_t depth = 0;
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      depth = std::max(depth, visit.level);
      if (visit.node & kLeafBit) {
        const std::uint32_t position = visit.node & ~kLeafBit;
        if (visit.first != visit.last || position != visit.first) {
          return "leaf at position " + std::to_string(position) + " does not cover its range";
        }
        if (!inside(visit, boxes_[topology_.order[position]])) {
          return "the item at position " + std::to_string(position) + " leaves its parent's box";
        }
        continue;
      }
      if (std::string complaint = expand(visit, stack); !complaint.empty()) return complaint;
    }
    if (depth != topology_.depth) {
      return "depth is " + std::to_string(depth) + ", not " + std::to_string(topology_.depth);
    }
    return depth <= kMaxDepth ? "" : "the tree is deeper than kMaxDepth";
  }

  std::string expand(const Visit& visit, std::vector<Visit>& stack) {
    const std::uint32_t node = visit.node;
    const std::string name = "node " + std::to_string(node);
    if (node >= seen_.size()) return name + " does not exist";
    if (seen_[node]) return name + " has two parents";
    seen_[node] = true;
    if (topology_.first[node] != visit.first || topology_.last[node] != visit.last) {
      return name + " does not cover the range that its parent gives it";
    }
    if (!inside(visit, topology_.bounds[node])) return name + " leaves its parent's box";
    // The left child's own last position says where the range is parted.
    const std::uint32_t left = topology_.left[node];
    std::uint32_t middle = left & ~kLeafBit;
    if ((left & kLeafBit) == 0) {
      if (left >= seen_.size()) return "node " + std::to_string(left) + " does not exist";
      middle = topology_.last[left];
    }
    if (middle < visit.first || middle >= visit.last) return name + " has an empty child";
    const Aabb* box = &topology_.bounds[node];
    stack.push_back({topology_.right[node], middle + 1, visit.last, visit.level + 1, box});
    stack.push_back({left, visit.first, middle, visit.level + 1, box});
    return "";
  }

  static bool inside(const Visit& visit, const Aabb& box) {
    return visit.parent == nullptr || contains(*visit.parent, box);
  }

  const Topology& topology_;
  std::span<const Aabb> boxes_;
  std::vector<bool> seen_;
};

}  // namespace

std::string validate(const Topology& topology, std::span<const Aabb> boxes) {
  return TopologyValidator(topology, boxes).run();
}

}  // namespace komorebi
