#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/vector.h"
#include "render/material.h"

namespace komorebi {

/// What passes tell about an object. The ids of Cryptomattes are the bits of floats.
struct ObjectInfo {
  float pass_index = 0.0f;
  std::uint32_t matte = 0, matte_asset = 0;
  float terminator_cutoff = 0.0f;     ///< Blender's shadow_terminator_geometry_offset
  float terminator_frequency = 1.0f;  ///< 1 / (1 − shadow_terminator_offset / 2)
  Vec3 color{1.0f};                   ///< of Blender's viewport display, for Object Info nodes
  float alpha = 1.0f;
};

struct MaterialInfo {
  float pass_index = 0.0f;
  std::uint32_t matte = 0;
};

/// What indices of a scene stand for. All may be empty: then nothing is known.
struct SceneTables {
  /// What varies may be anything, distances too: a film's numbers end beyond 32 times this, and
  /// still have steps of 1e-5 or less.
  static constexpr float kMostVarying = 32768.0f;

  std::vector<ObjectInfo> objects;      ///< of InstanceInput::object_index
  std::vector<MaterialInfo> materials;  ///< of the entries of `slots`
  /// List l of material slots is slots[slot_begin[l]] to slots[slot_begin[l + 1] − 1]; a face with
  /// a slot beyond the last has the last.
  std::vector<std::uint32_t> slot_begin, slots;
  /// Numbers that hold all over a material, [materials][value_count]: what shader AOVs say.
  std::uint32_t value_count = 0;
  std::vector<float> values;
  /// Of each material what varies over it, `value_count` outputs; null where `values` has it all.
  /// Empty if there are none.
  std::vector<std::shared_ptr<const Program>> value_programs;
  std::shared_ptr<const Program> world_values;  ///< likewise what the world says; null: 0

  std::vector<Material> surfaces;  ///< of `materials`; empty: all are clay
  /// Of each instance a number from 0 to 1; empty if no surface asks for it.
  std::vector<float> instance_random;

  const Material& surface(std::uint32_t material) const {
    static const Material kPlain;
    return material < surfaces.size() ? surfaces[material] : kPlain;
  }

  /// Whether rays from any object may be lifted, or its cosines cut.
  bool lifts_rays() const {
    return std::any_of(objects.begin(), objects.end(),
                       [](const ObjectInfo& o) { return o.terminator_cutoff > 0.0f; });
  }
  bool cuts_cosines() const {
    return std::any_of(objects.begin(), objects.end(),
                       [](const ObjectInfo& o) { return o.terminator_frequency > 1.0f; });
  }

  ObjectInfo object(std::uint32_t index) const {
    return index < objects.size() ? objects[index] : ObjectInfo{};
  }
  /// Which of `materials` a face with this slot has, or kNone.
  std::uint32_t material_index(std::uint32_t list, std::uint32_t slot) const {
    if (std::size_t{list} + 1 >= slot_begin.size()) return kNone;
    const std::uint32_t begin = slot_begin[list], count = slot_begin[list + 1] - begin;
    if (count == 0) return kNone;
    return slots[begin + (slot < count ? slot : count - 1)];
  }
  MaterialInfo material(std::uint32_t index) const {
    return index < materials.size() ? materials[index] : MaterialInfo{};
  }
  /// The largest of all values, as far as can be told without running programs.
  float max_value() const {
    const bool varies = world_values || !value_programs.empty();
    float most = varies ? kMostVarying : 0.0f;
    for (const float value : values) most = std::max(most, value < 0.0f ? -value : value);
    return most;
  }
};

}  // namespace komorebi
