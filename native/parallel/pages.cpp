#include "parallel/pages.h"

#include <cstdint>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace komorebi {

#if defined(__linux__)

void* map_pages(std::size_t bytes) {
  // One huge page more than asked for: what lies outside of the aligned part goes back.
  const std::size_t room = bytes + kHugePage;
  if (room < bytes) throw std::bad_alloc();
  void* const mapped =
      mmap(nullptr, room, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  const std::size_t ahead = (0 - reinterpret_cast<std::uintptr_t>(mapped)) % kHugePage;
  std::byte* const pages = static_cast<std::byte*>(mapped) + ahead;
  if (ahead > 0) munmap(mapped, ahead);
  munmap(pages + bytes, kHugePage - ahead);
  madvise(pages, bytes, MADV_HUGEPAGE);  // advice: where it is refused, the pages are small ones
  return pages;
}

void unmap_pages(void* pages, std::size_t bytes) {
  munmap(pages, bytes);
}

#else

void* map_pages(std::size_t bytes) {
  return ::operator new (bytes, std::align_val_t{kHugePage});
}

void unmap_pages(void* pages, std::size_t) {
  ::operator delete (pages, std::align_val_t{kHugePage});
}

#endif

}  // namespace komorebi
