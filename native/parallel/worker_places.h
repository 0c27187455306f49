#pragma once

#include <array>
#include <atomic>

namespace komorebi {

/// Keeps the workers of a run on processors of their own. A system may start a thread that it wakes
/// where the one runs that wakes it, though another processor has nothing to do, and part them only
/// after some milliseconds: longer than a small build takes.
class WorkerPlaces {
 public:
  /// To be called by each worker when a run begins. If another one of the same run is on this
  /// processor, the calling thread moves to one where none is; it may still run wherever it might
  /// before. Where the system has no means for that, nothing happens.
  /// @param run  a number of its own, not 0
  /// Returns the processor, or −1 if it is not known.
  int take(unsigned run);

 private:
  /// For each processor the last run that had a worker there.
  std::array<std::atomic<unsigned>, 1024> run_ = {};
};

}  // namespace komorebi
