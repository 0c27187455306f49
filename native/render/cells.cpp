#include "render/cells.h"

#include <algorithm>

namespace komorebi {

std::vector<Rect> cells_of(const Rect& rect) {
  constexpr std::uint32_t kSize = kCellSize;
  std::vector<Rect> cells;
  for (std::uint32_t y = rect.y_min / kSize * kSize; y < rect.y_max; y += kSize) {
    for (std::uint32_t x = rect.x_min / kSize * kSize; x < rect.x_max; x += kSize) {
      cells.push_back({std::max(x, rect.x_min), std::max(y, rect.y_min),
                       std::min(x + kSize, rect.x_max), std::min(y + kSize, rect.y_max)});
    }
  }
  return cells;
}

std::size_t pixel_count(Cells cells) {
  std::size_t count = 0;
  for (const Rect& cell : cells) count += cell.area();
  return count;
}

}  // namespace komorebi
