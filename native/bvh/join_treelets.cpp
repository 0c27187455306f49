#include "bvh/join_treelets.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace komorebi {
namespace {

class TreeletJoiner {
 public:
  TreeletJoiner(const Items& items, const BinaryNode* top, const WideTreelet* treelets,
                TreeletRow& row)
      : items_(items), top_(top), treelets_(treelets), row_(row), kernel_(build_kernel()) {}

  /// Wide nodes of the top and inner roots, breadth-first: so siblings stand together.
  void lay_out() {
    places_.reserve(2 * row_.root_room());
    nodes_.reserve(2 * row_.root_room());
    places_.push_back({0, 1, nullptr, 0});
    if (is_treelet(top_[0]) && !treelets_[top_[0].first].root[0].is_leaf()) {
      const std::uint32_t treelet = top_[0].first;
      places_[0] = {0, 1, treelets_[treelet].root_nodes, treelet};
    }
    for (std::size_t at = 0; at < places_.size(); ++at) {
      const Place place = places_[at];
      depth_ = std::max(depth_, place.level);
      if (place.root == nullptr) {
        nodes_.push_back(wide_node(place));
        continue;
      }
      const WideTreelet& treelet = treelets_[place.treelet];
      depth_ = std::max(depth_, place.level + treelet.depth - 1);
      WideNode& node = nodes_.emplace_back(*place.root);
      node.first_child += treelet.first_node;
      node.first_leaf += treelet.first_leaf;
    }
  }

  WideTree join() {
    const std::size_t leaves = row_.leaf_end() + leaves_.size() / items_.leaf_unit();
    if (leaves > kMaxClusterUnits) throw std::invalid_argument("a tree has too many items");
    WideTree wide;
    wide.depth = depth_;
    row_.finish(nodes_, leaves_, wide);
    return wide;
  }

 private:
  /// A wide node to be: one of the top, or a treelet's root.
  struct Place {
    std::uint32_t binary, level;
    const WideNode* root;
    std::uint32_t treelet;
  };
  struct Child {
    BinaryNode box;
    Place place;
    const std::byte* leaf;
  };

  /// The root stands first, all others behind the insides of treelets.
  std::uint32_t next_index() const {
    return row_.node_end() + static_cast<std::uint32_t>(places_.size()) - 1;
  }

  WideNode wide_node(const Place& place) {
    Child child[kWidth];
    ChildOrder order;
    OpenNodes open(top_);
    if (is_treelet(top_[place.binary])) {
      open.push(place.binary, 1);
    } else {
      open.push_wide(place.binary);
    }
    const Vec3 step = step_of(top_[place.binary]);
    std::uint32_t node = 0;
    int room = 0;
    const auto add = [&](const Child& its) {
      child[order.count] = its;
      order.add(its.box);
    };
    while (open.pop(step, &node, &room)) {
      if (is_treelet(top_[node])) {
        add_roots(top_[node].first, place.level + 1, add);
      } else {
        add({top_[node], {node, place.level + 1, nullptr, 0}, nullptr});
      }
    }

    WideNode wide;
    wide.counts = static_cast<std::uint8_t>(order.inner | order.count << 4);
    wide.first_child = next_index();
    const std::size_t leaf_end = row_.leaf_end();
    wide.first_leaf = static_cast<std::uint32_t>(leaf_end + leaves_.size() / items_.leaf_unit());
    std::memset(wide.leaf, 0, sizeof(wide.leaf));
    BinaryNode boxes[kWidth];
    const Child* sorted[kWidth];
    constexpr std::uint32_t kAll[kWidth] = {0, 1, 2, 3, 4, 5, 6, 7};
    for (int i = 0; i < order.count; ++i) {
      boxes[order.place[i]] = child[i].box;
      sorted[order.place[i]] = &child[i];
    }
    kernel_.quantise(boxes, kAll, order.count, wide);
    for (int i = 0; i < order.inner; ++i) places_.push_back(sorted[i]->place);
    for (int i = order.inner; i < order.count; ++i) {
      const std::size_t at = leaf_end + leaves_.size() / items_.leaf_unit();
      wide.leaf[i] = static_cast<std::uint8_t>(at - wide.first_leaf);
      leaves_.insert(leaves_.end(), sorted[i]->leaf, sorted[i]->leaf + bytes_of(boxes[i]));
    }
    return wide;
  }

  template <class Add>
  void add_roots(std::uint32_t index, std::uint32_t level, const Add& add) {
    const WideTreelet& treelet = treelets_[index];
    const WideNode* root = treelet.root_nodes;
    const std::byte* leaf = treelet.root_leaves;
    for (std::uint32_t i = 0; i < treelet.root_count; ++i) {
      const BinaryNode& box = treelet.root[i];
      if (box.is_leaf()) {
        add({box, {}, leaf});
        leaf += bytes_of(box);
      } else {
        add({box, {0, level, root++, index}, nullptr});
      }
    }
  }

  std::size_t bytes_of(const BinaryNode& leaf) const {
    return items_.leaf_units(leaf.leaf_count(), leaf.leaf_vertices()) * items_.leaf_unit();
  }

  const Items& items_;
  const BinaryNode* top_;
  const WideTreelet* treelets_;
  TreeletRow& row_;
  const BuildKernel& kernel_;
  std::vector<Place> places_;
  std::vector<WideNode> nodes_;    ///< one for each place
  std::vector<std::byte> leaves_;  ///< treelets' roots that are leaves
  std::uint32_t depth_ = 0;
};

}  // namespace

WideTree join_treelets(const Items& items, const BinaryNode* top, const WideTreelet* treelets,
                       TreeletRow& row) {
  TreeletJoiner joiner(items, top, treelets, row);
  joiner.lay_out();
  WideTree wide = joiner.join();
  wide.bounds = top[0].box();
  return wide;
}

}  // namespace komorebi
