#pragma once

#include <cstddef>

#include "parallel/pages.h"
#include "parallel/thread_pool.h"

namespace komorebi {

/// Lets the system put memory behind one huge page of an array that nobody has written yet.
inline void touch_page(void* data, std::size_t page) {
  static_cast<volatile char*>(data)[page * kHugePage] = 0;
}

/// Lets the system put memory behind an array that nobody has written yet, each huge page by one
/// worker. Where two workers write to a fresh page at the same time, both may clear one for it.
inline void touch_pages(void* data, std::size_t bytes, ThreadPool& pool) {
  if (bytes < kHugePage) return;  // no huge page stands behind it
  pool.for_each_chunk((bytes + kHugePage - 1) / kHugePage, 1,
                      [&](std::size_t page, std::size_t) { touch_page(data, page); });
}

}  // namespace komorebi
