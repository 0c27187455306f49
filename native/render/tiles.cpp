#include "render/tiles.h"

#include <algorithm>

namespace komorebi {
namespace {

constexpr std::uint32_t kMaxSamplesPerItem = 16;

std::vector<Rect> tiles_from_centre(const Rect& region, std::uint32_t size) {
  std::vector<Rect> tiles;
  for (std::uint32_t y = region.y_min / size * size; y < region.y_max; y += size) {
    for (std::uint32_t x = region.x_min / size * size; x < region.x_max; x += size) {
      tiles.push_back({std::max(x, region.x_min), std::max(y, region.y_min),
                       std::min(x + size, region.x_max), std::min(y + size, region.y_max)});
    }
  }
  const auto distance = [&](const Rect& t) {  // squared, of doubled centres: all in integers
    const std::int64_t dx = std::int64_t{t.x_min} + t.x_max - region.x_min - region.x_max;
    const std::int64_t dy = std::int64_t{t.y_min} + t.y_max - region.y_min - region.y_max;
    return dx * dx + dy * dy;
  };
  std::stable_sort(tiles.begin(), tiles.end(),
                   [&](const Rect& a, const Rect& b) { return distance(a) < distance(b); });
  return tiles;
}

struct SampleRange {
  std::uint32_t first, count;
};

std::vector<SampleRange> sample_ranges(const Settings& settings) {
  std::vector<SampleRange> ranges;
  std::uint32_t done = 0;
  while (done < settings.samples) {
    const std::uint32_t doubling = std::min(std::max(done, 1u), kMaxSamplesPerItem);
    const std::uint32_t count = std::min(doubling, settings.samples - done);
    ranges.push_back({settings.sample_offset + done, count});
    done += count;
  }
  return ranges;
}

}  // namespace

std::vector<WorkItem> work_items(const Rect& region, const Settings& settings) {
  const std::vector<Rect> tiles = tiles_from_centre(region, settings.tile_size);
  const std::vector<SampleRange> ranges = sample_ranges(settings);
  std::vector<WorkItem> items;
  items.reserve(tiles.size() * ranges.size());
  if (settings.use_progressive) {
    for (const SampleRange& range : ranges) {
      for (const Rect& tile : tiles) items.push_back({tile, range.first, range.count});
    }
  } else {
    for (const Rect& tile : tiles) {
      for (const SampleRange& range : ranges) items.push_back({tile, range.first, range.count});
    }
  }
  return items;
}

}  // namespace komorebi
