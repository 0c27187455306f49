#pragma once

#include <cstddef>

namespace komorebi {

inline constexpr std::size_t kHugePage = std::size_t{1} << 21;  ///< bytes

constexpr std::size_t whole_huge_pages(std::size_t bytes) {
  return (bytes + kHugePage - 1) / kHugePage * kHugePage;
}

/// Memory from the system itself: fresh, in huge pages where it grants them, and given back as soon
/// as it is unmapped. What malloc recycles is neither: its pages are small ones, and in a forked
/// process the first write to each copies it.
/// @param bytes  whole huge pages, more than none
void* map_pages(std::size_t bytes);
void unmap_pages(void* pages, std::size_t bytes);
/// Has memory put behind pages that may be written already, where the system can do that.
void back_pages(void* pages, std::size_t bytes);
/// Gives back what lies behind the first `kept` bytes, where the system can do that; returns how
/// many are left to unmap: at most a small page more, or all.
std::size_t trim_pages(void* pages, std::size_t bytes, std::size_t kept);

}  // namespace komorebi
