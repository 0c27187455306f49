#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/camera.h"

namespace komorebi {

/// About `points` pixels, evenly over the full frame, or every pixel of a small one: where a scene
/// is looked at before it is rendered. A border does not change them.
class PixelGrid {
 public:
  PixelGrid(const CameraView& camera, double points)
      : width_(2.0 * camera.film_center_x), height_(2.0 * camera.film_center_y) {
    const double spacing = std::max(1.0, std::sqrt(width_ * height_ / points));
    columns_ = static_cast<std::uint32_t>(std::max(1.0, width_ / spacing));
    rows_ = static_cast<std::uint32_t>(std::max(1.0, height_ / spacing));
  }

  std::uint32_t columns() const { return columns_; }
  std::uint32_t rows() const { return rows_; }
  std::size_t size() const { return std::size_t{columns_} * rows_; }
  std::uint32_t x(std::uint32_t column) const { return middle(column, columns_, width_); }
  std::uint32_t y(std::uint32_t row) const { return middle(row, rows_, height_); }

 private:
  static std::uint32_t middle(std::uint32_t i, std::uint32_t count, double size) {
    return static_cast<std::uint32_t>((i + 0.5) / count * size);
  }

  double width_, height_;
  std::uint32_t columns_, rows_;
};

}  // namespace komorebi
