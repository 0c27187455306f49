#pragma once

#include "core/round_key.h"
#include "core/round_ray.h"
#include "core/scene_view.h"

namespace komorebi {

/// Curves through keys (x, y, z and radius each) are Catmull–Rom splines in all four, segment by
/// segment (Catmull and Rom 1974); the first and the last key of a curve stand for their own
/// neighbours. A segment is cut into pieces at equal steps of u.
///
/// A ribbon is as wide as the curve and faces every ray: in the plane across the ray each piece is
/// a quadrilateral whose sides at both ends stand square on the curve, as deep as the curve there.
/// That is the flat curve of Embree and Cycles, with as many pieces.
///
/// A thick curve is swept by a circle square on the curve. Seen along a ray (Reshetov and Luebke
/// 2018, "Phantom Ray-Hair Intersector", §3, put the same two conditions), a point of it lies at
/// depth z(u) − √(r² − ρ²), ρ being the distance of the curve from the ray, and where the circle is
/// square on the curve, this function of u vanishes:
///
///     g(u) = −(x x′ + y y′) − z′ √(r² − ρ²)
///
/// g falls through null where the ray enters. Beyond the curve's width the root is taken as null;
/// then g falls through null where the curve is nearest to the ray. So whatever the ray meets lies
/// between two ends of a piece at which g changes from positive to negative, and is found there by
/// bracketing alone. Curves have no caps and, as in Cycles, no inside: a ray that starts there
/// leaves.
///
/// A linear thick curve is what a sphere sweeps that runs straight from key to key, its ends too:
/// cones between spheres, as in Cycles and Embree. See meet_swept_sphere().
struct CurveHit {
  float t;
  float u;  ///< along the segment, 0 at its first key
  float v;  ///< across a ribbon, −1…1; 0 for thick curves
};

inline constexpr std::uint32_t kFirstOfCurve = 1u << 31;
inline constexpr std::uint32_t kLastOfCurve = 1u << 30;
inline constexpr std::uint32_t kKeyMask = kLastOfCurve - 1;  ///< also the most keys that a set has
/// Pieces of a thick segment; whoever looks at it sees none of them.
inline constexpr std::uint32_t kThickPieces = 4;

/// One segment as a cubic in Hermite's form.
struct CurveSegment {
  Vec4d begin, end;              ///< where it begins and ends
  Vec4d begin_slope, end_slope;  ///< its derivatives there
  Vec4d a, b;                    ///< of u³ and u²

