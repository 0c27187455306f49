#pragma once

#include <cstddef>

#include "shader/hash.h"
#include "shader/voronoi_kernel.h"

/// Loops over lanes that the features of Voronoi's diagram are made of (KOMOREBI_LANE in lane.h).
namespace komorebi {

/// The cells that points lie in, and where in them.
template <std::size_t N>
struct CellRows {
  VoronoiRow cell[N], local[N];
};

template <std::size_t N>
KOMOREBI_LANE void find_cells(const VoronoiRows& rows, std::uint32_t count, CellRows<N>& cells) {
  constexpr float kAllWhole = 8388608.0f;  // floats from here on
  for (std::size_t d = 0; d < N; ++d) {
    const float* const p = rows.p[d];
    for (std::uint32_t i = 0; i < count; ++i) {
      const float below = static_cast<float>(floor_lane(p[i]));
      const float cell = absolute(p[i]) < kAllWhole ? below : p[i];
      cells.cell[d][i] = cell;
      cells.local[d][i] = p[i] - cell;
    }
  }
}

/// Where in its cell a cell's point is.
template <std::size_t N, bool Pcg>
KOMOREBI_LANE void hash_point(const float (&at)[N], float (&out)[N]) {
  if constexpr (N == 1) {
    out[0] = hash_floats(at[0]);
  } else if constexpr (Pcg) {
    std::uint32_t k[N];
    for (std::size_t d = 0; d < N; ++d) k[d] = static_cast<std::uint32_t>(floor_lane(at[d]));
    hash_pcg(k, out);
  } else if constexpr (N == 2) {
    out[0] = hash_floats(at[0], at[1]);
    out[1] = hash_floats(at[0], at[1], 1.0f);
  } else if constexpr (N == 3) {
    out[0] = hash_floats(at[0], at[1], at[2]);
    out[1] = hash_floats(at[0], at[1], at[2], 1.0f);
    out[2] = hash_floats(at[0], at[1], at[2], 2.0f);
  } else {
    out[0] = hash_floats(at[0], at[1], at[2], at[3]);
    out[1] = hash_floats(at[3], at[0], at[1], at[2]);
    out[2] = hash_floats(at[2], at[3], at[0], at[1]);
    out[3] = hash_floats(at[1], at[2], at[3], at[0]);
  }
}

/// A cell's colour.
template <std::size_t N, bool Pcg>
KOMOREBI_LANE void hash_color(const float (&at)[N], float (&out)[3]) {
  if constexpr (N == 1) {
    out[0] = hash_floats(at[0]);
    out[1] = hash_floats(at[0], 1.0f);
    out[2] = hash_floats(at[0], 2.0f);
  } else if constexpr (N == 3) {
    hash_point<3, Pcg>(at, out);
  } else if constexpr (N == 2 && Pcg) {
    const float flat[3] = {at[0], at[1], 0.0f};
    hash_point<3, true>(flat, out);
  } else if constexpr (N == 2) {
    out[0] = hash_floats(at[0], at[1]);
    out[1] = hash_floats(at[0], at[1], 1.0f);
    out[2] = hash_floats(at[0], at[1], 2.0f);
  } else if constexpr (Pcg) {
    float all[4];
    hash_point<4, true>(at, all);
    for (std::size_t d = 0; d < 3; ++d) out[d] = all[d];
  } else {
    out[0] = hash_floats(at[0], at[1], at[2], at[3]);
    out[1] = hash_floats(at[2], at[0], at[3], at[1]);
    out[2] = hash_floats(at[3], at[2], at[1], at[0]);
  }
}

template <std::size_t N, bool Pcg>
KOMOREBI_LANE void point_rows_of(const VoronoiRow* cell, const VoronoiRow* offset,
                                 const float* randomness, std::uint32_t count, VoronoiRow* point) {
  for (std::uint32_t i = 0; i < count; ++i) {
    float at[N], hash[N];
    for (std::size_t d = 0; d < N; ++d) at[d] = cell[d][i] + offset[d][i];
    hash_point<N, Pcg>(at, hash);
    for (std::size_t d = 0; d < N; ++d) point[d][i] = offset[d][i] + hash[d] * randomness[i];
  }
}

/// The points of the cells `offset` away, relative to the cells that lanes are in.
template <std::size_t N>
KOMOREBI_LANE void point_rows(const VoronoiKind& kind, const VoronoiRow* cell,
                              const VoronoiRow* offset, const float* randomness,
                              std::uint32_t count, VoronoiRow* point) {
  if (kind.pcg) {
    point_rows_of<N, true>(cell, offset, randomness, count, point);
  } else {
    point_rows_of<N, false>(cell, offset, randomness, count, point);
  }
}

template <std::size_t N, bool Pcg>
KOMOREBI_LANE void color_rows_of(const VoronoiRow* cell, const VoronoiRow* offset,
                                 std::uint32_t count, VoronoiRow* color) {
  for (std::uint32_t i = 0; i < count; ++i) {
    float at[N], hash[3];
    for (std::size_t d = 0; d < N; ++d) at[d] = cell[d][i] + offset[d][i];
    hash_color<N, Pcg>(at, hash);
    for (std::size_t d = 0; d < 3; ++d) color[d][i] = hash[d];
  }
}

template <std::size_t N>
KOMOREBI_LANE void color_rows(const VoronoiKind& kind, const VoronoiRow* cell,
                              const VoronoiRow* offset, std::uint32_t count, VoronoiRow* color) {
  if (kind.pcg) {
    color_rows_of<N, true>(cell, offset, count, color);
  } else {
    color_rows_of<N, false>(cell, offset, count, color);
  }
}

template <std::size_t N>
KOMOREBI_LANE void squared_distance(const VoronoiRow* a, const VoronoiRow* b, std::uint32_t count,
                                    float* __restrict out) {
  for (std::uint32_t i = 0; i < count; ++i) {
    float sum = 0.0f;
    for (std::size_t d = 0; d < N; ++d) sum += (a[d][i] - b[d][i]) * (a[d][i] - b[d][i]);
    out[i] = sum;
  }
}

/// Minkowski's distance. Exponent 1/2, which a new node has, stays in the loop: the very roots and
/// squares that add_powers and take_roots take, lane by lane, for it.
template <std::size_t N>
KOMOREBI_LANE void minkowski_rows(const VoronoiRow* a, const VoronoiRow* b, const float* exponent,
                                  std::uint32_t count, float* __restrict out) {
  std::uint32_t others = 0;
  for (std::uint32_t i = 0; i < count; ++i) others |= exponent[i] != 0.5f;
  if (others == 0) {
    for (std::uint32_t i = 0; i < count; ++i) {
      float sum = 0.0f;
      for (std::size_t d = 0; d < N; ++d) sum += __builtin_sqrtf(absolute(a[d][i] - b[d][i]));
      out[i] = sum * sum;
    }
    return;
  }
  for (std::size_t d = 0; d < N; ++d) add_powers(a[d], b[d], exponent, count, d == 0, out);
  take_roots(exponent, count, out);
}

/// A measure that orders points as the distance does: its square where it is Euclidean.
template <std::size_t N>
KOMOREBI_LANE void measure_rows(const VoronoiKind& kind, const VoronoiRow* a, const VoronoiRow* b,
                                const float* exponent, std::uint32_t count, float* __restrict out) {
  if (N == 1 || kind.metric == VoronoiMetric::kManhattan) {
    for (std::uint32_t i = 0; i < count; ++i) {
      float sum = 0.0f;
      for (std::size_t d = 0; d < N; ++d) sum += absolute(a[d][i] - b[d][i]);
      out[i] = sum;
    }
  } else if (kind.metric == VoronoiMetric::kEuclidean) {
    squared_distance<N>(a, b, count, out);
  } else if (kind.metric == VoronoiMetric::kChebychev) {
    for (std::uint32_t i = 0; i < count; ++i) {
      float most = 0.0f;
      for (std::size_t d = 0; d < N; ++d) most = larger(most, absolute(a[d][i] - b[d][i]));
      out[i] = most;
    }
  } else {
    minkowski_rows<N>(a, b, exponent, count, out);
  }
}

/// Of a measure to the distance itself.
template <std::size_t N>
KOMOREBI_LANE void finish_distance(const VoronoiKind& kind, std::uint32_t count, float* x) {
  if (N == 1 || kind.metric != VoronoiMetric::kEuclidean) return;
  for (std::uint32_t i = 0; i < count; ++i) x[i] = __builtin_sqrtf(x[i]);
}

/// Counts through the cells within `reach` of one in every direction, x first.
template <std::size_t N>
class Neighbours {
 public:
  KOMOREBI_LANE explicit Neighbours(int reach) : reach_(reach) {
    for (std::size_t d = 0; d < N; ++d) at_[d] = -reach;
  }
  KOMOREBI_LANE int at(std::size_t d) const { return at_[d]; }
  KOMOREBI_LANE bool is_middle() const {
    bool middle = true;
    for (std::size_t d = 0; d < N; ++d) middle = middle && at_[d] == 0;
    return middle;
  }
  KOMOREBI_LANE void fill(std::uint32_t count, VoronoiRow* offset) const {
    for (std::size_t d = 0; d < N; ++d) {
      for (std::uint32_t i = 0; i < count; ++i) offset[d][i] = static_cast<float>(at_[d]);
    }
  }
  /// False after the last.
  KOMOREBI_LANE bool next() {
    for (std::size_t d = 0; d < N; ++d) {
      if (++at_[d] <= reach_) return true;
      at_[d] = -reach_;
    }
    return false;
  }

 private:
  int reach_, at_[N];
};

}  // namespace komorebi
