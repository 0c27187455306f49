#pragma once

#include <string>
#include <vector>

#include "core/lamp_choice.h"

namespace komorebi {

/// A lamp as it is added to a scene. Its own space is Blender's: a lamp shines along −z, an area
/// spreads along x and y.
struct LampInput {
  std::string name;  ///< for messages
  LampKind kind = LampKind::kPoint;
  Vec3d radiance{0.0};  ///< linear Rec.709, or what LampKind says; may be negative
  Mat4d world_from_lamp{1.0};
  double radius = 0.0;                ///< metres, of sphere and disk; the matrix does not scale it
  double angle = 0.0;                 ///< radians, across a sun
  double size_u = 0.0, size_v = 0.0;  ///< metres along x and y of an area's own space
  double spread = kPi;                ///< radians across, of an area; 0: parallel rays
  double spot_angle = 0.0;            ///< radians across; 0: no spot
  double spot_blend = 0.0;            ///< 0 to 1
  double falloff_power = 0.0, falloff_smooth = 0.0;  ///< Falloff
  double max_bounces = kMostBounces;
  bool spot_scales_by_cosine = false;
  std::uint32_t flags = 0;  ///< LampFlag
};

/// Calls visit(name, number) for what a kind of lamp has of a size; the names are those of dumps
/// and of Python.
template <class Lamp, class Visit>
void for_each_lamp_number(Lamp& lamp, const Visit& visit) {
  visit("radius", lamp.radius);
  visit("angle", lamp.angle);
  visit("size_u", lamp.size_u);
  visit("size_v", lamp.size_v);
  visit("spread", lamp.spread);
  visit("spot_angle", lamp.spot_angle);
  visit("spot_blend", lamp.spot_blend);
  visit("falloff_power", lamp.falloff_power);
  visit("falloff_smooth", lamp.falloff_smooth);
  visit("max_bounces", lamp.max_bounces);
}

/// Throws std::invalid_argument with a sentence that names the lamp if a number is not finite or
/// out of its range.
void check_lamp(const LampInput& lamp);

LampKind lamp_kind_from_name(const std::string& name);

/// The lamps of a committed scene, with the tree by which one of many is chosen.
class LampTable {
 public:
  LampTable() = default;
  LampTable(const std::vector<LampInput>& inputs, const Vec3d& origin);

  LampsView view() const;
  /// About the most that one camera sample brings by lamps to a white surface, where they are no
  /// nearer than `distance`, in a scene of this length: what the film's units are chosen by.
  float max_radiance(float distance, float length) const;
  std::size_t byte_count() const;

 private:
  void grow(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

  std::vector<Lamp> lamps_;
  std::vector<LampNode> nodes_;
  std::uint32_t single_count_ = 0;
};

}  // namespace komorebi
