#include "bvh/morton_order.h"

#include <algorithm>
#include <bit>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "bvh/topology.h"
#include "bvh/treelet.h"
#include "parallel/first_touch.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = 16384;
/// Items are looked at in so many places, in each a few that stand together in memory.
constexpr std::size_t kPlaces = 256, kInPlace = 4;
/// Workers take so many parts of the sample.
constexpr std::size_t kSampleParts = 4;

/// Asks for what a walk of this stride reads some steps later: each is in a page of its own.
void fetch_later(const Items& items, std::size_t i, std::size_t stride) {
  constexpr std::size_t kIndicesAhead = 16, kVerticesAhead = 8;
#if defined(__GNUC__)
  if (!items.are_triangles() || i + kIndicesAhead * stride >= items.count()) return;
  __builtin_prefetch(&items.tri2vtx[3 * (i + kIndicesAhead * stride)]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t vertex = items.tri2vtx[3 * (i + kVerticesAhead * stride) + k];
    __builtin_prefetch(&items.vtx2xyz[3 * vertex]);
  }
#endif
}

/// One part of some boxes from everywhere.
std::vector<Aabb> sample_part(const Items& items, std::size_t part) {
  std::vector<Aabb> boxes;
  const std::size_t stride = std::max(kInPlace, items.count() / kPlaces);
  const std::size_t places = (items.count() + stride - 1) / stride;
  const std::size_t end = places * (part + 1) / kSampleParts;
  boxes.reserve(kInPlace * (places / kSampleParts + 1));
  for (std::size_t place = places * part / kSampleParts; place < end; ++place) {
    const std::size_t first = place * stride, last = std::min(first + kInPlace, items.count());
    fetch_later(items, first, stride);
    for (std::size_t i = first; i < last; ++i) {
      if (!items.is_left_out(i)) boxes.push_back(items.box(i));
    }
  }
  return boxes;
}

/// Bounds of some vertices, or of some boxes.
Aabb extent(const Items& items, std::size_t begin, std::size_t end) {
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
  return part;
}

/// What is known of all items before their codes.
struct Overview {
  Aabb all;
  std::vector<Aabb> sample;
};

Overview look_over(const Items& items, ThreadPool& pool, const Cancel& cancel) {
  Overview overview;
  std::mutex mutex;
  const std::size_t count = items.are_triangles() ? items.vtx2xyz.size() / 3 : items.boxes.size();
  std::vector<Aabb> sample[kSampleParts];
  // The first chunks are the sample, which waits for memory most of the time.
  const std::size_t chunks = kSampleParts + (count + 4 * kGrain - 1) / (4 * kGrain);
  pool.for_each_chunk(chunks, 1, [&](std::size_t chunk, std::size_t) {
    if (cancel.raised()) return;
    if (chunk < kSampleParts) {
      sample[chunk] = sample_part(items, chunk);
      return;
    }
    const std::size_t begin = (chunk - kSampleParts) * 4 * kGrain;
    const Aabb part = extent(items, begin, std::min(count, begin + 4 * kGrain));
    const std::lock_guard lock(mutex);
    overview.all = united(overview.all, part);  // min and max: the order does not show
  });
  check(cancel);
  for (const auto& part : sample) {
    overview.sample.insert(overview.sample.end(), part.begin(), part.end());
  }
  // All that was looked at is left out: any other one will do.
  for (std::size_t i = 0; i < items.count() && overview.sample.empty(); ++i) {
    if (!items.is_left_out(i)) overview.sample.push_back(items.box(i));
  }
  return overview;
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

/// `code`: of the build kernel. Counts go to `order`.
template <class Key>
Scratch<KeyIndex<Key>> sorted_strips(const Items& items,
                                     StripCount (*code)(const Items&, const MortonGrid&,
                                                        std::uint32_t, std::uint32_t,
                                                        KeyIndex<Key>*),
                                     const MortonGrid& grid, unsigned bits,
                                     std::span<std::byte> spare, ThreadPool& pool,
                                     const Cancel& cancel, MortonOrder& order) {
  const std::size_t total = items.count();
  Scratch<KeyIndex<Key>> own;
  if (spare.size() < total * sizeof(KeyIndex<Key>)) own = Scratch<KeyIndex<Key>>(total);
  KeyIndex<Key>* const found =
      own.size() > 0 ? own.data() : reinterpret_cast<KeyIndex<Key>*>(spare.data());
  touch_pages(found, total * sizeof(KeyIndex<Key>), pool);
  std::vector<StripCount> counts((total + kGrain - 1) / kGrain, StripCount{0, 0});
  pool.for_each_chunk(counts.size(), 1, [&](std::size_t chunk, std::size_t) {
    if (cancel.raised()) return;
    const std::size_t begin = chunk * kGrain, end = std::min(total, begin + kGrain);
    counts[chunk] = code(items, grid, static_cast<std::uint32_t>(begin),
                         static_cast<std::uint32_t>(end), found + begin);
  });
  check(cancel);
  std::vector<std::span<const KeyIndex<Key>>> pieces;
  for (std::size_t chunk = 0; chunk < counts.size(); ++chunk) {
    pieces.emplace_back(found + chunk * kGrain, counts[chunk].strips);
    order.count += counts[chunk].strips;
    order.left_out += counts[chunk].left_out;
  }
  Scratch<KeyIndex<Key>> sorted(order.count);
  touch_pages(sorted.data(), order.count * sizeof(KeyIndex<Key>), pool);
  radix_sort(pieces, {sorted.data(), sorted.size()}, pool, cancel, bits);
  return sorted;
}

}  // namespace

MortonOrder order_by_morton(const Items& items, std::span<std::byte> spare, ThreadPool& pool,
                            const Cancel& cancel) {
  MortonOrder order;
  if (items.count() > kMostStrips) throw std::invalid_argument("a tree has too many items");
  const auto [all, sample] = look_over(items, pool, cancel);
  const MortonGrid grid = choose_morton_grid(all, sample);
  order.sample_area = median_area(sample);
  order.largest_side = all.is_empty() ? 0.0f
                                      : max_of(max_of(all.hi.x - all.lo.x, all.hi.y - all.lo.y),
                                               all.hi.z - all.lo.z);

  const unsigned bits = (grid.wide ? 63u : 30u) + (grid.is_one ? 0u : 1u);
  if (grid.wide) {
    order.wide =
        sorted_strips(items, build_kernel().code_63, grid, bits, spare, pool, cancel, order);
  } else {
    order.narrow =
        sorted_strips(items, build_kernel().code_30, grid, bits, spare, pool, cancel, order);
  }
  return order;
}

const KeyIndex<std::uint32_t>* MortonOrder::narrow_run(Run run,
                                                       KeyIndex<std::uint32_t>* room) const {
  if (wide.size() == 0) return &narrow[run.first];
  const std::uint64_t differ = wide[run.first].key ^ wide[run.first + run.count - 1].key;
  const int shift = std::max(0, 33 - std::countl_zero(differ));
  for (std::uint32_t k = 0; k < run.count; ++k) {
    const KeyIndex<std::uint64_t>& from = wide[run.first + k];
    room[k] = {static_cast<std::uint32_t>(from.key >> shift) & 0x7fffffffu, from.index};
  }
  return room;
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
