#pragma once

#include "shader/voronoi_cells.h"

namespace komorebi {

template <std::size_t N>
KOMOREBI_LANE void finish_found(const VoronoiKind& kind, const CellRows<N>& cells,
                                const VoronoiRow* offset, const VoronoiRow* point,
                                std::uint32_t count, VoronoiFound& found) {
  finish_distance<N>(kind, count, found.distance);
  color_rows<N>(kind, cells.cell, offset, count, found.color);
  for (std::size_t d = 0; d < N; ++d) {
    for (std::uint32_t i = 0; i < count; ++i) {
      found.position[d][i] = point[d][i] + cells.cell[d][i];
    }
  }
}

/// Of the point nearest to each lane: its place and cell, relative to the lane's, and measure.
template <std::size_t N>
struct Nearest {
  VoronoiRow measure, point[N], offset[N];

  KOMOREBI_LANE void clear(float far, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) measure[i] = far;
    for (std::size_t d = 0; d < N; ++d) {
      for (std::uint32_t i = 0; i < count; ++i) point[d][i] = offset[d][i] = 0.0f;
    }
  }
};

template <std::size_t N>
KOMOREBI_LANE void voronoi_nearest(const VoronoiKind& kind, const VoronoiRows& rows,
                                   std::uint32_t count, VoronoiFound& found) {
  CellRows<N> cells;
  find_cells<N>(rows, count, cells);
  Nearest<N> best;
  best.clear(kind.far, count);
  VoronoiRow offset[N], point[N], measure;
  Neighbours<N> at(1);
  do {
    at.fill(count, offset);
    point_rows<N>(kind, cells.cell, offset, rows.randomness, count, point);
    measure_rows<N>(kind, point, cells.local, rows.exponent, count, measure);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool nearer = measure[i] < best.measure[i];
      best.measure[i] = nearer ? measure[i] : best.measure[i];
      for (std::size_t d = 0; d < N; ++d) {
        best.point[d][i] = nearer ? point[d][i] : best.point[d][i];
        best.offset[d][i] = nearer ? offset[d][i] : best.offset[d][i];
      }
    }
  } while (at.next());
  for (std::uint32_t i = 0; i < count; ++i) found.distance[i] = best.measure[i];
  finish_found<N>(kind, cells, best.offset, best.point, count, found);
}

template <std::size_t N>
KOMOREBI_LANE void voronoi_second(const VoronoiKind& kind, const VoronoiRows& rows,
                                  std::uint32_t count, VoronoiFound& found) {
  CellRows<N> cells;
  find_cells<N>(rows, count, cells);
  Nearest<N> best, next;
  best.clear(kind.far, count);
  next.clear(kind.far, count);
  VoronoiRow offset[N], point[N], measure;
  Neighbours<N> at(1);
  do {
    at.fill(count, offset);
    point_rows<N>(kind, cells.cell, offset, rows.randomness, count, point);
    measure_rows<N>(kind, point, cells.local, rows.exponent, count, measure);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool first = measure[i] < best.measure[i], second = measure[i] < next.measure[i];
      const float other = second ? measure[i] : next.measure[i];
      next.measure[i] = first ? best.measure[i] : other;
      best.measure[i] = first ? measure[i] : best.measure[i];
      for (std::size_t d = 0; d < N; ++d) {
        const float other_point = second ? point[d][i] : next.point[d][i];
        const float other_offset = second ? offset[d][i] : next.offset[d][i];
        next.point[d][i] = first ? best.point[d][i] : other_point;
        next.offset[d][i] = first ? best.offset[d][i] : other_offset;
        best.point[d][i] = first ? point[d][i] : best.point[d][i];
        best.offset[d][i] = first ? offset[d][i] : best.offset[d][i];
      }
    }
  } while (at.next());
  for (std::uint32_t i = 0; i < count; ++i) found.distance[i] = next.measure[i];
  finish_found<N>(kind, cells, next.offset, next.point, count, found);
}

/// A running minimum that is rounded off where two are about equal, of distance, place and colour.
template <std::size_t N>
KOMOREBI_LANE void voronoi_smooth(const VoronoiKind& kind, const VoronoiRows& rows,
                                  std::uint32_t count, VoronoiFound& found) {
  CellRows<N> cells;
  find_cells<N>(rows, count, cells);
  VoronoiRow offset[N], point[N], distance, share, lost, color[3];
  Neighbours<N> at(2);
  bool is_first = true;
  do {
    at.fill(count, offset);
    point_rows<N>(kind, cells.cell, offset, rows.randomness, count, point);
    measure_rows<N>(kind, point, cells.local, rows.exponent, count, distance);
    finish_distance<N>(kind, count, distance);
    for (std::uint32_t i = 0; i < count; ++i) {
      const float s = rows.smoothness[i];
      const float before = is_first ? 0.0f : found.distance[i];
      const float h = is_first ? 1.0f : smoothstep01(0.5f + 0.5f * (before - distance[i]) / s);
      const float down = s * h * (1.0f - h);
      found.distance[i] = mix(before, distance[i], h) - down;
      share[i] = h;
      lost[i] = down / (1.0f + 3.0f * s);
    }
    for (std::size_t d = 0; d < N; ++d) {
      for (std::uint32_t i = 0; i < count; ++i) {
        const float before = is_first ? 0.0f : found.position[d][i];
        found.position[d][i] = mix(before, point[d][i], share[i]) - lost[i];
      }
    }
    if (kind.wants_color) color_rows<N>(kind, cells.cell, offset, count, color);
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::uint32_t i = 0; i < count; ++i) {
        const float before = is_first ? 0.0f : found.color[d][i];
        found.color[d][i] = kind.wants_color ? mix(before, color[d][i], share[i]) - lost[i] : 0.0f;
      }
    }
    is_first = false;
  } while (at.next());
  for (std::size_t d = 0; d < N; ++d) {
    for (std::uint32_t i = 0; i < count; ++i) found.position[d][i] += cells.cell[d][i];
  }
}

