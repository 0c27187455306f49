// The final-quality builder: the surface-area heuristic at the cost of a few linear builds.
//
// Along the Morton curve, small clusters of neighbours are cheap to find. Planes that part the
// upper levels hardly ever cut through what a cluster holds, so these levels are split by binned
// SAH over clusters, a third as many as triangles (Ganestam et al. 2015, "Bonsai", has treelets in
// their place, and loses where Morton cells cut). Below, what has become small enough for a
// worker's nearest caches is split item by item: a strip (bvh/strip.h), or two neighbours on the
// curve that fill hardly more room than one.
#include <atomic>
#include <mutex>
#include <thread>

#include "bvh/grove.h"
#include "bvh/morton_order.h"
#include "bvh/topology.h"
#include "parallel/first_touch.h"

namespace komorebi {
namespace {

/// Clusters larger than so many median items are broken up: they would blunt the top's planes.
constexpr float kLargestCluster = 8.0f;
/// Ranges of no more clusters are finished by the worker that met them.
constexpr std::uint32_t kSmallRange = 4096;
/// Deepest level of the top that is split by area; then halves, at most 27 levels.
constexpr std::uint32_t kTopMedianDepth = 28;

/// A range on its way into the tree.
struct Part {
  std::uint32_t node, depth;
  ClusterRange range;
};

class SahBuilder {
 public:
  SahBuilder(const Items& items, const MortonOrder& order, TreeRoom room, ThreadPool& pool,
             const Cancel& cancel)
      : items_(items),
        order_(order),
        room_(std::move(room)),
        pool_(pool),
        cancel_(cancel),
        kernel_(build_kernel()),
        scale_(order.scale()),
        grove_(items, order.count, scale_, pool, cancel),
        moved_(order.count) {
    // About so many clusters there will be.
    touch_pages(moved_.data(), moved_.size() / 2 * sizeof(BinaryNode), pool);
  }

  WideTree build() {
    find_clusters();
    split_top();
    grow_treelets();
    return grove_.finish();
  }

 private:
  void find_clusters() {
    const std::size_t runs = (order_.count + kRunSize - 1) / kRunSize;
    std::vector<std::uint32_t> base(runs), count(runs);
    std::atomic<std::uint32_t> next{0};
    const ClusterLimits limits{kLargestCluster * order_.sample_area, scale_};
    pool_.for_each_chunk(runs, 4, [&](std::size_t begin, std::size_t end) {
      Scratch<Treelet> desk(1);
      Treelet& t = desk[0];
      for (std::size_t i = begin; i < end && !cancel_.raised(); ++i) {
        const auto first = static_cast<std::uint32_t>(i) * kRunSize;
        const Run run{first, std::min(kRunSize, order_.count - first)};
        KeyIndex<std::uint32_t> room[kRunSize];
        BinaryNode found[kRunSize];
        count[i] = kernel_.cluster(items_, order_.narrow_run(run, room), run.count, limits, first,
                                   t, found);
        base[i] = next.fetch_add(count[i]);
        std::copy_n(found, count[i], &moved_[base[i]]);
      }
    });
    check(cancel_);
    list_clusters(base, count);
  }

  /// Run by run, as their order would depend on the threads, and what all of them span.
  void list_clusters(const std::vector<std::uint32_t>& base,
                     const std::vector<std::uint32_t>& count) {
    std::vector<std::uint32_t> place(base.size() + 1, 0);
    for (std::size_t i = 0; i < base.size(); ++i) place[i + 1] = place[i] + count[i];
    cluster_count_ = place.back();
    cluster_ = Scratch<BinaryNode>(cluster_count_);
    touch_pages(cluster_.data(), cluster_count_ * sizeof(BinaryNode), pool_);
    all_ = {0, cluster_count_, 0, {}};
    std::fill_n(all_.centres.v, 8, kFloatMax);
    std::mutex mutex;
    pool_.for_each_chunk(base.size(), 32, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::copy_n(&moved_[base[i]], count[i], &cluster_[place[i]]);
      }
      ClusterRange part{place[begin], place[end], 0, {}};
      kernel_.measure(clusters(), part);
      const std::lock_guard lock(mutex);
      all_.triangles += part.triangles;
      for (int k = 0; k < 8; ++k) {
        all_.centres.v[k] = min_of(all_.centres.v[k], part.centres.v[k]);
      }
    });
  }

  Clusters clusters() { return {cluster_.data(), moved_.data()}; }

  /// Counts down, whichever way a part ends.
  struct AtEnd {
    std::atomic<std::size_t>& count;
    ~AtEnd() { --count; }
  };

