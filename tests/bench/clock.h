#pragma once

#include <chrono>
#include <functional>
#include <vector>

namespace komorebi::bench {

/// Seconds that `work` takes.
inline double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One of several things that do the same work and are timed against each other.
struct Contender {
  std::function<void()> prepare;  ///< before each repetition, not timed
  std::function<void()> work;
};

/// Seconds [contender][round]. Contenders take turns within a round, so that whatever else the
/// machine does meets all of them alike and ratios within a round mean something; every other
/// round goes backwards. One more round before the first warms caches and is not counted.
inline std::vector<std::vector<double>> interleave(const std::vector<Contender>& contenders,
                                                   int rounds) {
  std::vector<std::vector<double>> seconds(contenders.size());
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      const std::size_t i = round % 2 == 0 ? k : contenders.size() - 1 - k;
      contenders[i].prepare();
      const double s = seconds_of(contenders[i].work);
      if (round >= 0) seconds[i].push_back(s);
    }
  }
  return seconds;
}

}  // namespace komorebi::bench
