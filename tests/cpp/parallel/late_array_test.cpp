#include "parallel/late_array.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

namespace komorebi {
namespace {

TEST(LateArray, KeepsWhatWasWritten) {
  for (const std::size_t room : {1u, 1000u, 1u << 22}) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, room / 2, room}) {
      LateArray<std::uint32_t> array(room);
      std::iota(array.room(), array.room() + size, 7u);
      array.back(0, size * sizeof(std::uint32_t));
      array.end_at(size);
      LateArray<std::uint32_t> moved;
      moved = std::move(array);
      ASSERT_EQ(moved.size(), size);
      EXPECT_EQ(moved.empty(), size == 0);
      EXPECT_EQ(moved.byte_count(), 4 * size);
      std::uint32_t expected = 7;
      for (const std::uint32_t value : moved) ASSERT_EQ(value, expected++);
    }
  }
}

TEST(LateArray, MayNeverEnd) {
  LateArray<char> mapped(std::size_t{1} << 30), small(100);
  mapped.room()[0] = small.room()[0] = 1;
  EXPECT_TRUE(mapped.empty() && small.empty());
}

}  // namespace
}  // namespace komorebi
