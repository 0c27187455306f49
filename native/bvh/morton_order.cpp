#include "bvh/morton_order.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <mutex>
#include <vector>

#include "bvh/topology.h"
#include "bvh/treelet.h"
#include "parallel/first_touch.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = 16384;
constexpr std::size_t kSamples = 1024;

/// Bounds of all vertices, or of all boxes.
Aabb extent(const Items& items, ThreadPool& pool, const Cancel& cancel) {
  Aabb all;
  std::mutex mutex;
  const std::size_t count = items.are_triangles() ? items.vtx2xyz.size() / 3 : items.boxes.size();
  pool.for_each_chunk(count, 4 * kGrain, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) return;
    Aabb part;
    if (items.are_triangles()) {
      const float* xyz = items.vtx2xyz.data();
      for (std::size_t i = begin; i < end; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          const float x = xyz[3 * i + static_cast<std::size_t>(axis)];
          part.lo[axis] = min_of(part.lo[axis], x);
          part.hi[axis] = max_of(part.hi[axis], x);
        }
      }
    } else {
      for (std::size_t i = begin; i < end; ++i) {
        if (!items.boxes[i].is_empty()) part = united(part, items.boxes[i]);
      }
    }
    const std::lock_guard lock(mutex);
    all = united(all, part);  // min and max: the order does not show
  });
  return all;
}

template <class T>
Scratch<T> touched(std::size_t count, ThreadPool& pool) {
  Scratch<T> scratch(count);
  touch_pages(scratch.data(), count * sizeof(T), pool);
  return scratch;
}

/// Asks for what a walk of this stride reads some steps later: each is in a page of its own.
void fetch_later(const Items& items, std::size_t i, std::size_t stride) {
  constexpr std::size_t kIndicesAhead = 32, kVerticesAhead = 16;
#if defined(__GNUC__)
  if (!items.are_triangles() || i + kIndicesAhead * stride >= items.count()) return;
  __builtin_prefetch(&items.tri2vtx[3 * (i + kIndicesAhead * stride)]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t vertex = items.tri2vtx[3 * (i + kVerticesAhead * stride) + k];
    __builtin_prefetch(&items.vtx2xyz[3 * vertex]);
  }
#endif
}

std::vector<Aabb> sample_of(const Items& items) {
  std::vector<Aabb> sample;
  const std::size_t count = items.count();
  const std::size_t stride = std::max<std::size_t>(1, count / kSamples);
  sample.reserve(count / stride + 1);
  for (std::size_t i = 0; i < count; i += stride) {
    fetch_later(items, i, stride);
    if (!items.is_left_out(i)) sample.push_back(items.box(i));
  }
  for (std::size_t i = 0; i < count && sample.empty(); ++i) {
    if (!items.is_left_out(i)) sample.push_back(items.box(i));
  }
  return sample;
}

float median_area(const std::vector<Aabb>& sample) {
  std::vector<float> areas;
  areas.reserve(sample.size());
  for (const Aabb& box : sample) areas.push_back(half_area(box));
  if (areas.empty()) return 0.0f;
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return *middle;
}

/// The last position of [first, last) whose code agrees with the first one's down to the highest
/// bit in which the range differs, plus one; the middle for equal codes.
std::uint32_t split_of(const MortonOrder& order, std::uint32_t first, std::uint32_t last) {
  const std::uint64_t start = order.code(first), differ = start ^ order.code(last - 1);
  if (differ == 0) return first + (last - first) / 2;
  std::uint32_t low = first, high = last - 1;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    const std::uint64_t d = start ^ order.code(middle);
    // The highest bit of `differ` is set in d too: then d ^ differ lost it.
    ((d ^ differ) < d ? high : low) = middle;
  }
  return high;
}

}  // namespace

