#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace komorebi {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Vec3d = glm::dvec3;
using Mat3 = glm::mat3;  // column-major, as GLM stores it
using Mat3d = glm::dmat3;
using Mat4d = glm::dmat4;

/// "No such index": an instance, primitive or mesh that is not there.
inline constexpr std::uint32_t kNone = 0xffffffffu;

/// The larger of the three absolute coordinates; the scale that rounding errors are relative to.
inline float max_abs(const Vec3& v) {
  const float x = v.x < 0.0f ? -v.x : v.x;
  const float y = v.y < 0.0f ? -v.y : v.y;
  const float z = v.z < 0.0f ? -v.z : v.z;
  const float xy = x < y ? y : x;
  return xy < z ? z : xy;
}

}  // namespace komorebi
