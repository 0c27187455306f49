#pragma once

#include "core/surface_point.h"
#include "render/context.h"
#include "shader/program.h"

namespace komorebi {

/// A hit that a material's program is to be run at.
struct ShadeTask {
  Hit hit;
  SurfacePoint point;
  Vec3 direction{0.0f};  ///< of the ray, unit
  float time = 0.0f;
  std::uint32_t material = kNone;
  std::uint32_t pixel_seed = 0;  ///< Sampler::pixel_seed
  std::uint32_t sample = 0;      ///< of the camera
  std::uint32_t vertex = 0;      ///< of the path; 0: what the camera sees
};

/// What a program asks of up to Program::kLanes points, as columns.
class MaterialPoints {
 public:
  /// Valid until the next call; the program's attributes are looked up in the hits' meshes.
  const ShadePoints& fill(const RenderContext& context, const Program& program,
                          const ShadeTask* tasks, std::uint32_t count);

 private:
  void fill_attributes(const RenderContext& context, const Program& program, const ShadeTask* tasks,
                       std::uint32_t count);
  /// Of all tasks: how far their points move from pixel to pixel, or across the ray's cone.
  enum Way : std::size_t { kPixelX, kPixelY, kConeX, kConeY, kWays };
  const Vec3* steps(const RenderContext& context, const ShadeTask* tasks, std::uint32_t count,
                    Way way);
  /// The same in barycentric coordinates.
  const Vec2* barycentric_steps(const RenderContext& context, const ShadeTask* tasks,
                                std::uint32_t count, Way way);

  using Column = float[Program::kLanes];

  ShadePoints points_;
  Column inputs_[kPointInputs][3];
  Vec3 steps_[kWays][Program::kLanes];
  Vec2 barycentric_steps_[kWays][Program::kLanes];
  bool has_steps_[kWays / 2], has_barycentric_steps_[kWays / 2];  // of these tasks, by pairs
  std::vector<float> attributes_;                                 // [attributes][4][kLanes]
  std::vector<const float*> attribute_columns_;                   // [attributes][4]
};

}  // namespace komorebi
