#pragma once

#include <vector>

#include "render/cells.h"

namespace komorebi {

/// Cuts a region into tiles, from its centre out. Their borders lie on multiples of the tile size
/// in the full frame, and so on those of cells: the size is `wanted` rounded up to whole cells, or
/// less, down to two cells, where the region would not give every thread some tiles.
std::vector<Rect> make_tiles(const Rect& region, std::uint32_t wanted, unsigned threads);

/// The grid's cells that `region` touches, whole (as far as the frame reaches).
Rect whole_cells(const Rect& region, std::uint32_t frame_width, std::uint32_t frame_height);

}  // namespace komorebi
