#pragma once

#include <algorithm>
#include <vector>

#include "parallel/cancel.h"
#include "render/light_caster.h"

namespace komorebi {

/// The white ambient light that Fast GI adds to the surfaces of a batch. Its arrays grow once.
class AddedLight {
 public:
  /// @param context  of the light rays of `vertex`
  AddedLight(const RenderContext& context, std::uint32_t vertex)
      : caster_(added_light_context(context, vertex)) {}

  std::uint64_t ray_count() const { return caster_.ray_count(); }

  /// Adds to light[surface] what its rays bring. False when cancelled on the way.
  /// @param context  of the light rays of `vertex`, as many as there were
  bool add(const RenderContext& context, std::uint32_t vertex, const SurfaceBatch& surfaces,
           const Cancel& cancel, Vec3* light) {
    caster_.set_context(added_light_context(context, vertex));
    seen_.assign(surfaces.size(), 0.0f);
    const std::uint32_t size = caster_.block_size();
    for (std::uint32_t begin = 0; begin < surfaces.size(); begin += size) {
      if (cancel.raised()) return false;
      caster_.cast(surfaces, begin, std::min(surfaces.size(), begin + size),
                   [&](std::uint32_t s, const Vec3&, const Vec3& contribution, bool visible) {
                     if (visible) seen_[s] += contribution.x;
                   });
    }
    for (std::uint32_t s = 0; s < surfaces.size(); ++s) light[s] += added_light(context, seen_[s]);
    return true;
  }

 private:
  LightCaster caster_;
  std::vector<float> seen_;  // of each surface: the sum over its rays
};

}  // namespace komorebi
