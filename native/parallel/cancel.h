#pragma once

#include <atomic>
#include <stdexcept>

namespace komorebi {

/// A flag that one thread raises and others poll at least every few milliseconds of work.
class Cancel {
 public:
  void raise() { flag_.store(true, std::memory_order_relaxed); }
  bool raised() const { return flag_.load(std::memory_order_relaxed); }
  /// Throws Cancelled when it has been raised.
  void check() const;
  /// One that nobody raises.
  static const Cancel& never();

  Cancel() = default;
  Cancel(const Cancel&) = delete;
  Cancel& operator=(const Cancel&) = delete;

 private:
  std::atomic<bool> flag_{false};
};

/// Thrown by a long call at its boundary when it was cancelled; never an error to report.
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

inline void Cancel::check() const {
  if (raised()) throw Cancelled();
}

inline const Cancel& Cancel::never() {
  static const Cancel kNever;
  return kNever;
}

}  // namespace komorebi
