#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <thread>

#include "bench/fresh_process.h"

namespace komorebi::bench {

/// What can be had, less an eighth and a gibibyte for all others.
inline double bytes_to_spare() {
  double available = 0.0;
  std::ifstream info("/proc/meminfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("MemAvailable:", 0) == 0) available = 1024.0 * std::stod(line.substr(13));
  }
  double limit = 0.0, used = 0.0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit &&
      std::ifstream("/sys/fs/cgroup/memory.current") >> used) {
    available = std::min(available, limit - used);
  }
  return std::max(0.0, 0.875 * available - double(1 << 30));
}

/// Another process writes to so much free memory and ends; to be called right before a first build
/// is measured, with more than that can take.
///
/// The host of a virtual machine may back a page only when the machine first touches it (13 µs in
/// place of 1.6), and may take it away again a few seconds after the machine has freed it: a first
/// build's time would be a matter of what ran before.
inline void touch_free_memory(double bytes) {
  constexpr std::size_t kPiece = std::size_t{1} << 24;
  const auto pieces =
      static_cast<std::size_t>(std::min(bytes, bytes_to_spare()) / double(kPiece)) + 1;
  const auto touch = [](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      void* const piece =
          mmap(nullptr, kPiece, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      if (piece == MAP_FAILED) return;
      madvise(piece, kPiece, MADV_HUGEPAGE);
      volatile char* const at = static_cast<char*>(piece);
      for (std::size_t k = 0; k < kPiece; k += 4096) at[k] = 1;
    }
  };
  in_fresh_process([&] {
    std::thread other([&] { touch(pieces / 2); });
    touch(pieces - pieces / 2);
    other.join();
    return std::vector<double>{};
  });
}

}  // namespace komorebi::bench
