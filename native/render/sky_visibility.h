#pragma once

#include <array>
#include <atomic>
#include <memory>

#include "parallel/cancel.h"
#include "parallel/thread_pool.h"
#include "render/context.h"

namespace komorebi {

/// Which parts of the sky the surfaces in view see, measured with few rays before a render, for
/// directions to be chosen by: a room's light comes through its windows, wherever the map is
/// bright. The directions are those of the map's own space, on an octahedral grid; surfaces count
/// by the side of a cube that they face. It is a function of the scene and the camera alone, and
/// only where samples go depends on it, never what they are worth. Weights by the root of the
/// second moment: Rath et al. 2020, "Variance-Aware Path Guiding", §3.
class SkyVisibility {
 public:
  static constexpr std::uint32_t kSides = 6, kGrid = 32;

  SkyVisibility();

  /// The side, 0…5, that a normal in the map's space faces.
  static std::uint32_t side(const Vec3& normal);

  /// One ray from a surface of this normal, both in the map's space. From any thread.
  void count(const Vec3& normal, const Vec3& direction, bool seen);

  /// The share of rays from surfaces facing this side to about this direction that arrive, in
  /// (0, 1): measured, and where little is known, as for all sides together.
  float share(std::uint32_t side, const Vec3& direction) const;

  /// The variance of ambient occlusion from directions of density cosine · √share over that from
  /// the cosine alone, for independent samples: 1 where nothing is known of a direction.
  float variance_left() const;

 private:
  float share_of_cell(std::uint32_t side, std::uint32_t cell) const;

  struct Count {
    std::atomic<std::uint32_t> cast{0}, seen{0};
  };
  std::unique_ptr<Count[]> counts_;  // [kSides][kGrid²]
};

/// Casts rays from some 9,000 points that the camera sees, evenly over the full frame. False when
/// cancelled.
bool measure_sky_visibility(const RenderContext& context, ThreadPool& pool, const Cancel& cancel,
                            SkyVisibility& visibility);

}  // namespace komorebi
