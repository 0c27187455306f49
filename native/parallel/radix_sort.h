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

/// What is to be sorted, piece by piece in its order.
template <class Key>
using SortPieces = std::span<const std::span<const KeyIndex<Key>>>;

/// Puts what is in the pieces into `sorted`, by key, items with equal keys keeping their order: the
/// result is the same for any number of threads. Eleven bits part the items into buckets, which are
/// sorted in a worker's cache; few or crowded ones are sorted as a whole, least significant digit
/// first, at most eleven bits a pass, and passes in which all keys agree are left out.
/// @param sorted  as many as there are in all pieces, at most 2³² − 1
/// @param bits  of the keys; those above are null
/// @throws Cancelled; the items are then in any order.
void radix_sort(SortPieces<std::uint32_t> pieces, std::span<KeyIndex<std::uint32_t>> sorted,
                ThreadPool& pool, const Cancel& cancel, unsigned bits = 32);
void radix_sort(SortPieces<std::uint64_t> pieces, std::span<KeyIndex<std::uint64_t>> sorted,
                ThreadPool& pool, const Cancel& cancel, unsigned bits = 64);

}  // namespace komorebi
