#include "parallel/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <vector>

namespace komorebi {
namespace {

constexpr std::size_t kGap = 100;

template <class Key>
void expect_sorted_as_std(const std::vector<Key>& keys) {
  std::vector<KeyIndex<Key>> expected(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    expected[i] = {keys[i], static_cast<std::uint32_t>(i)};
  }
  const std::vector<KeyIndex<Key>> unsorted = expected;
  std::stable_sort(expected.begin(), expected.end(),
                   [](const auto& a, const auto& b) { return a.key < b.key; });
  for (const unsigned threads : {1u, 2u, 7u}) {
    ThreadPool pool(threads);
    const Cancel cancel;
    // In pieces of different sizes, some empty, with gaps between them.
    std::vector<KeyIndex<Key>> items(unsorted.size() + 4 * kGap), sorted(keys.size());
    std::vector<std::span<const KeyIndex<Key>>> pieces;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t begin = unsorted.size() * k * k / 16;
      const std::size_t end = unsorted.size() * (k + 1) * (k + 1) / 16;
      const std::span piece = std::span(items).subspan(begin + k * kGap, end - begin);
      std::copy_n(unsorted.begin() + static_cast<std::ptrdiff_t>(begin), end - begin,
                  piece.begin());
      pieces.push_back(piece);
      if (k == 1) pieces.push_back(piece.subspan(piece.size()));
    }
    radix_sort(pieces, sorted, pool, cancel);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(sorted[i].key, expected[i].key)
          << "position " << i << ", " << threads << " threads";
      ASSERT_EQ(sorted[i].index, expected[i].index) << "position " << i;
    }
  }
}

template <class Key>
std::vector<Key> random_keys(std::size_t count, Key mask) {
  std::mt19937_64 random(count);
  std::vector<Key> keys(count);
  for (Key& key : keys) key = static_cast<Key>(random()) & mask;
  return keys;
}

TEST(RadixSort, AgreesWithStableSort) {
  for (const std::size_t count : {0u, 1u, 2u, 255u, 8193u, 200000u}) {
    expect_sorted_as_std(random_keys<std::uint32_t>(count, ~0u));
    expect_sorted_as_std(random_keys<std::uint64_t>(count, ~std::uint64_t{0}));
  }
}

TEST(RadixSort, KeepsTheOrderOfEqualKeys) {
  expect_sorted_as_std(random_keys<std::uint32_t>(100000, 0x3u));
  expect_sorted_as_std(random_keys<std::uint64_t>(100000, 0x8000000000000001u));
  expect_sorted_as_std(std::vector<std::uint32_t>(100000, 7u));
}

TEST(RadixSort, SortsWhenOnlyOneDigitDiffers) {
  // An odd number of passes: the result lies in the scratch array and must come back.
  expect_sorted_as_std(random_keys<std::uint32_t>(50000, 0x00ff0000u));
  expect_sorted_as_std(random_keys<std::uint64_t>(50000, std::uint64_t{0xff} << 56));
}

TEST(RadixSort, SortsKeysThatAgreeInTheirMiddle) {
  // Buckets by the highest bits are then parted no further by the next ones.
  expect_sorted_as_std(random_keys<std::uint64_t>(200000, 0xffe0000000ffffffu));
  expect_sorted_as_std(random_keys<std::uint64_t>(200000, 0xffe0000f00000007u));
}

TEST(RadixSort, StopsWhenCancelled) {
  ThreadPool pool(2);
  Cancel cancel;
  cancel.raise();
  std::vector<KeyIndex<std::uint32_t>> items(100000), sorted(items.size());
  const std::vector<std::span<const KeyIndex<std::uint32_t>>> pieces{items};
  EXPECT_THROW(radix_sort(pieces, sorted, pool, cancel), Cancelled);
}

}  // namespace
}  // namespace komorebi
