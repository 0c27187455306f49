#include "parallel/radix_sort.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace komorebi {
namespace {

constexpr unsigned kMostDigitBits = 11;
constexpr std::size_t kMinimumShare = 8192;  ///< items below which a worker does not pay
constexpr std::size_t kPollEvery = 65536;    ///< items between two looks at the cancel flag

using Histogram = std::array<std::uint32_t, std::size_t{1} << kMostDigitBits>;

/// Calls body(begin, end) for pieces of [begin, end), polling between them.
template <class Body>
void poll_through(std::size_t begin, std::size_t end, const Cancel& cancel, Body&& body) {
  for (; begin < end && !cancel.raised(); begin += kPollEvery) {
    body(begin, std::min(end, begin + kPollEvery));
  }
}

template <class Key>
void sort(std::span<KeyIndex<Key>> items, std::span<KeyIndex<Key>> scratch, ThreadPool& pool,
          const Cancel& cancel, unsigned bits) {
  const std::size_t count = items.size();
  if (scratch.size() < count) throw std::invalid_argument("radix_sort: scratch is too small");
  const auto workers =
      static_cast<unsigned>(std::clamp<std::size_t>(count / kMinimumShare, 1, pool.size()));
  const auto share = [&](unsigned worker) { return count * worker / workers; };

  std::vector<Histogram> places(workers);
  std::span<KeyIndex<Key>> from = items, to = scratch;
  const unsigned passes = (bits + kMostDigitBits - 1) / kMostDigitBits;
  const unsigned digit_bits = passes > 0 ? (bits + passes - 1) / passes : 0;
  const std::size_t digits = std::size_t{1} << digit_bits;
  for (unsigned pass = 0; pass < passes; ++pass) {
    const unsigned shift = pass * digit_bits;
    const auto digit = [&](Key key) {
      return static_cast<std::size_t>(key >> shift) & (digits - 1);
    };
    pool.run(workers, [&](unsigned worker) {
      Histogram& histogram = places[worker];
      std::fill_n(histogram.begin(), digits, 0u);
      poll_through(share(worker), share(worker + 1), cancel, [&](std::size_t i, std::size_t end) {
        for (; i < end; ++i) ++histogram[digit(from[i].key)];
      });
    });
    if (cancel.raised()) throw Cancelled();

    // Digit by digit, and within a digit worker by worker: that is what keeps the order.
    std::uint32_t place = 0;
    bool all_agree = false;
    for (std::size_t d = 0; d < digits; ++d) {
      const std::uint32_t before = place;
      for (Histogram& histogram : places) {
        const std::uint32_t size = histogram[d];
        histogram[d] = place;
        place += size;
      }
      all_agree = all_agree || place - before == count;
    }
    if (all_agree) continue;

    pool.run(workers, [&](unsigned worker) {
      Histogram& next = places[worker];
      poll_through(share(worker), share(worker + 1), cancel, [&](std::size_t i, std::size_t end) {
        for (; i < end; ++i) to[next[digit(from[i].key)]++] = from[i];
      });
    });
    if (cancel.raised()) throw Cancelled();
    std::swap(from, to);
  }
  if (from.data() != items.data())
    std::copy(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count), items.begin());
}

}  // namespace

void radix_sort(std::span<KeyIndex<std::uint32_t>> items,
                std::span<KeyIndex<std::uint32_t>> scratch, ThreadPool& pool, const Cancel& cancel,
                unsigned bits) {
  sort(items, scratch, pool, cancel, bits);
}

void radix_sort(std::span<KeyIndex<std::uint64_t>> items,
                std::span<KeyIndex<std::uint64_t>> scratch, ThreadPool& pool, const Cancel& cancel,
                unsigned bits) {
  sort(items, scratch, pool, cancel, bits);
}

}  // namespace komorebi
