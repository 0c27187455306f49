#include "render/material_filter.h"

#include "core/path_key.h"
#include "render/shade.h"

namespace komorebi {
namespace {

/// Whether a program needs to know more of a hit than which attributes are there.
bool asks_for_point(const Program& program) {
  for (std::uint32_t i = 0; i < kPointInputs; ++i) {
    if (program.asks(static_cast<PointInput>(i))) return true;
  }
  for (const std::string& name : program.attributes()) {
    if (name.starts_with("dx:") || name.starts_with("dy:")) return true;
  }
  return false;
}

}  // namespace

void MaterialFilter::bind(const Scene& scene) {
  context_.scene = scene.view();
  context_.camera = scene.camera();
  context_.tables = &scene.tables();
  context_.origin = scene.origin();
  context_.frame_width = static_cast<float>(scene.camera_desc().width);
  context_.frame_height = static_cast<float>(scene.camera_desc().height);
}

void MaterialFilter::accepts(const void* user, const HitQuery* queries, std::uint32_t count,
                             bool* accepted) {
  const RenderContext& context = static_cast<const MaterialFilter*>(user)->context_;
  thread_local MaterialShader shader;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto& [hit, ray] = queries[i];
    const PathKind kind = path_kind(ray.path_key);
    const std::uint32_t vertex = kind == PathKind::kCamera ? 0 : 1;
    ShadeTask task =
        shade_task(context, hit, SurfacePoint{}, ray.direction, ray.time, 0, 0, vertex);
    const Material& material = context.tables->surface(task.material);
    accepted[i] = true;
    if (!material.clear) continue;
    const bool to_light = kind == PathKind::kLight;
    const Program& program = to_light ? *material.clear : *material.of_vertex(vertex).program;
    if (asks_for_point(program)) task.point = surface_point(context.scene, hit, ray);
    const float share = shader.clear_share_of(context, task, to_light);
    const std::uint32_t lot = hash_combine(hash_combine(ray.path_key, hit.instance), hit.primitive);
    accepted[i] = to_unit_float(lot) >= share;
  }
}

}  // namespace komorebi