MortonOrder order_by_morton(const Items& items, ThreadPool& pool, const Cancel& cancel) {
  MortonOrder order;
  const auto total = static_cast<std::uint32_t>(items.count());
  const Aabb all = extent(items, pool, cancel);
  check(cancel);
  const std::vector<Aabb> sample = sample_of(items);
  const MortonGrid grid = choose_morton_grid(all, sample);
  order.sample_area = median_area(sample);
  order.largest_side = all.is_empty() ? 0.0f
                                      : max_of(max_of(all.hi.x - all.lo.x, all.hi.y - all.lo.y),
                                               all.hi.z - all.lo.z);

  // What is left out sorts behind everything; bits that no code has are not sorted by.
  std::atomic<std::uint32_t> left_out{0};
  const BuildKernel& kernel = build_kernel();
  if (grid.wide) {
    order.wide = touched<KeyIndex<std::uint64_t>>(total, pool);
    pool.for_each_chunk(total, kGrain, [&](std::size_t begin, std::size_t end) {
      if (cancel.raised()) return;
      for (std::size_t i = begin; i < end; ++i) {
        const bool left = items.is_left_out(i);
        const std::uint64_t code = left ? ~std::uint64_t{0} : grid.code_63(items.box(i));
        order.wide[i] = {code, static_cast<std::uint32_t>(i)};
        if (left) ++left_out;
      }
    });
    check(cancel);
    using Item = KeyIndex<std::uint64_t>;
    Scratch<Item> scratch = touched<Item>(total, pool);
    // A code of all ones is that of the last cell of all, too: whatever has it is told apart here.
    radix_sort({order.wide.data(), total}, {scratch.data(), total}, pool, cancel);
    const auto* const behind =
        std::lower_bound(order.wide.begin(), order.wide.end(), ~std::uint64_t{0},
                         [](const Item& item, std::uint64_t code) { return item.key < code; });
    auto kept = static_cast<std::uint32_t>(behind - order.wide.begin());
    for (std::uint32_t i = kept; i < total && left_out > 0; ++i) {
      if (!items.is_left_out(order.wide[i].index)) order.wide[kept++] = order.wide[i];
    }
  } else {
    order.narrow = touched<KeyIndex<std::uint32_t>>(total, pool);
    pool.for_each_chunk(total, kGrain, [&](std::size_t begin, std::size_t end) {
      if (cancel.raised()) return;
      left_out += kernel.code(items, grid, static_cast<std::uint32_t>(begin),
                              static_cast<std::uint32_t>(end), 0x80000000u, order.narrow.data());
    });
    check(cancel);
    using Item = KeyIndex<std::uint32_t>;
    Scratch<Item> scratch = touched<Item>(total, pool);
    const unsigned bits = left_out > 0 ? 32 : grid.is_one ? 30 : 31;
    radix_sort({order.narrow.data(), total}, {scratch.data(), total}, pool, cancel, bits);
  }
  order.left_out = left_out;
  order.count = total - left_out;
  return order;
}

void MortonOrder::copy_run(Run run, std::uint32_t* items, std::uint32_t* codes) const {
  if (wide.size() == 0) {
    for (std::uint32_t k = 0; k < run.count; ++k) {
      items[k] = narrow[run.first + k].index;
      codes[k] = narrow[run.first + k].key;
    }
    return;
  }
  const std::uint64_t differ = wide[run.first].key ^ wide[run.first + run.count - 1].key;
  const int shift = std::max(0, 33 - std::countl_zero(differ));
  for (std::uint32_t k = 0; k < run.count; ++k) {
    items[k] = wide[run.first + k].index;
    codes[k] = static_cast<std::uint32_t>(wide[run.first + k].key >> shift) & 0x7fffffffu;
  }
}

void RunTree::cut(const MortonOrder& order, std::uint32_t most) {
  if (order.count == 0) return;
  nodes.push_back({});
  cut(order, most, 0, 0, order.count);
}

void RunTree::cut(const MortonOrder& order, std::uint32_t most, std::size_t node,
                  std::uint32_t first, std::uint32_t last) {
  if (last - first <= most) {
    nodes[node] = {static_cast<std::uint32_t>(runs.size()), true};
    runs.push_back({first, last - first});
    return;
  }
  const std::uint32_t middle = split_of(order, first, last);
  const std::size_t child = nodes.size();
  nodes[node] = {static_cast<std::uint32_t>(child), false};
  nodes.resize(child + 2);
  cut(order, most, child, first, middle);
  cut(order, most, child + 1, middle, last);
}

}  // namespace komorebi
