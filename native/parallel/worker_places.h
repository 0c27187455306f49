#pragma once

#include <array>
#include <atomic>
#include <span>
#include <thread>
#include <vector>

namespace komorebi {

/// Keeps the workers of a run on processors of their own. A system may start a thread that it wakes
/// where the one runs that wakes it, though another processor has nothing to do, and part them only
/// after some milliseconds: longer than a small build takes.
///
/// Threads may run wherever they might before. Where the system has no means for that, nothing
/// happens.
class WorkerPlaces {
 public:
  /// @param size  of the pool; worker 0 is whoever calls, the others have threads of their own
  explicit WorkerPlaces(unsigned size) : workers_(size) {}

  /// To be called by worker 0 before it wakes the others: those that sleep, or were last seen on
  /// its processor, will start on other ones.
  /// @param run      a number of its own, not 0
  /// @param threads  of workers 1, 2, …
  void prepare(unsigned run, std::span<std::thread> threads);

  /// To be called by each other worker when it begins. If one of the same run is on this processor,
  /// the calling thread moves to one where none is.
  /// Returns the processor, or −1 if it is not known.
  int take(unsigned run, unsigned worker);

  void set_asleep(unsigned worker, bool asleep) { workers_[worker].is_asleep = asleep; }

 private:
  struct Worker {
    std::atomic<bool> is_asleep{false};
    std::atomic<int> last{-1};       ///< processor that it took
    std::atomic<int> kept_from{-1};  ///< one that it is to be allowed again
  };
  int claim(unsigned run);

  std::vector<Worker> workers_;
  /// For each processor the last run that had a worker there.
  std::array<std::atomic<unsigned>, 1024> run_ = {};
};

}  // namespace komorebi
