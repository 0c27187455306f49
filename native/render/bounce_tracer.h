#pragma once

#include <vector>

#include "parallel/cancel.h"
#include "parallel/function_ref.h"
#include "render/added_light.h"
#include "render/lamp_caster.h"
#include "render/light_caster.h"
#include "render/ray_batch.h"
#include "render/scatter.h"
#include "render/scatter_batch.h"
#include "render/shade.h"

namespace komorebi {

/// Follows the paths of a batch from the surfaces that the camera sees to those that light them,
/// all of them together, vertex by vertex. Its arrays grow once.
class BounceTracer {
 public:
  explicit BounceTracer(const RenderContext& context);

  /// Forgets what was begun; `surfaces` are those in view.
  void clear(const SurfaceBatch& surfaces) { leaving_.clear(surfaces.size()); }
  /// Lets a path go on from a surface in view, shaded; `path` is the caller's word for it.
  void begin(const SurfaceBatch& surfaces, std::uint32_t surface, std::uint32_t path,
             std::uint32_t sample) {
    leaving_.set(surface, path, sample, surfaces.albedo(surface));
  }
  using Visit = FunctionRef<void(std::uint32_t path, const Vec3& light)>;
  /// Follows all that was begun from `in_view`; visit(path, light) is told what each vertex brings
  /// to the pixel, a path's in their order. False when cancelled on the way.
  bool trace(const SurfaceBatch& in_view, const Cancel& cancel, Visit visit);

  std::uint64_t ray_count() const {
    return ray_count_ + caster_.ray_count() + lamp_caster_.ray_count() + added_light_.ray_count();
  }

 private:
  /// Of lamps, and what Fast GI adds.
  bool find_more_light(const RenderContext& context, std::uint32_t vertex, const Cancel& cancel);
  float light_share(std::uint32_t surface, const Vec3& direction) const;
  void add_sky(const Visit& visit) const;
  bool find_surfaces(std::uint32_t vertex, const Cancel& cancel);

  RenderContext context_;
  LightCaster caster_;
  LampCaster lamp_caster_;
  AddedLight added_light_;
  ScatterBatch leaving_;
  RayBatch rays_;
  std::vector<PathState> states_;  // of each ray
  std::vector<Hit> hits_;
  SurfaceBatch surfaces_;
  BatchShader shader_;
  std::vector<Vec3> light_;       // of the light rays of each surface
  std::vector<Vec3> more_light_;  // beside these, as a mean
  std::uint64_t ray_count_ = 0;
};

}  // namespace komorebi
