#include "parallel/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "parallel/float_environment.h"

namespace komorebi {
namespace {

/// Whether this thread is inside some pool's body: nested runs then stay on this thread.
thread_local bool inside_body = false;

unsigned choose_size(unsigned threads) {
  if (threads > 0) return threads;
  return std::max(1u, std::thread::hardware_concurrency());
}

/// A thread that sleeps is woken late, and often where the one that wakes it runs: the next phase
/// of a build comes sooner than that.
constexpr std::chrono::microseconds kStayAwake{200};

template <class Condition>
void stay_awake_until(const Condition& is_met) {
  const auto end = std::chrono::steady_clock::now() + kStayAwake;
  while (!is_met() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

}  // namespace

ThreadPool::ThreadPool(unsigned threads, Priority priority)
    : size_(choose_size(threads)), places_(size_) {
  threads_.reserve(size_ - 1);
  try {
    for (unsigned worker = 1; worker < size_; ++worker) {
      threads_.emplace_back([this, worker, priority] { work(worker, priority); });
    }
  } catch (const std::system_error&) {
    // The system gives no more threads: work with those that started.
    size_ = static_cast<unsigned>(threads_.size()) + 1;
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadPool::call(FunctionRef<void(unsigned)> body, unsigned worker) {
  try {
    body(worker);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

void ThreadPool::work(unsigned worker, Priority priority) {
  if (priority == Priority::kLow) lower_priority();
  const DefaultFloatEnvironment float_environment;
  inside_body = true;
  unsigned seen = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    places_.set_asleep(worker, true);
    start_.wait(lock, [&] { return stop_ || (generation_ != seen && worker < workers_); });
    places_.set_asleep(worker, false);
    if (stop_) return;
    seen = generation_;
    const FunctionRef<void(unsigned)> body = *body_;
    lock.unlock();
    places_.take(seen, worker);
    call(body, worker);
    lock.lock();
    if (--unfinished_ == 0) done_.notify_one();
    lock.unlock();
    stay_awake_until([&] { return stop_ || generation_ != seen; });
    lock.lock();
  }
}

void ThreadPool::run(unsigned workers, FunctionRef<void(unsigned)> body) {
  workers = std::min(workers, size_);
  if (workers == 0) return;
  const DefaultFloatEnvironment float_environment;
  std::unique_lock use(in_use_, std::defer_lock);
  if (workers == 1 || inside_body || !use.try_lock()) {
    for (unsigned worker = 0; worker < workers; ++worker) body(worker);
    return;
  }
  places_.prepare(generation_ + 1, std::span(threads_).first(workers - 1));
  {
    const std::lock_guard lock(mutex_);
    body_ = &body;
    workers_ = workers;
    unfinished_ = workers - 1;
    ++generation_;
  }
  start_.notify_all();
  inside_body = true;
  call(body, 0);
  inside_body = false;
  stay_awake_until([&] { return unfinished_ == 0; });
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return unfinished_ == 0; });
  workers_ = 0;  // late wakers have nothing to do
  if (error_) {
    const std::exception_ptr error = std::exchange(error_, nullptr);
    lock.unlock();
    use.unlock();
    std::rethrow_exception(error);
  }
}

void ThreadPool::for_each_chunk(std::size_t count, std::size_t grain,
                                FunctionRef<void(std::size_t, std::size_t)> body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count - 1) / grain + 1;
  std::atomic<std::size_t> next{0};
  const auto workers = static_cast<unsigned>(std::min<std::size_t>(chunks, size_));
  run(workers, [&](unsigned) {
    for (std::size_t i = next++; i < chunks; i = next++) {
      body(i * grain, std::min(count, (i + 1) * grain));
    }
  });
}

}  // namespace komorebi