  /// Large ranges wait in a list from which whoever is free takes one.
  void split_top() {
    treelets_ = Scratch<ClusterRange>(cluster_count_);
    std::vector<Part> waiting{{0, 0, all_}};
    waiting.reserve(2 * std::size_t{cluster_count_} / kSmallRange + 2);
    std::mutex mutex;  // guards `waiting`
    // Of parts that wait or are being split: when there are none, all are.
    std::atomic<std::size_t> unfinished{1};
    std::atomic<std::size_t> there{1};  // that wait
    const auto hand_over = [&](const Part& part) {
      const std::lock_guard lock(mutex);
      waiting.push_back(part);
      ++unfinished;
      ++there;
    };
    pool_.run(pool_.size(), [&](unsigned) {
      while (unfinished > 0) {
        // Who slept here would be woken late, and where the one runs that wakes it.
        if (there == 0) {
          std::this_thread::yield();
          continue;
        }
        std::unique_lock lock(mutex);
        if (waiting.empty()) continue;
        const Part part = waiting.back();
        waiting.pop_back();
        --there;
        lock.unlock();
        const AtEnd done{unfinished};
        split(part, hand_over);
      }
    });
    check(cancel_);
  }

  /// Parts a range until it is treelets, but for those of its parts that others may do.
  void split(const Part& part, FunctionRef<void(const Part&)> hand_over) {
    if (part.range.triangles <= kTreeletSize) {
      const std::uint32_t treelet = treelet_count_.fetch_add(1);
      treelets_[treelet] = part.range;
      grove_.mark_treelet(part.node, treelet);
      WideBox box;
      kernel_.bound(clusters(), part.range, &box);
      for (int axis = 0; axis < 3; ++axis) {
        grove_.node(part.node).lo[axis] = box.v[axis];
        grove_.node(part.node).minus_hi[axis] = box.v[4 + axis];
      }
      return;
    }
    if (cancel_.raised()) return;
    const std::uint32_t child = grove_.claim(2);
    grove_.node(part.node).first = child;
    grove_.node(part.node).info = kInnerBit;
    Part left{child, part.depth + 1, {}}, right = left;
    right.node = child + 1;
    kernel_.split(clusters(), scale_, part.depth >= kTopMedianDepth, part.range, &left.range,
                  &right.range);
    if (right.range.end - right.range.begin > kSmallRange) {
      hand_over(right);
    } else {
      split(right, hand_over);
    }
    split(left, hand_over);
  }

  /// Along the top tree: the order in which they were made depends on the threads.
  void number_treelets(std::uint32_t node, std::vector<std::uint32_t>& order) {
    BinaryNode& it = grove_.node(node);
    if (is_treelet(it)) {
      order.push_back(it.first);
      it.first = static_cast<std::uint32_t>(order.size() - 1);
      return;
    }
    number_treelets(it.first, order);
    number_treelets(it.first + 1, order);
  }

  void grow_treelets() {
    std::vector<std::uint32_t> order;
    order.reserve(treelet_count_);
    number_treelets(0, order);
    grove_.plan_top(treelet_count_);
    const auto load = [&](std::uint32_t i, Treelet& t) {
      const ClusterRange& range = treelets_[order[i]];
      KeyIndex<std::uint32_t> strips[kTreeletSize];
      std::uint32_t count = 0;
      for (std::uint32_t c = range.begin; c < range.end; ++c) {
        const BinaryNode& cluster = cluster_[c];
        const ClusterInfo info(cluster.info);
        for (std::uint32_t k = 0; k < info.strips; ++k) {
          strips[count++] = {info.joined >> k & 1u, order_.strip(cluster.first + k)};
        }
      }
      kernel_.load(items_, strips, count, t);
    };
    room_.back(pool_, [] {});
    grove_.grow(treelet_count_, load, kernel_.sah_treelet, std::move(room_));
  }

  const Items& items_;
  const MortonOrder& order_;
  TreeRoom room_;
  ThreadPool& pool_;
  const Cancel& cancel_;
  const BuildKernel& kernel_;
  float scale_;
  Grove grove_;
  Scratch<BinaryNode> moved_;    ///< at first clusters as they were found
  Scratch<BinaryNode> cluster_;  ///< `first`: in the order along the curve
  std::uint32_t cluster_count_ = 0;
  ClusterRange all_;
  Scratch<ClusterRange> treelets_;
  std::atomic<std::uint32_t> treelet_count_{0};
};

}  // namespace

WideTree grow_sah(const Items& items, ThreadPool& pool, const Cancel& cancel) {
  TreeRoom room(items);
  const MortonOrder order = order_by_morton(items, room.leaves(), pool, cancel);
  WideTree wide;
  if (order.count > 0) wide = SahBuilder(items, order, std::move(room), pool, cancel).build();
  wide.left_out = order.left_out;
  return wide;
}

}  // namespace komorebi
