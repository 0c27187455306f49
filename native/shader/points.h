#pragma once

#include <cstdint>
#include <string_view>

namespace komorebi {

/// What a program can ask of the points that it runs over. World space is Blender's, whatever
/// origin the scene has; a world's points are directions, as Cycles has them.
enum class PointInput : std::uint32_t {
  kPosition,      ///< of a world: the direction looked in
  kNormal,        ///< of the shading, on the side that the ray comes from
  kTrueNormal,    ///< of the triangle, likewise
  kIncoming,      ///< towards where the ray comes from, unit
  kObjectPoint,   ///< the position in the object's own space
  kObjectNormal,  ///< the normal in the object's own space
  kCamera,        ///< the position as the camera has it: right, up, depth
  kWindow,        ///< the place in the picture, from 0 to 1, and 0
  kParametric,    ///< barycentric coordinates as Cycles' Geometry node has them, and 0
  kTangent,       ///< about the object's vertical
  kObjectLocation,
  kObjectColor,
  kObjectAlpha,
  kBackfacing,  ///< 1 where the ray meets the back
  kObjectIndex,
  kMaterialIndex,
  kObjectRandom,  ///< a number from 0 to 1 that each instance has
  kRayLength,
  kDx,  ///< how far the position moves from this pixel to the one on its right, in the surface
  kDy,
  kConeX,    ///< how far the ray's cone reaches in the surface, across the ray
  kConeY,    ///< and the way that it grazes the surface
  kObjectX,  ///< the object's axes in the world: the columns of its matrix
  kObjectY,
  kObjectZ,
  kCount
};
inline constexpr std::size_t kPointInputs = static_cast<std::size_t>(PointInput::kCount);

struct PointInputInfo {
  std::string_view name;
  std::uint32_t width;  ///< floats
};
inline constexpr PointInputInfo kPointInputInfo[kPointInputs] = {
    {"position", 3},
    {"normal", 3},
    {"true_normal", 3},
    {"incoming", 3},
    {"object_point", 3},
    {"object_normal", 3},
    {"camera", 3},
    {"window", 3},
    {"parametric", 3},
    {"tangent", 3},
    {"object_location", 3},
    {"object_color", 3},
    {"object_alpha", 1},
    {"backfacing", 1},
    {"object_index", 1},
    {"material_index", 1},
    {"object_random", 1},
    {"ray_length", 1},
    {"dx", 3},
    {"dy", 3},
    {"cone_x", 3},
    {"cone_y", 3},
    {"object_x", 3},
    {"object_y", 3},
    {"object_z", 3},
};

/// Attributes of which the name begins so are how much the rest of it changes by a step in the
/// surface: to the next pixel, or to the end of a ray's cone.
inline constexpr std::string_view kStepNames[] = {"dx:", "dy:", "cone_x:", "cone_y:"};

inline bool asks_for_step(std::string_view attribute) {
  for (const std::string_view step : kStepNames) {
    if (attribute.starts_with(step)) return true;
  }
  return false;
}

/// Points as columns of floats, a lane a point. Only what the program asks for has to be there
/// (Program::inputs, Program::attributes).
struct ShadePoints {
  std::uint32_t count = 0;
  const float* input[kPointInputs][3] = {};
  /// [attributes of the program][4]: what named attributes are at the points; r, g, b, alpha.
  const float* const (*attribute)[4] = nullptr;
};

}  // namespace komorebi
