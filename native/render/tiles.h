#pragma once

#include <vector>

#include "render/settings.h"

namespace komorebi {

/// A piece of a render: these sample indices of every pixel of this tile.
struct WorkItem {
  Rect tile;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// The order in which a frame is rendered: tiles from the centre out and, when progressive, one
/// pass over all tiles after another (1 sample, then doubling, at most 16 at a time, so that
/// threads end together), so that a cancelled picture is whole and only noisier. Else tile by tile
/// to its end. Tile borders lie on multiples of tile_size in the full frame.
std::vector<WorkItem> work_items(const Rect& region, const Settings& settings);

}  // namespace komorebi
