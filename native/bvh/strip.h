#pragma once

#include <cstdint>

namespace komorebi {

/// Up to four triangles that follow each other in the mesh and fill hardly more room than the
/// largest of them, which builders handle as one item: exporters and scanners write neighbours one
/// after the other, so there are only two thirds as many strips as triangles, or half. A strip has
/// at most eight different vertices and so always fits into a leaf.
///
/// In one number: its first triangle, and in the two highest bits how many follow. An item that is
/// no triangle is a strip of one.
inline constexpr std::uint32_t kStripShift = 30;
inline constexpr std::uint32_t kMostInStrip = 4;
inline constexpr std::size_t kMostStrips = std::size_t{1} << kStripShift;

inline std::uint32_t strip_first(std::uint32_t strip) {
  return strip & ((1u << kStripShift) - 1u);
}
inline std::uint32_t strip_count(std::uint32_t strip) {
  return (strip >> kStripShift) + 1u;
}

}  // namespace komorebi
