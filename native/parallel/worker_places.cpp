#include "parallel/worker_places.h"

#if defined(__linux__)
#include <sched.h>
#endif

namespace komorebi {

#if defined(__linux__)

int WorkerPlaces::take(unsigned run) {
  const int here = sched_getcpu();
  if (here < 0 || static_cast<std::size_t>(here) >= run_.size()) return -1;
  const auto is_free = [&](std::size_t cpu) { return run_[cpu].exchange(run) != run; };
  if (is_free(static_cast<std::size_t>(here))) return here;
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return here;
  for (std::size_t cpu = 0; cpu < run_.size(); ++cpu) {
    if (!CPU_ISSET(cpu, &allowed) || !is_free(cpu)) continue;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(cpu, &one);
    // The thread moves before the call returns.
    if (sched_setaffinity(0, sizeof one, &one) != 0) return here;
    sched_setaffinity(0, sizeof allowed, &allowed);
    return static_cast<int>(cpu);
  }
  return here;
}

#else

int WorkerPlaces::take(unsigned) {
  return -1;
}

#endif

}  // namespace komorebi
