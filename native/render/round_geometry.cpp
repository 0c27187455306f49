#include "render/round_geometry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/curve.h"
#include "render/mesh_geometry.h"

namespace komorebi {
namespace {

/// Radii beyond this overflow what is computed of them.
constexpr float kMaxRadius = 1e15f;

class Checker {
 public:
  Checker(const char* what, const std::string& name) : start_(std::string(what) + " \"" + name) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw std::invalid_argument(start_ + "\": " + why);
  }
  void count(std::size_t bad, const char* one, const char* many) const {
    if (bad) refuse(std::to_string(bad) + " " + (bad == 1 ? one : many));
  }
  void positions(std::span<const float> xyz, std::span<const float> radius,
                 const std::string& of) const {
    if (xyz.size() / 3 != radius.size()) refuse("radii must have one entry a " + of);
    if (radius.size() > kKeyMask) refuse("more " + of + "s than fit");
    count(not_finite(xyz), "position is not finite", "positions are not finite");
    count(no_radii(radius), "radius is negative or not finite", "radii are negative or not finite");
  }
  void motion(const RoundMotion& in, std::size_t rows, const std::string& of) const {
    const std::size_t times = rows ? in.positions.size() / (3 * rows) : 0;
    if (in.positions.size() != 3 * rows * times || times % 2 != 0 || times > kMostTimes) {
      refuse("motion_positions must have a row a " + of + " at an even number of times");
    }
    if (!in.radii.empty() && in.radii.size() != rows * times) {
      refuse("motion_radii must have an entry a " + of + " at the times of motion_positions");
    }
    if (!in.steps.empty() && (in.steps.size() != 6 * rows || !in.positions.empty())) {
      refuse("step_positions must have a row a " + of + " at two times, without others in time");
    }
    count(not_finite(in.positions), "position in time is not finite",
          "positions in time are not finite");
    count(no_radii(in.radii), "radius in time is negative or not finite",
          "radii in time are negative or not finite");
    count(not_finite(in.steps), "position at a step is not finite",
          "positions at a step are not finite");
  }

 private:
  static constexpr std::size_t kMostTimes = 4096;
  static std::size_t not_finite(std::span<const float> xyz) {
    std::size_t bad = 0;
    for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
      const bool finite =
          std::isfinite(xyz[i]) && std::isfinite(xyz[i + 1]) && std::isfinite(xyz[i + 2]);
      bad += finite ? 0u : 1u;
    }
    return bad;
  }
  static std::size_t no_radii(std::span<const float> radius) {
    return static_cast<std::size_t>(
        std::ranges::count_if(radius, [](float r) { return !(r >= 0.0f && r <= kMaxRadius); }));
  }

  std::string start_;
};

void check_curves(const CurvesInput& in) {
  const Checker checker("curves", in.name);
  checker.positions(in.key2xyz, in.key2radius, "key");
  checker.motion(in.motion, in.key2radius.size(), "key");
  const auto offsets = in.curve_offsets;
  if (offsets.empty()) checker.refuse("curve_offsets needs at least one entry");
  if (offsets.front() != 0 || static_cast<std::size_t>(offsets.back()) != in.key2radius.size()) {
    checker.refuse("curve_offsets must run from 0 to the number of keys, " +
                   std::to_string(in.key2radius.size()));
  }
  std::size_t bad = 0;
  for (std::size_t c = 0; c + 1 < offsets.size(); ++c) bad += offsets[c + 1] < offsets[c] ? 1u : 0u;
  checker.count(bad, "curve ends before it begins", "curves end before they begin");
  const std::size_t curves = offsets.size() - 1;
  if (!in.curve2material.empty() && in.curve2material.size() != curves) {
    checker.refuse("curve_materials must have one entry a curve");
  }
  checker.count(static_cast<std::size_t>(std::ranges::count_if(
                    in.curve2material, [](std::int32_t slot) { return slot < 0 || slot > 32767; })),
                "curve has a material slot outside 0 to 32767",
                "curves have a material slot outside 0 to 32767");
  if (!in.curve2uv.empty() && in.curve2uv.size() != 2 * curves) {
    checker.refuse("curve_uvs must have one row a curve");
  }
  if (in.subdivisions > kMaxSubdivisions) {
    checker.refuse("subdivisions must be at most " + std::to_string(kMaxSubdivisions));
  }
}

}  // namespace

std::size_t RoundGeometry::byte_count() const {
  return sizeof(RoundGeometry) + points.capacity() * sizeof(float) +
         segment2key.capacity() * sizeof(std::uint32_t) + tree.byte_count();
}

void RoundGeometry::fill(MeshView& view) const {
  view.kind = kind;
  view.shape = shape;
  view.pieces = pieces;
  view.segment_parts = segment_parts;
  view.primitive_count = primitive_count();
  view.point_count = point_count();
  view.position_sets = sets;
  view.points = points.data();
  view.segment2key = segment2key.data();
  view.leaf_grid = tree.grid;
  if (tree.views.empty()) return;  // it is about to be built
  if (sets > 1) {
    view.time_trees = tree.views.data();
    view.time_tree_count = static_cast<std::uint32_t>(tree.views.size());
  } else {
    view.tree = tree.views.front().tree;
    view.leaves = tree.views.front().leaves;
  }
}

