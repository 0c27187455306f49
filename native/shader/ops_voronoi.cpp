#include <algorithm>

#include "shader/op_numbers.h"
#include "shader/op_table.h"
#include "shader/voronoi.h"

namespace komorebi {
namespace {

// in: up to 4 coordinates, scale, detail, roughness, lacunarity, smoothness, exponent, randomness
// out: distance, colour, position in 4 dimensions as the coordinates are
// numbers: dimensions, VoronoiFeature, VoronoiMetric, normalize, pcg, far, wants_color
void voronoi_points(const OpCall& c) {
  VoronoiKind kind;
  kind.dimensions = dimension_count(c.numbers[0]);
  kind.feature = static_cast<VoronoiFeature>(choice(c.numbers[1], 2));
  kind.metric = static_cast<VoronoiMetric>(choice(c.numbers[2], 3));
  kind.normalize = c.numbers[3] != 0.0f;
  kind.pcg = c.numbers[4] != 0.0f;
  kind.far = c.numbers[5];
  kind.wants_color = c.numbers[6] != 0.0f;
  const VoronoiRows rows{{c.in[0], c.in[1], c.in[2], c.in[3]},
                         c.in[4],
                         c.in[5],
                         c.in[6],
                         c.in[7],
                         c.in[8],
                         c.in[9],
                         c.in[10]};
  VoronoiFound found;
  voronoi(kind, rows, c.count, found);
  std::copy_n(found.distance, c.count, c.out[0]);
  for (std::uint32_t k = 0; k < 3; ++k) std::copy_n(found.color[k], c.count, c.out[1 + k]);
  for (std::uint32_t d = 0; d < 4; ++d) std::copy_n(found.position[d], c.count, c.out[4 + d]);
}

// in: up to 4 coordinates, detail, roughness, lacunarity, randomness; out: distance
// numbers: dimensions, normalize, pcg
void voronoi_edges(const OpCall& c) {
  VoronoiKind kind;
  kind.dimensions = dimension_count(c.numbers[0]);
  kind.normalize = c.numbers[1] != 0.0f;
  kind.pcg = c.numbers[2] != 0.0f;
  const float* const unused = c.in[4];
  const VoronoiRows rows{{c.in[0], c.in[1], c.in[2], c.in[3]},
                         unused,
                         c.in[4],
                         c.in[5],
                         c.in[6],
                         unused,
                         unused,
                         c.in[7]};
  voronoi_edge(kind, rows, c.count, c.out[0]);
}

// in: up to 4 coordinates, randomness; out: radius
// numbers: dimensions, pcg
void voronoi_spheres(const OpCall& c) {
  VoronoiKind kind;
  kind.dimensions = dimension_count(c.numbers[0]);
  kind.pcg = c.numbers[1] != 0.0f;
  const float* const unused = c.in[4];
  const VoronoiRows rows{{c.in[0], c.in[1], c.in[2], c.in[3]},
                         unused,
                         unused,
                         unused,
                         unused,
                         unused,
                         unused,
                         c.in[4]};
  voronoi_radius(kind, rows, c.count, c.out[0]);
}

constexpr OpInfo kOps[] = {
    {"voronoi", &voronoi_points, 11, 8, 7},
    {"voronoi_edge", &voronoi_edges, 8, 1, 3},
    {"voronoi_radius", &voronoi_spheres, 5, 1, 2},
};

}  // namespace

std::span<const OpInfo> voronoi_ops() {
  return kOps;
}

}  // namespace komorebi
