#include "parallel/worker_places.h"

#if defined(__linux__)
#include <pthread.h>
#include <sched.h>
#endif

namespace komorebi {

#if defined(__linux__)

void WorkerPlaces::prepare(unsigned run, std::span<std::thread> threads) {
  const int here = claim(run);
  if (here < 0) return;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    Worker& worker = workers_[i + 1];
    if (worker.kept_from >= 0 || (!worker.is_asleep && worker.last != here)) continue;
    const pthread_t thread = threads[i].native_handle();
    cpu_set_t allowed;
    if (pthread_getaffinity_np(thread, sizeof allowed, &allowed) != 0) continue;
    if (!CPU_ISSET(static_cast<std::size_t>(here), &allowed) || CPU_COUNT(&allowed) == 1) continue;
    CPU_CLR(static_cast<std::size_t>(here), &allowed);
    worker.kept_from = here;
    pthread_setaffinity_np(thread, sizeof allowed, &allowed);
  }
}

int WorkerPlaces::take(unsigned run, unsigned worker) {
  const int kept_from = workers_[worker].kept_from.exchange(-1);
  cpu_set_t allowed;
  if (kept_from >= 0 && sched_getaffinity(0, sizeof allowed, &allowed) == 0) {
    CPU_SET(static_cast<std::size_t>(kept_from), &allowed);
    sched_setaffinity(0, sizeof allowed, &allowed);
  }
  const int place = claim(run);
  workers_[worker].last = place;
  return place;
}

int WorkerPlaces::claim(unsigned run) {
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

void WorkerPlaces::prepare(unsigned, std::span<std::thread>) {}

int WorkerPlaces::take(unsigned, unsigned) {
  return -1;
}

#endif

}  // namespace komorebi
