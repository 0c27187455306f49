#include "bvh/treelet_row.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "parallel/pages.h"

namespace komorebi {
namespace {

std::size_t count_roots(std::span<const WideTreelet> treelets) {
  std::size_t count = 0;
  for (const WideTreelet& treelet : treelets) count += treelet.room;
  return count;
}

}  // namespace

TreeletRow::TreeletRow(const Items& items, std::span<WideTreelet> treelets, TreeRoom room)
    : items_(items), treelets_(treelets), room_(std::move(room)), roots_(count_roots(treelets)) {}

TreeletRow::Shelf TreeletRow::take_shelf(std::uint32_t treelet, std::size_t items) {
  Shelf shelf;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      shelf = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (shelf.nodes.size() < items) {
    const std::size_t room =
        std::max<std::size_t>(items, std::min<std::size_t>(kTreeletSize, items_.count()));
    shelf.nodes = Scratch<WideNode>(room);
    shelf.leaves = Scratch<std::byte>(room * kLeafBytes + kLeafCopied);
  }
  treelets_[treelet].root_nodes = shelf.nodes.data();
  treelets_[treelet].root_leaves = shelf.leaves.data();
  return shelf;
}

void TreeletRow::put(std::uint32_t treelet, Shelf shelf) {
  keep_roots(treelets_[treelet]);
  std::vector<Done> ready;
  std::size_t nodes[2], leaves[2];  // huge pages to be backed
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({treelet, std::move(shelf)});
    find_places(ready);
    // One page ahead of what is written: two workers that write to a fresh page clear two.
    const auto advance = [](std::size_t bytes, std::size_t& backed, std::size_t* pages) {
      pages[0] = backed;
      backed = pages[1] = std::max(backed, bytes / kHugePage + 2);
    };
    advance(node_end_ * sizeof(WideNode), room_.nodes_backed, nodes);
    advance(leaf_end_ * items_.leaf_unit(), room_.leaves_backed, leaves);
  }
  room_.nodes.back(nodes[0] * kHugePage, nodes[1] * kHugePage);
  room_.clusters.back(leaves[0] * kHugePage, leaves[1] * kHugePage);
  for (const Done& done : ready) move_in(treelets_[done.treelet]);
  const std::lock_guard lock(mutex_);
  for (Done& done : ready) free_.push_back(std::move(done.shelf));
}

void TreeletRow::keep_roots(WideTreelet& treelet) {
  const auto count = static_cast<std::uint32_t>(treelet.nodes - treelet.root_nodes);
  WideNode* const kept = roots_.data() + root_count_.fetch_add(count);
  std::copy_n(treelet.root_nodes, count, kept);
  treelet.root_nodes = kept;
  const auto bytes = static_cast<std::size_t>(treelet.leaves - treelet.root_leaves);
  if (bytes == 0) return;
  Scratch<std::byte> leaves(bytes);
  std::copy_n(treelet.root_leaves, bytes, leaves.data());
  treelet.root_leaves = leaves.data();
  const std::lock_guard lock(mutex_);
  root_leaves_.push_back(std::move(leaves));
}

void TreeletRow::find_places(std::vector<Done>& ready) {
  for (std::size_t i = 0; i < waiting_.size();) {
    if (waiting_[i].treelet != next_) {
      ++i;
      continue;
    }
    WideTreelet& treelet = treelets_[next_++];
    const std::uint64_t leaf_end = std::uint64_t{leaf_end_} + treelet.leaf_units;
    if (leaf_end > kMaxClusterUnits) throw std::invalid_argument("a tree has too many items");
    treelet.first_node = node_end_;
    treelet.first_leaf = leaf_end_;
    node_end_ += treelet.node_count;
    leaf_end_ = static_cast<std::uint32_t>(leaf_end);
    ready.push_back(std::move(waiting_[i]));
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
  }
}

void TreeletRow::move_in(const WideTreelet& treelet) {
  WideNode* const to = room_.nodes.room() + treelet.first_node;
  for (std::uint32_t k = 0; k < treelet.node_count; ++k) {
    WideNode node = treelet.nodes[k];
    node.first_child += treelet.first_node;
    node.first_leaf += treelet.first_leaf;
    to[k] = node;
  }
  const std::size_t unit = items_.leaf_unit();
  std::memcpy(leaf_room() + treelet.first_leaf * unit, treelet.leaves, treelet.leaf_units * unit);
}

void TreeletRow::finish(std::span<const WideNode> top, std::span<const std::byte> leaves,
                        WideTree& wide) {
  room_.nodes.room()[0] = top[0];
  std::copy(top.begin() + 1, top.end(), room_.nodes.room() + node_end_);
  const std::size_t unit = items_.leaf_unit(), leaf_bytes = leaf_end_ * unit;
  std::copy(leaves.begin(), leaves.end(), leaf_room() + leaf_bytes);
  const std::size_t end = leaf_bytes + leaves.size();
  room_.nodes.end_at(node_end_ + top.size() - 1);
  wide.nodes = std::move(room_.nodes);
  if (items_.are_triangles()) {
    std::memset(room_.clusters.room() + end, 0, kClusterSlack);
    room_.clusters.end_at(end + kClusterSlack);
    wide.clusters = std::move(room_.clusters);
  } else {
    room_.box_leaves.end_at(end / unit);
    wide.leaves = std::move(room_.box_leaves);
  }
}

}  // namespace komorebi
