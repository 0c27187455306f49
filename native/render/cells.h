#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/settings.h"

namespace komorebi {

/// Adaptive sampling decides on a fixed grid of the full frame, so that neither tiles nor a border
/// can show in what it decides.
inline constexpr std::uint32_t kCellSize = 8;

/// Pixels that are rendered together: rectangles (full-frame pixels) that each lie within one cell.
/// Pixel i of them counts through rectangle after rectangle, row by row.
using Cells = std::span<const Rect>;

/// The parts of the grid's cells that lie in `rect`, row by row.
std::vector<Rect> cells_of(const Rect& rect);

std::size_t pixel_count(Cells cells);

}  // namespace komorebi
