#include "render/tiles.h"

#include <algorithm>

namespace komorebi {
namespace {

constexpr std::size_t kTilesPerThread = 8;

std::size_t tile_count(const Rect& r, std::uint32_t size) {
  const std::size_t across = (r.x_max - 1) / size - r.x_min / size + 1;
  return across * ((r.y_max - 1) / size - r.y_min / size + 1);
}

}  // namespace

std::vector<Rect> make_tiles(const Rect& region, std::uint32_t wanted, unsigned threads) {
  std::uint32_t size = (wanted + kCellSize - 1) / kCellSize * kCellSize;
  while (size >= 4 * kCellSize && tile_count(region, size) < kTilesPerThread * threads) {
    size = size / 2 / kCellSize * kCellSize;
  }
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

Rect whole_cells(const Rect& region, std::uint32_t frame_width, std::uint32_t frame_height) {
  const auto up = [](std::uint32_t x) { return (x + kCellSize - 1) / kCellSize * kCellSize; };
  return {region.x_min / kCellSize * kCellSize, region.y_min / kCellSize * kCellSize,
          std::min(up(region.x_max), frame_width), std::min(up(region.y_max), frame_height)};
}

}  // namespace komorebi
