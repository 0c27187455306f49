#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "parallel/function_ref.h"
#include "parallel/thread_priority.h"
#include "parallel/worker_places.h"

namespace komorebi {

/// A few threads that live as long as the pool: a thread spawned per phase would cost more than
/// the phases of a small build. Nothing here decides a result: work is given out in any order, and
/// whoever uses it must not let the order show.
class ThreadPool {
 public:
  /// `threads` counts the caller: a pool of 1 spawns none. 0 means one per hardware thread.
  /// `priority` is that of the spawned ones.
  explicit ThreadPool(unsigned threads, Priority priority = Priority::kNormal);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  unsigned size() const { return size_; }

  /// Calls body(worker) once for every worker in [0, min(workers, size())), the caller being
  /// worker 0, and returns when all are done. The first exception is rethrown here, once.
  /// From inside a body, or while another thread is using the pool, the calls are made one after
  /// the other on this thread, so bodies must not wait for each other.
  void run(unsigned workers, FunctionRef<void(unsigned)> body);

  /// Calls body(begin, end) for consecutive chunks of `grain` items that together are [0, count),
  /// given out as workers become free.
  void for_each_chunk(std::size_t count, std::size_t grain,
                      FunctionRef<void(std::size_t, std::size_t)> body);

 private:
  void work(unsigned worker, Priority priority);
  void call(FunctionRef<void(unsigned)> body, unsigned worker);

  unsigned size_;
  WorkerPlaces places_;
  std::vector<std::thread> threads_;
  std::mutex in_use_;  ///< held by the thread whose run() the pool is working on

  std::mutex mutex_;  ///< guards all changes of what is below
  std::condition_variable start_, done_;
  const FunctionRef<void(unsigned)>* body_ = nullptr;
  unsigned workers_ = 0;                  ///< workers that take part in the current run
  std::atomic<unsigned> unfinished_ = 0;  ///< of them, spawned ones that have not returned yet
  std::atomic<unsigned> generation_ = 0;  ///< counts runs, so that a thread takes part once in each
  std::atomic<bool> stop_ = false;
  std::exception_ptr error_;
};

}  // namespace komorebi
