#include "bvh/join_treelets.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "parallel/first_touch.h"

namespace komorebi {
namespace {

class TreeletJoiner {
 public:
  TreeletJoiner(const Items& items, const BinaryNode* top, const WideTreelet* treelets)
      : items_(items), top_(top), treelets_(treelets), kernel_(build_kernel()) {}

  /// Wide nodes of the top and inner roots, breadth-first: so siblings stand together, behind
  /// their parents. What is inside of treelets follows, in the order in which these were met.
  void lay_out() {
    add_place({0, 1, nullptr, 0});
    if (is_treelet(top_[0]) && !treelets_[top_[0].first].root[0].is_leaf()) {
      const std::uint32_t treelet = top_[0].first;
      places_[0] = {0, 1, treelets_[treelet].root_nodes, follow(treelet)};
    }
    for (std::size_t at = 0; at < places_.size(); ++at) {
      const Place place = places_[at];
      depth_ = std::max(depth_, place.level);
      if (place.root == nullptr) {
        nodes_.push_back(wide_node(place));
        continue;
      }
      const WideTreelet& treelet = treelets_[followers_[place.follower].treelet];
      depth_ = std::max(depth_, place.level + treelet.depth - 1);
      nodes_.push_back(*place.root);
    }
  }

  WideTree join(ThreadPool& pool, const Cancel& cancel) {
    const std::size_t unit = items_.leaf_unit();
    std::uint64_t nodes = nodes_.size(), leaves = leaves_.size() / unit;
    for (Follower& it : followers_) {
      it.node = static_cast<std::uint32_t>(nodes);
      it.leaf = static_cast<std::uint32_t>(leaves);
      nodes += treelets_[it.treelet].node_count;
      leaves += treelets_[it.treelet].leaf_units;
      if (nodes > kMaxItems || leaves > kMaxClusterUnits) {
        throw std::invalid_argument("a tree has too many items");
      }
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (places_[i].root != nullptr) move(nodes_[i], followers_[places_[i].follower]);
    }

    WideTree wide;
    wide.depth = depth_;
    wide.nodes.resize(nodes);
    std::byte* out = nullptr;
    if (items_.are_triangles()) {
      wide.clusters.resize(leaves * unit + kClusterSlack);
      out = wide.clusters.data();
      std::memset(out + leaves * unit, 0, kClusterSlack);
    } else {
      wide.leaves.resize(leaves);
      out = reinterpret_cast<std::byte*>(wide.leaves.data());
    }
    touch_pages(wide.nodes.data(), nodes * sizeof(WideNode), pool);
    touch_pages(out, leaves * unit, pool);
    pool.for_each_chunk(followers_.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && !cancel.raised(); ++i) {
        const Follower& it = followers_[i];
        const WideTreelet& from = treelets_[it.treelet];
        for (std::uint32_t k = 0; k < from.node_count; ++k) {
          WideNode node = from.nodes[k];
          move(node, it);
          wide.nodes[it.node + k] = node;
        }
        std::memcpy(out + it.leaf * unit, from.leaves, from.leaf_units * unit);
      }
    });
    check(cancel);
    std::copy(nodes_.begin(), nodes_.end(), wide.nodes.begin());
    std::copy(leaves_.begin(), leaves_.end(), out);
    return wide;
  }

 private:
  /// A wide node to be: one of the top, or a treelet's root.
  struct Place {
    std::uint32_t binary, level;
    const WideNode* root;
    std::uint32_t follower;
  };
  /// A treelet, and where its inside goes.
  struct Follower {
    std::uint32_t treelet, node, leaf;
  };
  struct Child {
    BinaryNode box;
    Place place;
    const std::byte* leaf;
  };

  void add_place(const Place& place) { places_.push_back(place); }
  std::uint32_t follow(std::uint32_t treelet) {
    followers_.push_back({treelet, 0, 0});
    return static_cast<std::uint32_t>(followers_.size() - 1);
  }
  static void move(WideNode& node, const Follower& to) {
    node.first_child += to.node;
    node.first_leaf += to.leaf;
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
    wide.first_child = static_cast<std::uint32_t>(places_.size());
    wide.first_leaf = static_cast<std::uint32_t>(leaves_.size() / items_.leaf_unit());
    std::memset(wide.leaf, 0, sizeof(wide.leaf));
    BinaryNode boxes[kWidth];
    const Child* sorted[kWidth];
    constexpr std::uint32_t kAll[kWidth] = {0, 1, 2, 3, 4, 5, 6, 7};
    for (int i = 0; i < order.count; ++i) {
      boxes[order.place[i]] = child[i].box;
      sorted[order.place[i]] = &child[i];
    }
    kernel_.quantise(boxes, kAll, order.count, wide);
    for (int i = 0; i < order.inner; ++i) add_place(sorted[i]->place);
    for (int i = order.inner; i < order.count; ++i) {
      const std::size_t at = leaves_.size() / items_.leaf_unit();
      wide.leaf[i] = static_cast<std::uint8_t>(at - wide.first_leaf);
      leaves_.insert(leaves_.end(), sorted[i]->leaf, sorted[i]->leaf + bytes_of(boxes[i]));
    }
    return wide;
  }

  template <class Add>
  void add_roots(std::uint32_t index, std::uint32_t level, const Add& add) {
    const WideTreelet& treelet = treelets_[index];
    const std::uint32_t follower = follow(index);
    const WideNode* root = treelet.root_nodes;
    const std::byte* leaf = treelet.root_leaves;
    for (std::uint32_t i = 0; i < treelet.root_count; ++i) {
      const BinaryNode& box = treelet.root[i];
      if (box.is_leaf()) {
        add({box, {}, leaf});
        leaf += bytes_of(box);
      } else {
        add({box, {0, level, root++, follower}, nullptr});
      }
    }
  }

  std::size_t bytes_of(const BinaryNode& leaf) const {
    return items_.leaf_units(leaf.leaf_count(), leaf.leaf_vertices()) * items_.leaf_unit();
  }

  const Items& items_;
  const BinaryNode* top_;
  const WideTreelet* treelets_;
  const BuildKernel& kernel_;
  std::vector<Place> places_;
  std::vector<Follower> followers_;
  std::vector<WideNode> nodes_;    ///< one for each place
  std::vector<std::byte> leaves_;  ///< treelets' roots that are leaves
  std::uint32_t depth_ = 0;
};

}  // namespace

WideTree join_treelets(const Items& items, const BinaryNode* top, const WideTreelet* treelets,
                       ThreadPool& pool, const Cancel& cancel) {
  TreeletJoiner joiner(items, top, treelets);
  joiner.lay_out();
  WideTree wide = joiner.join(pool, cancel);
  wide.bounds = top[0].box();
  return wide;
}

}  // namespace komorebi
