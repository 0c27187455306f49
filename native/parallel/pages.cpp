#include "parallel/pages.h"

#include <cstdint>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
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
  if (bytes > 0) munmap(pages, bytes);
}

void back_pages(void* pages, std::size_t bytes) {
#if defined(MADV_POPULATE_WRITE)
  madvise(pages, bytes, MADV_POPULATE_WRITE);  // what cannot is backed when it is written
#else
  static_cast<void>(pages), static_cast<void>(bytes);
#endif
}

std::size_t trim_pages(void* pages, std::size_t bytes, std::size_t kept) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  kept = (kept + page - 1) / page * page;
  if (kept < bytes) munmap(static_cast<std::byte*>(pages) + kept, bytes - kept);
  return kept;
}

#else

void* map_pages(std::size_t bytes) {
  return ::operator new (bytes, std::align_val_t{kHugePage});
}

void unmap_pages(void* pages, std::size_t) {
  ::operator delete (pages, std::align_val_t{kHugePage});
}

void back_pages(void*, std::size_t) {}

std::size_t trim_pages(void*, std::size_t bytes, std::size_t) {
  return bytes;  // operator delete takes the whole
}

#endif

}  // namespace komorebi
