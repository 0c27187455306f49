#pragma once

#include "core/lamp_choice.h"
#include "core/lamp_sample.h"
#include "core/path_key.h"
#include "render/light.h"

namespace komorebi {

/// What lamps light: a surface where its light rays leave it.
struct LampPoint {
  Vec3 origin{0.0f};  ///< leaving_origin()
  Vec3 normal{0.0f};
  Vec3 geometric_normal{0.0f};  ///< on the side that light comes from
  Terminator end;               ///< null where the context has none
};

/// A ray to a lamp with what it brings if nothing is in the way.
struct LampRay {
  Vec3 direction{0.0f};  ///< to the lamp; of unit length unless the ray is lifted
  float t_max = 0.0f;
  Vec3 contribution{0.0f};  ///< of one of lamp_rays(): null if no ray needs to be cast
  std::uint32_t flags = 0;  ///< LampFlag
  float lift = 0.0f;        ///< which part of its point's lift the ray starts at
  bool below = false;       ///< a lifted one that goes below its own triangle
};

/// Rays to lamps that each camera sample casts from a surface: half as many as to the sky, or as
/// many in its place where it is black; after a bounce kLaterLampSamples.
std::uint32_t lamp_rays(const RenderContext& context);

/// Draws lamp ray j of a surface point of camera sample `sample`, at path vertex `vertex`.
LampRay draw_lamp_ray(const RenderContext& context, const LampPoint& point, const Sampler& sampler,
                      std::uint32_t vertex, std::uint32_t sample, std::uint32_t j);

/// Flags of the lamps that bring nothing to rays of this mask.
inline std::uint32_t lamps_left_out(std::uint32_t mask) {
  return (mask & kMaskRays) != 0 ? 0 : std::uint32_t{kLampSkipsCatcher};
}

/// The path_key (core/path_key.h) of a lamp ray.
inline std::uint32_t lamp_path_key(const RenderContext& context, const Sampler& sampler,
                                   std::uint32_t vertex, std::uint32_t sample, std::uint32_t j) {
  return path_key(sampler.pixel_seed, vertex_dimension(vertex, kVertexLamp),
                  sample * lamp_rays(context) + j);
}

}  // namespace komorebi
