#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/thread_pool.h"

namespace komorebi {

inline constexpr std::size_t kHashBlock = 4096;  ///< bytes that share one tag

/// Tags of the blocks of `bytes`: 32 bytes for each 4096, to be hashed on by a slower function
/// together with the length. Two different blocks share a tag with probability 2⁻¹²⁸ over the key,
/// which is drawn anew in each process and never leaves it: tags of two processes do not compare.
///
/// The tag is NH in words of 64 bits, twice with a shifted key (Black, Halevi, Krawczyk, Krovetz,
/// Rogaway, *UMAC*, CRYPTO 1999, §4 and §5.3: sums of products, the Toeplitz construction).
std::vector<std::uint64_t> content_tags(std::span<const std::byte> bytes, ThreadPool& pool);

}  // namespace komorebi
