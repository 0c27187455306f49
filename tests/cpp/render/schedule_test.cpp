#include "render/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <thread>

#include "render/tiles.h"

namespace komorebi::testing {
namespace {

/// Takes pieces on so many threads and ends them, every `drop`-th without having done it. Calls
/// visit(item), one call at a time, for each piece that is done.
template <class Visit>
void play(Schedule& schedule, Film& film, int threads, int drop, const Visit& visit) {
  const Cancel cancel;
  std::mutex mutex;
  int ended = 0;
  const auto work = [&] {
    while (const auto item = schedule.take(cancel)) {
      bool done = false;
      {
        const std::lock_guard lock(mutex);
        done = drop == 0 || ++ended % drop != 0;
        if (done) {
          TileSums sums;
          film.reset(sums, pixel_count(*item->cells));
          sums.samples = item->count;
          film.merge(*item->cells, sums);
          visit(*item);
        }
      }
      schedule.finish(*item, done, film);
    }
  };
  schedule.start();
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  schedule.pause();
}

TEST(Schedule, CoversEverySampleOfEveryPixelOnce) {
  const Rect region{5, 9, 60, 50};
  for (const bool progressive : {true, false}) {
    for (const std::uint32_t samples : {1u, 7u, 64u, 100u}) {
      for (const int drop : {0, 5}) {
        Settings settings;
        settings.samples = samples;
        settings.sample_offset = 3;
        settings.use_progressive = progressive;
        Film film(region, settings, 1.0f);
        Schedule schedule(make_tiles(region, 16, 1), settings, AdaptiveRule(settings, 1));
        std::vector<std::vector<int>> seen(60 * 50, std::vector<int>(samples + 3));
        play(schedule, film, 3, drop, [&](const WorkItem& item) {
          for (const Rect& c : *item.cells) {
            for (std::uint32_t y = c.y_min; y < c.y_max; ++y) {
              for (std::uint32_t x = c.x_min; x < c.x_max; ++x) {
                for (std::uint32_t i = 0; i < item.count; ++i) {
                  ++seen.at(y * 60 + x).at(item.first + i);
                }
              }
            }
          }
        });
        for (std::uint32_t y = 0; y < 50; ++y) {
          for (std::uint32_t x = 0; x < 60; ++x) {
            const bool inside = x >= 5 && y >= 9;
            for (std::uint32_t i = 0; i < samples + 3; ++i) {
              ASSERT_EQ(seen[y * 60 + x][i], inside && i >= 3 ? 1 : 0);
            }
          }
        }
        const ScheduleState state = schedule.state();
        EXPECT_EQ(state.fraction, 1.0);
        EXPECT_EQ(state.sample, samples);
        EXPECT_EQ(state.tile, state.tiles);
        EXPECT_EQ(state.pixel_samples, region.area() * samples);
      }
    }
  }
}

TEST(Schedule, RefinesTheWholeFrameFromItsCentre) {
  Settings settings;
  settings.samples = 64;
  const Rect region{0, 0, 320, 160};
  Film film(region, settings, 1.0f);
  Schedule schedule(make_tiles(region, 32, 1), settings, AdaptiveRule());
  std::vector<WorkItem> items;
  play(schedule, film, 1, 0, [&](const WorkItem& item) { items.push_back(item); });
  const std::size_t tiles = 10 * 5;
  for (std::size_t i = 0; i < tiles; ++i) EXPECT_EQ(items[i].first + items[i].count, 1u);
  const Rect& first = items[0].cells->front();
  EXPECT_EQ(first.y_min, 64u);
  EXPECT_TRUE(first.x_min == 128u || first.x_min == 160u);
  EXPECT_EQ(items[tiles].first, 1u);
}

TEST(Schedule, CountsTilesOfThePassThatIsOn) {
  Settings settings;
  settings.samples = 2;
  const Rect region{0, 0, 64, 64};
  Film film(region, settings, 1.0f);
  Schedule schedule(make_tiles(region, 16, 1), settings, AdaptiveRule());
  std::uint32_t done = 0;
  play(schedule, film, 1, 0, [&](const WorkItem&) {
    const ScheduleState state = schedule.state();
    EXPECT_EQ(state.tiles, 16u);
    EXPECT_EQ(state.tile, done % 16);
    EXPECT_EQ(state.sample, done / 16);
    EXPECT_EQ(state.fraction, done / 32.0);
    ++done;
  });
  EXPECT_EQ(done, 32u);
}

TEST(Tiles, AreUnionsOfCellsAndSmallerWhereThreadsAreMany) {
  const Rect region{13, 5, 300, 200};
  for (const std::uint32_t wanted : {8u, 13u, 64u, 256u}) {
    for (const unsigned threads : {1u, 2u, 64u}) {
      const std::vector<Rect> tiles = make_tiles(region, wanted, threads);
      std::size_t area = 0;
      for (const Rect& t : tiles) {
        area += t.area();
        EXPECT_TRUE(t.x_min % kCellSize == 0 || t.x_min == region.x_min);
        EXPECT_TRUE(t.y_max % kCellSize == 0 || t.y_max == region.y_max);
        EXPECT_LE(t.width(), (wanted + 7) / 8 * 8);
      }
      EXPECT_EQ(area, region.area());
    }
  }
  EXPECT_EQ(make_tiles(region, 64, 1).size(), 20u);
  EXPECT_GE(make_tiles(region, 64, 8).size(), 64u);
}

}  // namespace
}  // namespace komorebi::testing
