#pragma once

#include <memory>
#include <vector>

#include "core/vector.h"
#include "shader/program.h"

namespace komorebi {

/// A part of a surface's light, matt reflection or passing through to the other side, as outputs
/// of the surface's program.
struct SurfaceLobe {
  bool transmits = false;
  std::uint32_t weight = 0;      ///< the first of three outputs
  std::uint32_t normal = kNone;  ///< likewise; kNone: the surface's own
};

/// A surface for one kind of ray. Outputs of the program: emission (3), transparency (3: weight of
/// what goes straight through), holdout (1), then those of the lobes.
struct SurfaceProgram {
  static constexpr std::uint32_t kEmission = 0, kTransparency = 3, kHoldout = 6, kFirstLobe = 7;

  std::shared_ptr<const Program> program;
  std::vector<SurfaceLobe> lobes;

  SurfaceProgram() = default;
  /// Lobes follow each other in the outputs, each with its weight and, where `has_normal` says so,
  /// its normal. std::invalid_argument when the program has not as many outputs.
  struct LobeInput {
    bool transmits, has_normal;
  };
  SurfaceProgram(std::shared_ptr<const Program> program, const std::vector<LobeInput>& lobes);
};

/// What a material says of surfaces.
struct Material {
  SurfaceProgram camera;                 ///< to camera rays
  SurfaceProgram bounce;                 ///< to rays that bounce light; no program: the same
  std::shared_ptr<const Program> clear;  ///< transparency (3) to light rays; null: opaque

  const SurfaceProgram& of_vertex(std::uint32_t vertex) const {
    return vertex == 0 || !bounce.program ? camera : bounce;
  }
};

/// Whether a material is one matt colour all over, seen by all rays alike, and which.
bool is_plain(const Material& material, Vec3* albedo);

/// How bright a surface's emission may be, as far as can be told without running it: the value
/// itself where it is the same all over, else the largest number that stands in the program.
float bound_of_emission(const Program& surface);

/// The share of rays that a transparency lets through. Colours are not told apart: a ray is blocked
/// or it is not.
inline float clear_share(const Vec3& transparency) {
  const float share = (transparency.x + transparency.y + transparency.z) * (1.0f / 3.0f);
  return share > 0.0f ? (share < 1.0f ? share : 1.0f) : 0.0f;
}

/// What a surface does with the light of one path that has met it and was not let through.
struct Shading {
  Vec3 albedo{1.0f};     ///< of the lobe that was chosen, over the probability of choosing it
  Vec3 emission{0.0f};   ///< radiance
  Vec3 color{1.0f};      ///< of all that reflects: the pass Diffuse Color
  float holdout = 0.0f;  ///< how much of it is a hole
};

/// The lobe that was chosen.
struct ChosenLobe {
  Vec3 normal{0.0f};       ///< unit, on the ray's side
  bool transmits = false;  ///< light comes from the other side
};

}  // namespace komorebi
