#include "parallel/worker_places.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#if defined(__linux__)
#include <sched.h>

namespace komorebi {
namespace {

cpu_set_t allowed() {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  return set;
}

TEST(WorkerPlaces, WorkersOfARunHaveProcessorsOfTheirOwn) {
  const cpu_set_t before = allowed();
  const int processors = CPU_COUNT(&before);
  WorkerPlaces places(2);
  for (unsigned run = 1; run <= 20; ++run) {
    std::set<int> taken;
    // One thread stands for all workers: it is always where one has been.
    for (int worker = 0; worker < processors; ++worker) {
      const int cpu = places.take(run, 1);
      EXPECT_TRUE(CPU_ISSET(static_cast<std::size_t>(cpu), &before));
      EXPECT_TRUE(taken.insert(cpu).second) << "run " << run << ", worker " << worker;
    }
    // No processor is left for one more.
    EXPECT_EQ(taken.count(places.take(run, 1)), 1u);
  }
  const cpu_set_t after = allowed();
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

TEST(WorkerPlaces, ThreadMovesAndStaysWithinWhatTheHostAllows) {
  const cpu_set_t before = allowed();
  const int here = sched_getcpu();
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(here), &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  WorkerPlaces places(2);
  EXPECT_EQ(places.take(1, 1), here);
  EXPECT_EQ(places.take(1, 1), here);
  EXPECT_EQ(sched_getcpu(), here);
  const cpu_set_t after = allowed();
  EXPECT_TRUE(CPU_EQUAL(&one, &after));
  sched_setaffinity(0, sizeof before, &before);
}

TEST(WorkerPlaces, SleepersStartElsewhereAndMayComeBack) {
  const cpu_set_t before = allowed();
  if (CPU_COUNT(&before) < 2) return;  // nowhere to go
  WorkerPlaces places(2);
  std::atomic<bool> may_go{false};
  int place = -1;
  cpu_set_t after;
  std::thread thread[1];
  thread[0] = std::thread([&] {
    while (!may_go) std::this_thread::yield();
    place = places.take(1, 1);
    after = allowed();
  });
  places.set_asleep(1, true);
  places.prepare(1, thread);
  cpu_set_t meanwhile;
  EXPECT_EQ(pthread_getaffinity_np(thread[0].native_handle(), sizeof meanwhile, &meanwhile), 0);
  EXPECT_EQ(CPU_COUNT(&meanwhile), CPU_COUNT(&before) - 1);
  may_go = true;
  thread[0].join();
  EXPECT_NE(place, -1);
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

}  // namespace
}  // namespace komorebi

#endif