template <std::size_t N>
constexpr std::size_t kNeighbours = 3 * kNeighbours<N - 1>;
template <>
inline constexpr std::size_t kNeighbours<0> = 1;

/// The least distance to a plane halfway between the nearest point and another (Quilez).
template <std::size_t N>
KOMOREBI_LANE void voronoi_edge_distance(const VoronoiKind& kind, const VoronoiRows& rows,
                                         std::uint32_t count, float* __restrict out) {
  CellRows<N> cells;
  find_cells<N>(rows, count, cells);
  Nearest<N> best;
  best.clear(kind.far, count);
  VoronoiRow offset[N], measure, points[kNeighbours<N>][N];
  Neighbours<N> at(1);
  std::size_t n = 0;
  do {
    auto& point = points[n++];
    at.fill(count, offset);
    point_rows<N>(kind, cells.cell, offset, rows.randomness, count, point);
    squared_distance<N>(point, cells.local, count, measure);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool nearer = measure[i] < best.measure[i];
      best.measure[i] = nearer ? measure[i] : best.measure[i];
      for (std::size_t d = 0; d < N; ++d) {
        best.point[d][i] = nearer ? point[d][i] : best.point[d][i];
      }
    }
  } while (at.next());
  for (std::uint32_t i = 0; i < count; ++i) out[i] = kind.far;
  for (const auto& point : points) {
    for (std::uint32_t i = 0; i < count; ++i) {
      float across = 0.0f, middle = 0.0f;
      for (std::size_t d = 0; d < N; ++d) {
        const float step = point[d][i] - best.point[d][i];
        const float half = (point[d][i] + best.point[d][i]) * 0.5f - cells.local[d][i];
        across += step * step;
        middle += half * step;
      }
      const float distance = middle / __builtin_sqrtf(across);
      out[i] = across > 0.0001f ? smaller(distance, out[i]) : out[i];
    }
  }
}

/// In one dimension: to the middle between the cell's own point and its neighbours'.
template <>
KOMOREBI_LANE void voronoi_edge_distance<1>(const VoronoiKind& kind, const VoronoiRows& rows,
                                            std::uint32_t count, float* __restrict out) {
  CellRows<1> cells;
  find_cells<1>(rows, count, cells);
  VoronoiRow offset[1], points[3][1];
  Neighbours<1> at(1);
  std::size_t n = 0;
  do {
    at.fill(count, offset);
    point_rows<1>(kind, cells.cell, offset, rows.randomness, count, points[n++]);
  } while (at.next());
  for (std::uint32_t i = 0; i < count; ++i) {
    const float here = cells.local[0][i], own = points[1][0][i];
    out[i] = smaller(absolute((own + points[0][0][i]) * 0.5f - here),
                     absolute((own + points[2][0][i]) * 0.5f - here));
  }
}

template <std::size_t N>
KOMOREBI_LANE void voronoi_sphere_radius(const VoronoiKind& kind, const VoronoiRows& rows,
                                         std::uint32_t count, float* __restrict out) {
  CellRows<N> cells;
  find_cells<N>(rows, count, cells);
  Nearest<N> best;
  best.clear(kind.far, count);
  VoronoiRow offset[N], point[N], measure;
  Neighbours<N> at(1);
  do {
    at.fill(count, offset);
    point_rows<N>(kind, cells.cell, offset, rows.randomness, count, point);
    squared_distance<N>(point, cells.local, count, measure);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool nearer = measure[i] < best.measure[i];
      best.measure[i] = nearer ? measure[i] : best.measure[i];
      for (std::size_t d = 0; d < N; ++d) {
        best.point[d][i] = nearer ? point[d][i] : best.point[d][i];
        best.offset[d][i] = nearer ? offset[d][i] : best.offset[d][i];
      }
    }
  } while (at.next());
  for (std::uint32_t i = 0; i < count; ++i) out[i] = kind.far;
  Neighbours<N> around(1);
  do {
    if (around.is_middle()) continue;
    for (std::size_t d = 0; d < N; ++d) {
      for (std::uint32_t i = 0; i < count; ++i) {
        offset[d][i] = best.offset[d][i] + static_cast<float>(around.at(d));
      }
    }
    point_rows<N>(kind, cells.cell, offset, rows.randomness, count, point);
    squared_distance<N>(point, best.point, count, measure);
    for (std::uint32_t i = 0; i < count; ++i) out[i] = smaller(measure[i], out[i]);
  } while (around.next());
  for (std::uint32_t i = 0; i < count; ++i) out[i] = __builtin_sqrtf(out[i]) * 0.5f;
}

}  // namespace komorebi
