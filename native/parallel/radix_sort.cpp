#include "parallel/radix_sort.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>
#include <vector>

#include "parallel/scratch.h"

namespace komorebi {
namespace {

constexpr unsigned kMostDigitBits = 11;
constexpr std::size_t kMinimumShare = 8192;  ///< items below which a worker does not pay

constexpr std::size_t kFewItems = 32768;  ///< for which buckets do not pay

using Histogram = std::array<std::uint32_t, std::size_t{1} << kMostDigitBits>;

constexpr std::size_t kMostInPiece = 16384;  ///< the cancel flag is looked at in between

template <class Key>
std::vector<std::span<const KeyIndex<Key>>> pieces_of(std::span<KeyIndex<Key>> items,
                                                      std::size_t most) {
  std::vector<std::span<const KeyIndex<Key>>> pieces;
  for (std::size_t begin = 0; begin < items.size(); begin += most) {
    pieces.push_back(items.subspan(begin, std::min(most, items.size() - begin)));
  }
  return pieces;
}

/// Where things go that are sorted by one digit, at first how many there are.
using Places = std::vector<Histogram>;  // one a worker

/// One stable pass by the digit of `bits` bits at `shift`, by all workers. Returns the largest
/// number of items with the same digit; if that is more than `most`, nothing is moved.
template <class Key>
std::size_t part(SortPieces<Key> from, KeyIndex<Key>* to, unsigned shift, unsigned bits,
                 std::size_t most, Places& places, ThreadPool& pool, const Cancel& cancel) {
  const auto workers = static_cast<unsigned>(places.size());
  const auto for_each_of = [&](unsigned worker, auto&& body) {
    const std::size_t end = from.size() * (worker + 1) / workers;
    for (std::size_t k = from.size() * worker / workers; k < end && !cancel.raised(); ++k) {
      for (const KeyIndex<Key>& item : from[k]) body(item);
    }
  };
  const std::size_t digits = std::size_t{1} << bits;
  const auto digit = [&](Key key) { return static_cast<std::size_t>(key >> shift) & (digits - 1); };
  pool.run(workers, [&](unsigned worker) {
    Histogram& histogram = places[worker];
    std::fill_n(histogram.begin(), digits, 0u);
    for_each_of(worker, [&](const KeyIndex<Key>& item) { ++histogram[digit(item.key)]; });
  });
  if (cancel.raised()) throw Cancelled();

  // Digit by digit, and within a digit worker by worker: that is what keeps the order.
  std::uint32_t place = 0;
  std::size_t largest = 0;
  for (std::size_t d = 0; d < digits; ++d) {
    const std::uint32_t before = place;
    for (Histogram& histogram : places) {
      const std::uint32_t size = histogram[d];
      histogram[d] = place;
      place += size;
    }
    largest = std::max<std::size_t>(largest, place - before);
  }
  if (largest > most) return largest;

  pool.run(workers, [&](unsigned worker) {
    Histogram& next = places[worker];
    for_each_of(worker, [&](const KeyIndex<Key>& item) { to[next[digit(item.key)]++] = item; });
  });
  if (cancel.raised()) throw Cancelled();
  return largest;
}

/// Least significant digit first, pass by pass over everything.
template <class Key>
void sort_by_passes(std::span<KeyIndex<Key>> items, Places& places, ThreadPool& pool,
                    const Cancel& cancel, unsigned bits) {
  Scratch<KeyIndex<Key>> scratch(items.size());
  std::span<KeyIndex<Key>> from = items, to(scratch.data(), items.size());
  const unsigned passes = (bits + kMostDigitBits - 1) / kMostDigitBits;
  const unsigned digit_bits = passes > 0 ? (bits + passes - 1) / passes : 0;
  for (unsigned pass = 0; pass < passes; ++pass) {
    const std::size_t most = items.size() - 1;  // a pass in which all agree is left out
    const auto pieces = pieces_of(from, kMostInPiece);
    if (part<Key>(pieces, to.data(), pass * digit_bits, digit_bits, most, places, pool, cancel) <=
        most) {
      std::swap(from, to);
    }
  }
  if (from.data() != items.data()) std::copy(from.begin(), from.end(), items.begin());
}

constexpr std::size_t kFew = 24;  ///< items for which digits do not pay

/// Sorts by the lowest `bits`, by insertion.
template <class Key>
void insert_sorted(KeyIndex<Key>* items, std::size_t count, unsigned bits) {
  const Key mask = (Key{1} << bits) - 1;
  for (std::size_t i = 1; i < count; ++i) {
    const KeyIndex<Key> item = items[i];
    std::size_t at = i;
    for (; at > 0 && (items[at - 1].key & mask) > (item.key & mask); --at) {
      items[at] = items[at - 1];
    }
    items[at] = item;
  }
}

/// How a bucket's highest bits are parted: in a large one fewer passes pay for more digits.
struct BucketPasses {
  unsigned count, digit_bits;
  static constexpr std::size_t kLarge = 256;
  static constexpr unsigned kMost = 3, kMostBits = 10;
  BucketPasses(std::size_t items, unsigned bits)
      : count(items >= kLarge ? 2 : kMost), digit_bits(items >= kLarge ? kMostBits : 7) {
    digit_bits = std::min(digit_bits, (bits + count - 1) / count);
  }
};

/// Sorts by the lowest `bits`, in this worker's cache. `scratch` has room for as many.
template <class Key>
void sort_bucket(KeyIndex<Key>* items, KeyIndex<Key>* scratch, std::size_t count, unsigned bits) {
  if (count <= kFew) return insert_sorted(items, count, bits);
  // The highest bits part most items from most others.
  const BucketPasses passes(count, bits);
  const unsigned high = std::min(bits, passes.count * passes.digit_bits), low = bits - high;
  const std::size_t digits = std::size_t{1} << passes.digit_bits;
  // The last digit may reach above what is to be sorted by, where the bucket's keys agree.
  const auto digit = [&](Key key, unsigned pass) {
    return static_cast<std::size_t>(key >> (low + pass * passes.digit_bits)) & (digits - 1);
  };
  std::uint32_t next[BucketPasses::kMost][std::size_t{1} << BucketPasses::kMostBits];
  for (unsigned pass = 0; pass < passes.count; ++pass) std::fill_n(next[pass], digits, 0u);
  for (std::size_t i = 0; i < count; ++i) {
    for (unsigned pass = 0; pass < passes.count; ++pass) ++next[pass][digit(items[i].key, pass)];
  }
  KeyIndex<Key>* source = items;
  KeyIndex<Key>* target = scratch;
  for (unsigned pass = 0; pass < passes.count; ++pass) {
    std::uint32_t place = 0;
    for (std::size_t d = 0; d < digits; ++d) {
      const std::uint32_t size = next[pass][d];
      next[pass][d] = place;
      place += size;
    }
    for (std::size_t i = 0; i < count; ++i) {
      target[next[pass][digit(source[i].key, pass)]++] = source[i];
    }
    std::swap(source, target);
  }
  if (source != items) std::copy_n(source, count, items);
  if (low == 0) return;
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    for (end = begin + 1; end < count && (items[end].key ^ items[begin].key) >> low == 0;) ++end;
    sort_bucket(items + begin, scratch, end - begin, low);
  }
}

/// Most significant digit first, and then the buckets, each in a worker's cache. False, and nothing
/// done, if too many items are in one bucket.
template <class Key>
bool sort_by_buckets(SortPieces<Key> pieces, std::span<KeyIndex<Key>> sorted, Places& places,
                     ThreadPool& pool, const Cancel& cancel, unsigned bits) {
  const unsigned rest = bits - kMostDigitBits;
  const std::size_t most = sorted.size() / 8;
  const std::size_t largest =
      part<Key>(pieces, sorted.data(), rest, kMostDigitBits, most, places, pool, cancel);
  if (largest > most) return false;
  // Where the last worker stopped writing a bucket, it ends.
  const Histogram& ends = places.back();
  std::atomic<std::size_t> next{0};
  pool.run(pool.size(), [&](unsigned) {
    Scratch<KeyIndex<Key>> scratch(largest);
    for (std::size_t d = next++; d < ends.size() && !cancel.raised(); d = next++) {
      const std::size_t begin = d > 0 ? ends[d - 1] : 0;
      sort_bucket(sorted.data() + begin, scratch.data(), ends[d] - begin, rest);
    }
  });
  if (cancel.raised()) throw Cancelled();
  return true;
}

template <class Key>
void sort(SortPieces<Key> pieces, std::span<KeyIndex<Key>> sorted, ThreadPool& pool,
          const Cancel& cancel, unsigned bits) {
  std::size_t count = 0;
  for (const auto& piece : pieces) count += piece.size();
  if (sorted.size() != count) throw std::invalid_argument("radix_sort: sizes differ");
  if (count == 0) return;
  Places places(std::clamp<std::size_t>(count / kMinimumShare, 1, pool.size()));
  const bool is_large = count >= kFewItems && bits > 2 * kMostDigitBits;
  if (is_large && sort_by_buckets(pieces, sorted, places, pool, cancel, bits)) return;
  auto end = sorted.begin();
  for (const auto& piece : pieces) end = std::copy(piece.begin(), piece.end(), end);
  sort_by_passes<Key>(sorted, places, pool, cancel, bits);
}

}  // namespace

void radix_sort(SortPieces<std::uint32_t> pieces, std::span<KeyIndex<std::uint32_t>> sorted,
                ThreadPool& pool, const Cancel& cancel, unsigned bits) {
  sort(pieces, sorted, pool, cancel, bits);
}

void radix_sort(SortPieces<std::uint64_t> pieces, std::span<KeyIndex<std::uint64_t>> sorted,
                ThreadPool& pool, const Cancel& cancel, unsigned bits) {
  sort(pieces, sorted, pool, cancel, bits);
}

}  // namespace komorebi