  /// The ends are met exactly, so that neighbours meet there in every bit.
  Vec4d point(double u) const {
    if (u >= 1.0) return end;
    return u * (u * (u * a + b) + begin_slope) + begin;
  }
  Vec4d slope(double u) const {
    if (u >= 1.0) return end_slope;
    return u * (3.0 * u * a + 2.0 * b) + begin_slope;
  }
  /// Bounds every coordinate's second derivative: it is linear.
  Vec4d bend() const {
    const Vec4d first = 2.0 * b, last = 6.0 * a + 2.0 * b;
    const auto larger = [](double p, double q) { return std::max(std::abs(p), std::abs(q)); };
    return {Vec3d(larger(first.at.x, last.at.x), larger(first.at.y, last.at.y),
                  larger(first.at.z, last.at.z)),
            larger(first.radius, last.radius)};
  }
};

inline CurveSegment make_segment(const Vec4d& before, const Vec4d& begin, const Vec4d& end,
                                 const Vec4d& after) {
  CurveSegment s;
  s.begin = begin;
  s.end = end;
  s.begin_slope = 0.5 * (end - before);
  s.end_slope = 0.5 * (after - begin);
  s.a = 2.0 * (begin - end) + (s.begin_slope + s.end_slope);
  s.b = 3.0 * (end - begin) - (2.0 * s.begin_slope + s.end_slope);
  return s;
}

/// A segment on which everything changes evenly.
inline CurveSegment make_straight_segment(const Vec4d& begin, const Vec4d& end) {
  const Vec4d chord = end - begin;
  return {begin, end, chord, chord, 0.0 * chord, 0.0 * chord};
}

/// A segment from the four keys that it depends on, which `key_at` gives.
/// @param entry  of segment2key
template <class KeyAt>
CurveSegment segment_of_keys(CurveShape shape, std::uint32_t entry, const KeyAt& key_at) {
  const std::uint32_t key = entry & kKeyMask;
  const Vec4d begin = key_at(key), end = key_at(key + 1);
  if (shape == CurveShape::kThickLinear) return make_straight_segment(begin, end);
  const Vec4d before = entry & kFirstOfCurve ? begin : key_at(key - 1);
  const Vec4d after = entry & kLastOfCurve ? end : key_at(key + 2);
  return make_segment(before, begin, end, after);
}

inline CurveSegment curve_segment(const MeshView& mesh, std::uint32_t entry,
                                  const MotionPlace& time) {
  return segment_of_keys(mesh.shape, entry,
                         [&](std::uint32_t key) { return round_key(mesh, key, time); });
}

/// The segment as `ray` sees it: x and y across, z along.
inline CurveSegment seen_segment(const MeshView& mesh, std::uint32_t entry, const RoundRay& ray) {
  return segment_of_keys(mesh.shape, entry, [&](std::uint32_t key) {
    const Vec4d at = round_key(mesh, key, ray.time);
    return Vec4d{ray.seen(at.at), at.radius};
  });
}

/// What a leaf of a set of curves stands for: some pieces of a segment.
struct CurveItem {
  std::uint32_t segment;
  std::uint32_t entry;        ///< of segment2key
  std::uint32_t first, last;  ///< pieces [first, last)

