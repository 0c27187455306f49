#include "parallel/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <numeric>
#include <stdexcept>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace komorebi {
namespace {

TEST(ThreadPool, CallsEveryWorkerOnce) {
  ThreadPool pool(4);
  EXPECT_EQ(pool.size(), 4u);
  for (int repeat = 0; repeat < 200; ++repeat) {
    std::vector<std::atomic<int>> calls(6);
    pool.run(3, [&](unsigned worker) { ++calls[worker]; });
    for (unsigned i = 0; i < 6; ++i) EXPECT_EQ(calls[i], i < 3 ? 1 : 0);
    pool.run(100, [&](unsigned worker) { ++calls[worker]; });
    for (unsigned i = 0; i < 6; ++i) EXPECT_EQ(calls[i], (i < 3 ? 1 : 0) + (i < 4 ? 1 : 0));
  }
}

TEST(ThreadPool, ZeroMeansTheMachine) {
  EXPECT_EQ(ThreadPool(0).size(), std::max(1u, std::thread::hardware_concurrency()));
}

TEST(ThreadPool, CallerIsWorkerZero) {
  ThreadPool pool(3);
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<std::thread::id> ids(3);
  pool.run(3, [&](unsigned worker) { ids[worker] = std::this_thread::get_id(); });
  EXPECT_EQ(ids[0], caller);
  EXPECT_NE(ids[1], caller);
  EXPECT_NE(ids[2], ids[1]);
}

TEST(ThreadPool, ChunksCoverTheRangeOnce) {
  for (const unsigned threads : {1u, 2u, 7u}) {
    ThreadPool pool(threads);
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{999}}) {
      std::vector<std::atomic<int>> seen(count);
      pool.for_each_chunk(count, 10, [&](std::size_t begin, std::size_t end) {
        EXPECT_LE(end - begin, 10u);
        EXPECT_LT(begin, end);
        for (std::size_t i = begin; i < end; ++i) ++seen[i];
      });
      for (const auto& times : seen) EXPECT_EQ(times, 1);
    }
  }
}

TEST(ThreadPool, RethrowsOneExceptionAndGoesOn) {
  ThreadPool pool(3);
  std::atomic<int> calls{0};
  EXPECT_THROW(pool.run(3,
                        [&](unsigned) {
                          ++calls;
                          throw std::runtime_error("no");
                        }),
               std::runtime_error);
  EXPECT_EQ(calls, 3);
  pool.run(3, [&](unsigned) { ++calls; });
  EXPECT_EQ(calls, 6);
}

TEST(ThreadPool, NestedRunsStayOnTheirThread) {
  ThreadPool pool(3);
  std::atomic<int> calls{0};
  pool.run(3, [&](unsigned) {
    const std::thread::id outer = std::this_thread::get_id();
    pool.run(3, [&](unsigned) {
      EXPECT_EQ(std::this_thread::get_id(), outer);
      ++calls;
    });
  });
  EXPECT_EQ(calls, 9);
}

TEST(ThreadPool, TwoThreadsMayUseOnePool) {
  ThreadPool pool(2);
  std::atomic<int> calls{0};
  const auto use = [&] {
    for (int i = 0; i < 500; ++i) pool.run(2, [&](unsigned) { ++calls; });
  };
  std::thread other(use);
  use();
  other.join();
  EXPECT_EQ(calls, 2000);
}

TEST(ThreadPool, WorksInTheDefaultFloatEnvironment) {
#if defined(__SSE__)
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040u);  // flush denormals to zero, as Blender's threads do
  std::fesetround(FE_UPWARD);
  ThreadPool pool(2);
  std::atomic<int> right{0};
  pool.run(2, [&](unsigned) {
    if ((_mm_getcsr() & 0x8040u) == 0 && std::fegetround() == FE_TONEAREST) ++right;
  });
  EXPECT_EQ(std::fegetround(), FE_UPWARD) << "the caller's own setting must come back";
  EXPECT_EQ(_mm_getcsr() & 0x8040u, 0x8040u);
  std::fesetround(FE_TONEAREST);
  _mm_setcsr(before);
  EXPECT_EQ(right, 2);
#else
  GTEST_SKIP() << "the flush-to-zero flags are set with SSE here";
#endif
}

}  // namespace
}  // namespace komorebi
