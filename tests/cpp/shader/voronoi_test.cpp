#include "shader/voronoi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bvh/traverse.h"
#include "shader/voronoi_cells.h"

namespace komorebi {
namespace {

constexpr std::uint32_t kLanes = Program::kLanes;

struct Rows {
  VoronoiRow p[4], one, zero, half, two, three, smoothness;

  Rows() {
    for (std::uint32_t i = 0; i < kLanes; ++i) {
      const auto x = static_cast<float>(i);
      for (std::uint32_t d = 0; d < 4; ++d)
        p[d][i] = 0.37f * x - 9.1f + 1.7f * static_cast<float>(d);
      one[i] = 1.0f;
      zero[i] = 0.0f;
      half[i] = 0.5f;
      two[i] = 2.0f;
      three[i] = 3.0f;
      smoothness[i] = i % 3 == 0 ? 0.0f : 0.01f * x;
    }
  }
  VoronoiRows from(std::uint32_t i, const float* detail) const {
    return {{p[0] + i, p[1] + i, p[2] + i, p[3] + i},
            one + i,
            detail + i,
            half + i,
            two + i,
            smoothness + i,
            three + i,
            one + i};
  }
};

struct Point {
  double at[3], distance;
};

// All points of the cells within one of the lane's, nearest first, in three dimensions.
std::vector<Point> points_around(const Rows& rows, std::uint32_t i, VoronoiMetric metric,
                                 bool pcg) {
  std::vector<Point> points;
  for (int c = 0; c < 27; ++c) {
    const int step[3] = {c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1};
    float cell[3], hash[3];
    for (int d = 0; d < 3; ++d) cell[d] = std::floor(rows.p[d][i]) + static_cast<float>(step[d]);
    if (pcg) {
      hash_point<3, true>(cell, hash);
    } else {
      hash_point<3, false>(cell, hash);
    }
    Point point{};
    double sum = 0.0, most = 0.0, squares = 0.0, cubes = 0.0;
    for (int d = 0; d < 3; ++d) {
      point.at[d] = double{cell[d]} + double{hash[d]};
      const double apart = std::abs(point.at[d] - double{rows.p[d][i]});
      sum += apart;
      most = std::max(most, apart);
      squares += apart * apart;
      cubes += apart * apart * apart;
    }
    point.distance = metric == VoronoiMetric::kManhattan   ? sum
                     : metric == VoronoiMetric::kChebychev ? most
                     : metric == VoronoiMetric::kEuclidean ? std::sqrt(squares)
                                                           : std::cbrt(cubes);
    points.push_back(point);
  }
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.distance < b.distance; });
  return points;
}

TEST(Voronoi, NearestAndSecondAreThoseOfAllPoints) {
  const Rows rows;
  for (const bool pcg : {false, true}) {
    for (std::uint32_t m = 0; m < 4; ++m) {
      VoronoiKind kind;
      kind.metric = static_cast<VoronoiMetric>(m);
      kind.pcg = pcg;
      VoronoiFound first, second;
      voronoi(kind, rows.from(0, rows.zero), kLanes, first);
      kind.feature = VoronoiFeature::kF2;
      voronoi(kind, rows.from(0, rows.zero), kLanes, second);
      for (std::uint32_t i = 0; i < kLanes; ++i) {
        const std::vector<Point> points = points_around(rows, i, kind.metric, pcg);
        EXPECT_NEAR(first.distance[i], points[0].distance, 2e-6);
        EXPECT_NEAR(second.distance[i], points[1].distance, 2e-6);
        for (int d = 0; d < 3; ++d) EXPECT_NEAR(first.position[d][i], points[0].at[d], 3e-6);
      }
    }
  }
}

TEST(Voronoi, EdgeIsWhereTwoPointsAreEquallyFar) {
  const Rows rows;
  VoronoiRow edge;
  voronoi_edge({}, rows.from(0, rows.zero), kLanes, edge);
  for (std::uint32_t i = 0; i < kLanes; ++i) {
    const std::vector<Point> points = points_around(rows, i, VoronoiMetric::kEuclidean, false);
    double least = 1e9;
    for (std::size_t k = 1; k < points.size(); ++k) {
      double apart = 0.0;
      for (int d = 0; d < 3; ++d) {
        apart += std::pow(points[k].at[d] - points[0].at[d], 2.0);
      }
      const double far = points[k].distance, near = points[0].distance;
      least = std::min(least, (far * far - near * near) / (2.0 * std::sqrt(apart)));
    }
    EXPECT_NEAR(edge[i], least, 1e-5);
  }
}

