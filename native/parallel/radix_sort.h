#pragma once

#include <cstdint>
#include <span>

#include "parallel/cancel.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// What is sorted: a key and where it came from.
template <class Key>
struct KeyIndex {
  Key key;
  std::uint32_t index;
};

/// Pieces of one array, in their order and not overlapping; the first begins where the array does.
template <class Key>
using SortPieces = std::span<const std::span<KeyIndex<Key>>>;

/// Sorts what is in the pieces by key, items with equal keys keeping their order: the result is the
/// same for any number of threads, and stands at the array's beginning without gaps. Eleven bits
/// part the items into buckets, which are sorted in a worker's cache; few or crowded ones are
/// sorted as a whole, least significant digit first, at most eleven bits a pass, and passes in
/// which all keys agree are left out. `scratch` has room for all; at most 2³² − 1 items.
/// @param bits  of the keys; those above are null
/// @throws Cancelled; the items are then in any order.
void radix_sort(SortPieces<std::uint32_t> pieces, std::span<KeyIndex<std::uint32_t>> scratch,
                ThreadPool& pool, const Cancel& cancel, unsigned bits = 32);
void radix_sort(SortPieces<std::uint64_t> pieces, std::span<KeyIndex<std::uint64_t>> scratch,
                ThreadPool& pool, const Cancel& cancel, unsigned bits = 64);

}  // namespace komorebi