  /// The same for all segments of a curve: which keys lie before those of the segments before it.
  std::uint32_t curve() const { return (entry & kKeyMask) - segment; }
};
inline CurveItem curve_item(const MeshView& mesh, std::uint32_t item, std::uint32_t entry) {
  const std::uint32_t parts = mesh.segment_parts, segment = item / parts;
  const std::uint32_t part = item - segment * parts;
  return {segment, entry, mesh.pieces * part / parts, mesh.pieces * (part + 1) / parts};
}
inline CurveItem curve_item(const MeshView& mesh, std::uint32_t item) {
  return curve_item(mesh, item, mesh.segment2key[item / mesh.segment_parts]);
}

/// Where piece i begins, and piece i − 1 ends.
inline double piece_begin(const MeshView& mesh, std::uint32_t i) {
  return i == mesh.pieces ? 1.0 : double(i) / double(mesh.pieces);
}

/// The padded box of an item at a time, which decides with it and that every box of a tree is a
/// union of. Between two sets its lower sides are concave functions of time and its upper ones
/// convex: it never leaves the boxes at both ends.
inline Aabb curve_bounds(const MeshView& mesh, const CurveItem& item, const MotionPlace& time) {
  const CurveSegment segment = curve_segment(mesh, item.entry, time);
  Vec3d lo(1e300), hi(-1e300);
  for (std::uint32_t i = item.first; i <= item.last; ++i) {
    const Vec4d at = segment.point(piece_begin(mesh, i));
    const double radius = std::max(at.radius, 0.0);
    lo = glm::min(lo, at.at - radius);
    hi = glm::max(hi, at.at + radius);
  }
  if (mesh.shape == CurveShape::kThick) {
    // Between its ends a piece leaves their chord by an eighth of the second derivative at most.
    const double step = 1.0 / double(mesh.pieces);
    const Vec4d bend = 0.125 * step * step * segment.bend();
    lo -= bend.at + bend.radius;
    hi += bend.at + bend.radius;
  }
  const Aabb box{Vec3(lo), Vec3(hi)};
  return padded(box, max_abs(box) * kPadding);
}

namespace detail {

/// Whether a disk of `radius` around null misses the segment from a to b.
inline bool misses_chord(const Vec4d& a, const Vec4d& b, double radius) {
  const double ex = b.at.x - a.at.x, ey = b.at.y - a.at.y;
  const double length2 = ex * ex + ey * ey;
  const double along = -(a.at.x * ex + a.at.y * ey);
  const double r2 = radius * radius;
  if (along <= 0.0) return a.at.x * a.at.x + a.at.y * a.at.y > r2;
  if (along >= length2) return b.at.x * b.at.x + b.at.y * b.at.y > r2;
  const double across = ex * a.at.y - ey * a.at.x;
  return across * across > r2 * length2;
}

/// Whether a ray misses a whole segment that it sees: the curve lies in the hull of the control
/// points of its Bézier form.
inline bool misses_hull(const CurveSegment& s) {
  const Vec4d p = s.begin + (1.0 / 3.0) * s.begin_slope, q = s.end - (1.0 / 3.0) * s.end_slope;
  const double radius =
      std::max(std::max(s.begin.radius, s.end.radius), std::max(p.radius, q.radius));
  const double ex = s.end.at.x - s.begin.at.x, ey = s.end.at.y - s.begin.at.y;
  const double reach2 = radius * radius * (ex * ex + ey * ey);
  const auto beyond = [&](double a, double b, double c, double d) {
    const double least = std::min(std::min(a, b), std::min(c, d));
    const double most = std::max(std::max(a, b), std::max(c, d));
    const double distance = least > 0.0 ? least : most < 0.0 ? most : 0.0;
    return distance * distance > reach2;
  };
  const auto across = [&](const Vec4d& v) { return ex * v.at.y - ey * v.at.x; };
  const auto along = [&](const Vec4d& v) { return ex * v.at.x + ey * v.at.y; };
  return beyond(across(s.begin), across(p), across(q), across(s.end)) ||
         beyond(along(s.begin), along(p), along(q), along(s.end));
}

/// The side of a ribbon at one end of a piece: from its middle to v = 1.
inline Vec3d ribbon_side(const CurveSegment& s, double u, const Vec4d& at, const Vec4d& from,
                         const Vec4d& to) {
  const Vec4d slope = s.slope(u);
  double tx = slope.at.x, ty = slope.at.y;
  double length2 = tx * tx + ty * ty;
  if (!(length2 > 0.0)) {
    tx = to.at.x - from.at.x;
    ty = to.at.y - from.at.y;
    length2 = tx * tx + ty * ty;
    if (!(length2 > 0.0)) return Vec3d(0.0);
  }
  const double scale = std::max(at.radius, 0.0) / std::sqrt(length2);
  return Vec3d(-ty * scale, tx * scale, 0.0);
}

/// Where null lies in a ribbon's piece: `along` it from 0 to 1 and `v` across it; false if outside,
/// or if the piece is folded there.
inline bool meet_ribbon(const Vec3d& middle_0, const Vec3d& side_0, const Vec3d& middle_1,
                        const Vec3d& side_1, double* along, double* v) {
  const Vec3d l0 = middle_0 + side_0, r0 = middle_0 - side_0;
  const Vec3d l1 = middle_1 + side_1, r1 = middle_1 - side_1;
  const auto edge = [](const Vec3d& a, const Vec3d& b) { return a.x * b.y - a.y * b.x; };
  const double diagonal = edge(r1, l0);
  if (diagonal >= 0.0) {  // the triangle l0, r0, r1
    const double of_l0 = edge(r0, r1), of_r1 = edge(l0, r0);
    const double sum = (of_l0 + diagonal) + of_r1;
    if (!(of_l0 >= 0.0 && of_r1 >= 0.0 && sum > 0.0)) return false;
    *along = of_r1 / sum;
    *v = 2.0 * (of_l0 / sum) - 1.0;
  } else {  // the triangle l0, r1, l1
    const double of_l0 = edge(r1, l1), of_r1 = edge(l1, l0);
    const double sum = (of_l0 + of_r1) - diagonal;
    if (!(of_l0 >= 0.0 && of_r1 >= 0.0 && sum > 0.0)) return false;
    *along = 1.0 - of_l0 / sum;
    *v = 1.0 - 2.0 * (of_r1 / sum);
  }
  return true;
}

/// g of the comment above.
inline double thick_balance(const CurveSegment& s, double u) {
  const Vec4d at = s.point(u), slope = s.slope(u);
  const double inside = at.radius * at.radius - (at.at.x * at.at.x + at.at.y * at.at.y);
  const double root = inside > 0.0 ? std::sqrt(inside) : 0.0;
  return -(at.at.x * slope.at.x + at.at.y * slope.at.y) - slope.at.z * root;
}

/// Where g falls through null between two places where it is positive and not: the false position
/// with Illinois' halving (Dowell and Jarratt 1971), and a bisection wherever that is slow.
inline double thick_root(const CurveSegment& s, double u0, double g0, double u1, double g1) {
  constexpr double kEnough = 1e-10;
  int last = 0;
  for (int i = 0; i < 64 && u1 - u0 > kEnough; ++i) {
    double u = i % 4 == 3 ? 0.5 * (u0 + u1) : u0 + (u1 - u0) * (g0 / (g0 - g1));
    if (!(u > u0 && u < u1)) u = 0.5 * (u0 + u1);
    const double g = thick_balance(s, u);
    if (g > 0.0) {
      u0 = u;
      g0 = g;
      if (last > 0) g1 *= 0.5;
      last = 1;
    } else {
      if (g == 0.0) return u;
      u1 = u;
      g1 = g;
      if (last < 0) g0 *= 0.5;
      last = -1;
    }
  }
  return 0.5 * (u0 + u1);
}

/// The depth at which a thick curve's front stands at u; false if the ray misses the circle.
inline bool thick_depth(const Vec4d& at, double* depth) {
  const double inside = at.radius * at.radius - (at.at.x * at.at.x + at.at.y * at.at.y);
  if (!(inside > 0.0 && at.radius > 0.0)) return false;
  *depth = at.at.z - std::sqrt(inside);
  return true;
}

/// Where a ray that sees the straight segment `s` enters what a sphere sweeps along it. The sphere
/// of u touches the swept surface where q, a point of both, has y(q) = (q − begin)·e + r₀ r′ equal
/// to u g, with e the chord, r′ the radii's difference and g = e² − r′²; on the cone that they
/// touch that is a quadratic equation for the ray. Beyond its ends the last sphere is met. A
/// segment has the sphere at its own end, and that at its begin only where the curve begins, so
/// that a joint is met once.
///
/// @param after  the key after the segment's end; the end itself if there is none
inline bool meet_swept_sphere(const CurveSegment& s, const Vec4d& after, bool is_first, double* u,
                              double* depth) {
  const Vec4d e = s.end - s.begin;
  const Vec4d& p = s.begin;
  const double length2 = glm::dot(e.at, e.at), growth = p.radius * e.radius;
  const double g = length2 - e.radius * e.radius;
  const double along = -(p.at.x * e.at.x + p.at.y * e.at.y);
  // Depths are measured from the begin here: y(q) = y + z e_z.
  const double y = along + growth;
  const double a = g - e.at.z * e.at.z, b = -e.at.z * y;
  const double c = g * (p.at.x * p.at.x + p.at.y * p.at.y) - along * along -
                   p.radius * p.radius * length2 - 2.0 * growth * along;
  const double root2 = b * b - a * c;
  if (g > 0.0 && root2 >= 0.0) {
    const double root = std::sqrt(root2);
    const double z = b > 0.0 ? -(b + root) / a : c / (root - b);
    const double at = (y + z * e.at.z) / g;
    if (at >= 0.0 && at <= 1.0) {
      *u = at;
      return thick_depth(s.point(at), depth);
    }
  }
  if (thick_depth(s.end, depth) && y + (*depth - p.at.z) * e.at.z > g) {
    // Inside the next cone nothing is met.
    const Vec4d next = after - s.end;
    const Vec3d from = Vec3d(0.0, 0.0, *depth) - s.end.at;
    *u = 1.0;
    return !(glm::dot(from, next.at) > -s.end.radius * next.radius);
  }
  *u = 0.0;
  return is_first && thick_depth(p, depth) && y + (*depth - p.at.z) * e.at.z < 0.0;
}

}  // namespace detail

/// The nearest hit of a ray with an item: the specification. `hit` is written if there is one.
inline bool intersect_curve(const MeshView& mesh, const CurveItem& item, const RoundRay& ray,
                            CurveHit* hit) {
  const CurveSegment segment = seen_segment(mesh, item.entry, ray);
  if (detail::misses_hull(segment)) return false;
  const bool is_ribbon = mesh.shape == CurveShape::kRibbon;
  const double step = 1.0 / double(mesh.pieces);
  const Vec4d bend = 0.125 * step * step * segment.bend();
  const double slack = is_ribbon ? 0.0 : (bend.at.x + bend.at.y) + bend.radius;
  bool found = false;
  Aabb box;
  const auto keep = [&](double depth, double u, double v) {
    if (box.is_empty()) box = curve_bounds(mesh, item, ray.time);
    float t;
    if (!settle_distance(ray, box, depth, &t)) return;
    const auto at = static_cast<float>(u);
    if (found && !(t < hit->t || (t == hit->t && at < hit->u))) return;
    *hit = {t, at, static_cast<float>(v)};
    found = true;
  };
  if (mesh.shape == CurveShape::kThickLinear) {
    const bool is_last = item.entry & kLastOfCurve;
    const Vec4d next = round_key(mesh, (item.entry & kKeyMask) + (is_last ? 1 : 2), ray.time);
    double u, depth;
    if (detail::meet_swept_sphere(segment, {ray.seen(next.at), next.radius},
                                  item.entry & kFirstOfCurve, &u, &depth)) {
      keep(depth, u, 0.0);
    }
    return found;
  }
  double u0 = piece_begin(mesh, item.first);
  Vec4d p0 = segment.point(u0);
  for (std::uint32_t i = item.first; i < item.last; ++i) {
    const double u1 = piece_begin(mesh, i + 1);
    const Vec4d p1 = segment.point(u1);
    if (!detail::misses_chord(p0, p1, std::max(p0.radius, p1.radius) + slack)) {
      if (is_ribbon) {
        const Vec3d side_0 = detail::ribbon_side(segment, u0, p0, p0, p1);
        const Vec3d side_1 = detail::ribbon_side(segment, u1, p1, p0, p1);
        double along, v;
        if (detail::meet_ribbon(p0.at, side_0, p1.at, side_1, &along, &v)) {
          const double depth = p0.at.z + along * (p1.at.z - p0.at.z);
          const double radius = p0.radius + along * (p1.radius - p0.radius);
          // A ribbon does not shadow what is nearer than its own width (Embree's rule).
          if (depth > 2.0 * radius) keep(depth, u0 + along * (u1 - u0), v);
        }
      } else {
        const double g0 = detail::thick_balance(segment, u0);
        const double g1 = detail::thick_balance(segment, u1);
        if (g0 > 0.0 && !(g1 > 0.0)) {
          const double u = detail::thick_root(segment, u0, g0, u1, g1);
          double depth;
          if (detail::thick_depth(segment.point(u), &depth)) keep(depth, u, 0.0);
        }
      }
    }
    u0 = u1;
    p0 = p1;
  }
  return found;
}

}  // namespace komorebi