bool same(const VoronoiFound& a, std::uint32_t i, const VoronoiFound& b, std::uint32_t k,
          std::uint32_t dimensions) {
  bool is_same = a.distance[i] == b.distance[k];
  for (int c = 0; c < 3; ++c) is_same = is_same && a.color[c][i] == b.color[c][k];
  for (std::uint32_t d = 0; d < dimensions; ++d) {
    is_same = is_same && a.position[d][i] == b.position[d][k];
  }
  return is_same;
}

TEST(Voronoi, EachLaneAndInstructionSetGivesTheSame) {
  const Rows rows;
  for (std::uint32_t dimensions = 1; dimensions <= 4; ++dimensions) {
    for (std::uint32_t feature = 0; feature < 3; ++feature) {
      VoronoiKind kind;
      kind.dimensions = dimensions;
      kind.feature = static_cast<VoronoiFeature>(feature);
      kind.normalize = true;
      VoronoiFound plain, all, one;
      force_instruction_set("SCALAR");
      voronoi(kind, rows.from(0, rows.half), kLanes, plain);
      for (const std::string& name : built_instruction_sets()) {
        force_instruction_set(name);
        voronoi(kind, rows.from(0, rows.half), kLanes, all);
        for (std::uint32_t i = 0; i < kLanes; ++i) {
          EXPECT_TRUE(same(plain, i, all, i, dimensions)) << name << " " << dimensions << feature;
        }
      }
      force_instruction_set("");
      for (std::uint32_t i = 0; i < kLanes; i += 7) {
        voronoi(kind, rows.from(i, rows.half), 1, one);
        EXPECT_TRUE(same(plain, i, one, 0, dimensions)) << dimensions << feature << " " << i;
      }
    }
  }
}

// The usual exponent has a loop of its own, which lanes take only together.
TEST(Voronoi, AnExponentIsTheSameBesideOthers) {
  const Rows rows;
  VoronoiRow mixed;
  for (std::uint32_t i = 0; i < kLanes; ++i) mixed[i] = i % 2 == 0 ? 0.5f : 1.7f;
  VoronoiKind kind;
  kind.metric = VoronoiMetric::kMinkowski;
  VoronoiFound alone, beside;
  VoronoiRows given = rows.from(0, rows.zero);
  given.exponent = rows.half;
  voronoi(kind, given, kLanes, alone);
  given.exponent = mixed;
  voronoi(kind, given, kLanes, beside);
  for (std::uint32_t i = 0; i < kLanes; i += 2) EXPECT_TRUE(same(alone, i, beside, i, 3)) << i;
}

TEST(Voronoi, RadiusIsHalfTheWayToTheNearestOther) {
  const Rows rows;
  VoronoiRow radius;
  VoronoiKind kind;
  kind.dimensions = 1;
  voronoi_radius(kind, rows.from(0, rows.zero), kLanes, radius);
  for (std::uint32_t i = 0; i < kLanes; ++i) {
    double nearest = 1e9, own = 0.0, other = 1e9;
    const float cell = std::floor(rows.p[0][i]);
    const auto at = [](float c) { return double{c} + double{hash_floats(c)}; };
    float own_cell = cell;
    for (int s = -1; s <= 1; ++s) {
      const float c = cell + static_cast<float>(s);
      if (std::abs(at(c) - double{rows.p[0][i]}) < nearest) {
        own = at(c);
        own_cell = c;
        nearest = std::abs(own - double{rows.p[0][i]});
      }
    }
    for (const float c : {own_cell - 1.0f, own_cell + 1.0f}) {
      other = std::min(other, std::abs(at(c) - own));
    }
    EXPECT_NEAR(radius[i], other / 2.0, 2e-6);
  }
}

}  // namespace
}  // namespace komorebi