void RoundGeometry::take_points(std::span<const float> xyz, std::span<const float> radius,
                                ThreadPool& pool) {
  constexpr std::size_t kGrain = 1 << 15;
  MeshGeometry moved;
  moved.take_positions(xyz, pool);
  origin = moved.origin;
  points.resize(4 * radius.size());
  pool.for_each_chunk(radius.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t c = 0; c < 3; ++c) points[4 * i + c] = moved.vtx2xyz[3 * i + c];
      points[4 * i + 3] = radius[i];
    }
  });
}

void RoundGeometry::take_sets(std::span<const float> xyz, std::span<const float> radius,
                              const RoundMotion& motion, ThreadPool& pool) {
  if (motion.positions.empty()) return take_points(xyz, radius, pool);
  const std::vector<float> positions = in_order(motion.positions, xyz);
  sets = static_cast<std::uint32_t>(positions.size() / xyz.size());
  std::vector<float> radii = in_order(motion.radii, radius);
  while (motion.radii.empty() && radii.size() < positions.size() / 3) {
    radii.insert(radii.end(), radius.begin(), radius.end());
  }
  take_points(positions, radii, pool);
}

void RoundGeometry::build_tree(Builder builder, ThreadPool& pool, const Cancel& cancel) {
  MeshView view;
  fill(view);
  tree = build_round_tree(view, builder, pool, cancel);
}

RoundGeometry RoundGeometry::transformed(const Mat4d& matrix, Builder builder, ThreadPool& pool,
                                         const Cancel& cancel) const {
  const double growth = std::cbrt(std::abs(glm::determinant(Mat3d(matrix))));
  std::vector<float> xyz(points.size() / 4 * 3), radius(points.size() / 4);
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const Vec3d local = Vec3d(points[4 * i], points[4 * i + 1], points[4 * i + 2]) + origin;
    const Vec3d moved(matrix * glm::dvec4(local, 1.0));
    for (int c = 0; c < 3; ++c) xyz[3 * i + std::size_t(c)] = static_cast<float>(moved[c]);
    radius[i] = static_cast<float>(growth * double(points[4 * i + 3]));
  }
  RoundGeometry result;
  result.kind = kind;
  result.sets = sets;
  result.shape = shape;
  result.subdivisions = subdivisions;
  result.pieces = pieces;
  result.segment_parts = segment_parts;
  result.segment2key = segment2key;
  result.take_points(xyz, radius, pool);
  result.build_tree(builder, pool, cancel);
  return result;
}

std::vector<std::int32_t> RoundGeometry::curve_offsets() const {
  std::vector<std::int32_t> offsets{0};
  // Keys of no segment were curves of one key.
  const auto fill_up_to = [&](std::uint32_t key) {
    while (offsets.back() < static_cast<std::int32_t>(key)) offsets.push_back(offsets.back() + 1);
  };
  for (const std::uint32_t entry : segment2key) {
    const std::uint32_t key = entry & kKeyMask;
    if (entry & kFirstOfCurve) fill_up_to(key);
    if (entry & kLastOfCurve) offsets.push_back(static_cast<std::int32_t>(key + 2));
  }
  fill_up_to(point_count());
  return offsets;
}

RoundGeometry build_curves(const CurvesInput& in, Builder builder, ThreadPool& pool,
                           const Cancel& cancel) {
  check_curves(in);
  check(cancel);
  RoundGeometry geometry;
  geometry.kind = PrimitiveKind::kCurve;
  geometry.shape = in.shape;
  geometry.subdivisions = in.subdivisions;
  geometry.pieces = in.shape == CurveShape::kRibbon  ? (1u << in.subdivisions) + 1
                    : in.shape == CurveShape::kThick ? kThickPieces
                                                     : 1;
  geometry.take_sets(in.key2xyz, in.key2radius, in.motion, pool);
  std::size_t segments = 0;
  for (std::size_t c = 0; c + 1 < in.curve_offsets.size(); ++c) {
    const std::int32_t keys = in.curve_offsets[c + 1] - in.curve_offsets[c];
    segments += keys > 1 ? static_cast<std::size_t>(keys - 1) : 0;
  }
  geometry.segment2key.resize(segments);
  std::size_t segment = 0;
  for (std::size_t c = 0; c + 1 < in.curve_offsets.size(); ++c) {
    const std::int32_t first = in.curve_offsets[c], end = in.curve_offsets[c + 1];
    for (std::int32_t key = first; key + 1 < end; ++key) {
      geometry.segment2key[segment++] = static_cast<std::uint32_t>(key) |
                                        (key == first ? kFirstOfCurve : 0) |
                                        (key + 2 == end ? kLastOfCurve : 0);
    }
  }
  geometry.build_tree(builder, pool, cancel);
  return geometry;
}

RoundGeometry build_points(const PointsInput& in, Builder builder, ThreadPool& pool,
                           const Cancel& cancel) {
  const Checker checker("points", in.name);
  checker.positions(in.point2xyz, in.point2radius, "point");
  checker.motion(in.motion, in.point2radius.size(), "point");
  check(cancel);
  RoundGeometry geometry;
  geometry.kind = PrimitiveKind::kSphere;
  geometry.take_sets(in.point2xyz, in.point2radius, in.motion, pool);
  geometry.build_tree(builder, pool, cancel);
  return geometry;
}

}  // namespace komorebi
