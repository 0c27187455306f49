#pragma once

#include <atomic>
#include <mutex>
#include <span>
#include <vector>

#include "bvh/tree_room.h"
#include "bvh/treelet.h"
#include "bvh/wide_tree.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// Treelets' wide nodes and leaves go into the tree one behind the other, in the treelets' order,
/// whoever ends first: so the bytes are the same for any number of threads, and each is written
/// to fresh memory once. A treelet lies on a shelf, in a worker's caches, until those before it are
/// done.
///
/// Node 0, the root, is left free; the roots of treelets, and what is above them, come last.
class TreeletRow {
 public:
  struct Shelf {
    Scratch<WideNode> nodes;
    Scratch<std::byte> leaves;
  };

  TreeletRow(const Items& items, std::span<WideTreelet> treelets, TreeRoom room);

  /// Room for a treelet of so many items, to be written from treelet.root_nodes and
  /// treelet.root_leaves on.
  Shelf take_shelf(std::uint32_t treelet, std::size_t items);
  /// The treelet is done: its inside moves to its place as soon as that is known, its roots are
  /// kept. @throws std::invalid_argument: too many items
  void put(std::uint32_t treelet, Shelf shelf);

  /// Treelets have no more roots.
  std::size_t root_room() const { return roots_.size(); }
  /// When all are there: what stands behind them.
  std::uint32_t node_end() const { return node_end_; }
  std::uint32_t leaf_end() const { return leaf_end_; }  ///< in units
  /// Puts the root and what comes last into place. The tree's arrays are then whole.
  void finish(std::span<const WideNode> top, std::span<const std::byte> leaves, WideTree& wide);

 private:
  struct Done {
    std::uint32_t treelet;
    Shelf shelf;
  };
  void keep_roots(WideTreelet& treelet);
  void find_places(std::vector<Done>& ready);
  void move_in(const WideTreelet& treelet);
  std::byte* leaf_room() { return room_.leaves().data(); }

  const Items& items_;
  std::span<WideTreelet> treelets_;
  TreeRoom room_;
  Scratch<WideNode> roots_;
  std::atomic<std::uint32_t> root_count_{0};

  std::mutex mutex_;  ///< guards everything below, and the numbers in room_
  std::vector<Shelf> free_;
  std::vector<Done> waiting_;  ///< for those before them
  std::uint32_t next_ = 0;     ///< treelet to be placed
  std::uint32_t node_end_ = 1, leaf_end_ = 0;
  std::vector<Scratch<std::byte>> root_leaves_;
};

}  // namespace komorebi
