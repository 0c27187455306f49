#pragma once

#include <cmath>

#include "core/warp.h"
#include "render/material_points.h"

namespace komorebi {

/// How wide the cone of a ray is that comes from a matt surface, of its length: pictures are
/// averaged that far (Akenine-Möller et al., "Improved Shader and Texture Level of Detail Using Ray
/// Cones", JCGT 2021). What a matt surface sees lies that close after six thousand samples; at a
/// few metres it is a hand's width, and of a picture of 4096² a level that stays in caches.
///
/// Camera rays have no cone: their samples are averaged over the pixel anyway, and Cycles reads
/// what they see at the finest level. By cones of a pixel over the root of the sample's number the
/// noise of a ground of fine weave went down by 14 % with 16 samples, and all of that was lost to
/// blur (blend_scenes/horizon.blend).
inline constexpr float kScatterSpread = 1.0f / 32.0f;

/// Grazing rays cover a surface this many times as far as they are wide, and no farther.
inline constexpr float kMostStretch = 1e3f;

/// What a ray's cone covers of the surface that it meets: half axes, of which the first is as long
/// as the cone is wide and lies across the ray.
struct ConeSteps {
  Vec3 across, along;
};
inline ConeSteps cone_steps(const ShadeTask& task) {
  const float width = kScatterSpread * task.hit.t;
  const Vec3 normal = task.point.geometric_normal;
  const Vec3 side = glm::cross(normal, task.direction);
  const float square = glm::dot(side, side);
  const Vec3 across = square > 1e-8f ? side / std::sqrt(square) : make_frame(normal).tangent;
  const float cosine = std::abs(glm::dot(normal, task.direction));
  const float stretch = cosine > 1.0f / kMostStretch ? 1.0f / cosine : kMostStretch;
  return {width * across, (width * stretch) * glm::cross(across, normal)};
}

}  // namespace komorebi
