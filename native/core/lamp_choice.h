#pragma once

#include "core/lamp.h"

namespace komorebi {

/// A node of the tree over lamps that are at a place: what it holds, as one ball of light.
struct LampNode {
  Vec3 centre{0.0f};
  float radius = 0.0f;            ///< of a ball around all of its lamps
  float power = 0.0f;             ///< the most that goes to any side, in sum: radiant intensity
  std::uint32_t max_bounces = 0;  ///< most of its lamps'
  std::uint32_t first = 0;        ///< lamp, or the first of two children, next to each other
  std::uint32_t is_leaf = 0;
};

/// All lamps of a scene, as plain arrays: first those that are asked one by one (few, or without a
/// place), then those in the tree.
struct LampsView {
  const Lamp* lamps = nullptr;
  const LampNode* nodes = nullptr;  ///< the root first; null without a tree
  std::uint32_t count = 0;
  std::uint32_t single_count = 0;
};

struct LampChoice {
  std::uint32_t lamp = kNone;  ///< kNone: no lamp has light for this point
  float probability = 0.0f;
  float u = 0.0f;  ///< what is left of the random number, even in [0, 1)
};

namespace detail {

/// At least the greatest cosine to the normal of directions within an angle of `direction`; 0
/// where all are below the surface.
inline float greatest_cosine(const Vec3& normal, const Vec3& direction, float sine) {
  const float c = glm::dot(normal, direction);
  const float cosine = std::sqrt(max_of((1.0f - sine) * (1.0f + sine), 0.0f));
  if (c >= cosine) return 1.0f;
  const float across = std::sqrt(max_of((1.0f - c) * (1.0f + c), 0.0f));
  const float most = c * cosine + across * sine;
  constexpr float kRounding = 1e-4f;
  return most > -kRounding ? max_of(most, kRounding) : 0.0f;
}

/// About how much light of a ball of light arrives; 0 only where none can.
inline float ball_importance(const Vec3& centre, float radius, float power, const Vec3& p,
                             const Vec3& normal) {
  const Vec3 to = centre - p;
  const float d2 = glm::dot(to, to), r2 = radius * radius;
  if (!(d2 > r2)) return r2 > 0.0f ? power / r2 : 0.0f;
  const float d = std::sqrt(d2);
  return power / d2 * greatest_cosine(normal, to / d, radius / d);
}

/// The largest share of a spot's light that goes from anywhere on the lamp to where `from` points,
/// from its middle.
inline float greatest_spot_share(const Lamp& lamp, const Vec3& from) {
  const Vec3 local = lamp.spot.local_from_world * from;
  const float length = std::sqrt(glm::dot(local, local));
  const float off = lamp.radius * lamp.spot.stretch;
  if (!(length > off)) return 1.0f;
  const float sine = off / length, c = local.z / length;
  const float cosine = std::sqrt((1.0f - sine) * (1.0f + sine));
  if (c >= cosine) return 1.0f;
  const float across = std::sqrt(max_of((1.0f - c) * (1.0f + c), 0.0f));
  const float rounding = lamp.radius > 0.0f ? 1e-5f : 0.0f;
  return spot_share_at(lamp.spot, c * cosine + across * sine + rounding);
}

}  // namespace detail

/// The radius of a ball around a lamp that is at a place.
inline float reach_of(const Lamp& lamp) {
  return is_area(lamp.kind) ? std::sqrt(lamp.half_u * lamp.half_u + lamp.half_v * lamp.half_v)
                            : lamp.radius;
}

/// The most that goes to any side: of a sun irradiance, else radiant intensity.
inline float power_of(const Lamp& lamp) {
  const float radiance = max_abs(lamp.radiance);
  switch (lamp.kind) {
    case LampKind::kSun:  // across its axis
      return radiance * kPiFloat * lamp.one_minus_cos * (2.0f - lamp.one_minus_cos);
    case LampKind::kTangentSun:
    case LampKind::kSphere:
    case LampKind::kDisk:
      return radiance * kPiFloat * lamp.radius * lamp.radius;
    case LampKind::kRectangle:
    case LampKind::kEllipse:
      if (lamp.spread_tangent < 0.0f) return radiance * area_of(lamp);
      return radiance * area_of(lamp) * spread_share(lamp, 1.0f);
    default:
      return radiance;
  }
}

/// About how much of a lamp's light arrives if nothing is in its way; 0 only where none can.
inline float lamp_importance(const Lamp& lamp, const Vec3& p, const Vec3& normal) {
  using detail::greatest_cosine;
  if (is_distant(lamp.kind)) {
    float sine = 0.0f;
    if (lamp.kind == LampKind::kSun) {
      const float h = lamp.one_minus_cos;
      sine = h < 1.0f ? std::sqrt(h * (2.0f - h)) : 1.0f;
    } else if (lamp.kind == LampKind::kTangentSun) {
      sine = lamp.radius / std::sqrt(1.0f + lamp.radius * lamp.radius);
    }
    return power_of(lamp) * greatest_cosine(normal, lamp.direction, sine);
  }
  const float radius = reach_of(lamp);
  float importance = detail::ball_importance(lamp.position, radius, power_of(lamp), p, normal);
  const Vec3 from = p - lamp.position;
  if (lamp.falloff.exists()) {
    importance *= lamp.falloff.at(max_of(std::sqrt(glm::dot(from, from)), radius));
  }
  if (is_area(lamp.kind)) {
    if (!(glm::dot(from, lamp.direction) > 0.0f)) return 0.0f;
  } else if (lamp.spot.cosine >= -1.0f) {
    if (glm::dot(from, from) > radius * radius)
      importance *= detail::greatest_spot_share(lamp, from);
  }
  return importance;
}

namespace detail {

inline float node_importance(const LampsView& lamps, const LampNode& node, const Vec3& p,
                             const Vec3& normal) {
  return node.is_leaf ? lamp_importance(lamps.lamps[node.first], p, normal)
                      : ball_importance(node.centre, node.radius, node.power, p, normal);
}

}  // namespace detail

/// Chooses the lamp that a ray from p goes to in proportion to about what it brings: one of the
/// single ones, or one that is found by going down the tree (Conty Estévez and Kulla 2018), with
/// the random number stretched to its full range at each step.
/// @param vertex  of a path, that p is: lamps of fewer bounces are not there
/// @param u       in [0, 1)
inline LampChoice choose_lamp(const LampsView& lamps, const Vec3& p, const Vec3& normal,
                              std::uint32_t vertex, double u) {
  const auto single = [&](std::uint32_t i) {
    const Lamp& lamp = lamps.lamps[i];
    return lamp.max_bounces < vertex ? 0.0 : static_cast<double>(lamp_importance(lamp, p, normal));
  };
  const auto of_node = [&](const LampNode& node) {
    return node.max_bounces < vertex
               ? 0.0
               : static_cast<double>(detail::node_importance(lamps, node, p, normal));
  };
  const double in_tree = lamps.nodes != nullptr ? of_node(lamps.nodes[0]) : 0.0;
  double total = in_tree;
  for (std::uint32_t i = 0; i < lamps.single_count; ++i) total += single(i);
  LampChoice choice;
  if (!(total > 0.0)) return choice;
  constexpr double kBelowOne = 1.0 - 1e-12;
  u *= total;
  double weight = in_tree;
  if (u >= in_tree) {
    u -= in_tree;
    for (std::uint32_t i = 0; i < lamps.single_count; ++i) {
      const double own = single(i);
      if (!(own > 0.0)) continue;
      choice.lamp = i;  // the last one, should rounding have led past it
      weight = own;
      if (u < own) break;
      u -= own;
    }
  }
  double probability = weight / total;
  u /= weight;
  if (choice.lamp == kNone) {
    const LampNode* node = lamps.nodes;
    while (!node->is_leaf) {
      const LampNode* children = lamps.nodes + node->first;
      const double a = of_node(children[0]), b = of_node(children[1]);
      if (!(a + b > 0.0)) return choice;
      const double share = a / (a + b);
      const bool first = u < share;
      node = children + (first ? 0 : 1);
      u = first ? u / share : (u - share) / (1.0 - share);
      probability *= first ? share : 1.0 - share;
      u = u < kBelowOne ? u : kBelowOne;
    }
    choice.lamp = node->first;
  }
  choice.probability = static_cast<float>(probability);
  choice.u = min_of(static_cast<float>(u), kOneMinusEpsilon);
  return choice;
}

}  // namespace komorebi
