#include "render/shade.h"

#include <algorithm>

#include "render/light.h"

namespace komorebi {

ShadeTask shade_task(const RenderContext& context, const Hit& hit, const SurfacePoint& point,
                     const Vec3& direction, float time, std::uint32_t pixel_seed,
                     std::uint32_t sample, std::uint32_t vertex) {
  const InstanceView& instance = context.scene.instances[hit.instance];
  const MeshView& mesh = context.scene.meshes[instance.mesh];
  ShadeTask task;
  task.hit = hit;
  task.point = point;
  task.direction = direction;
  task.time = time;
  task.material = context.tables->material_index(
      instance.material_slots, mesh.tri2material ? mesh.tri2material[hit.primitive] : 0);
  task.pixel_seed = pixel_seed;
  task.sample = sample;
  task.vertex = vertex;
  return task;
}

Shading shade_surface(const RenderContext& context, MaterialShader& shader, const Hit& hit,
                      const Ray& ray, std::uint32_t pixel_seed, std::uint32_t sample,
                      std::uint32_t vertex, SurfacePoint& point) {
  if (!context.has_materials) return clay_shading(context, vertex);
  ShadeTask task =
      shade_task(context, hit, point, ray.direction, ray.time, pixel_seed, sample, vertex);
  Shading shading;
  shader.shade(context, {&task, 1}, &shading);
  point = task.point;
  return shading;
}

void BatchShader::shade(const RenderContext& context, std::uint32_t vertex, const Hit* hits,
                        const RaySpan& rays, std::uint32_t light_samples, SurfaceBatch& surfaces) {
  surfaces.make_room_for_shading();
  const std::uint32_t count = surfaces.size();
  if (!context.has_materials) {
    const Shading shading = clay_shading(context, vertex);
    for (std::uint32_t s = 0; s < count; ++s) surfaces.set_shading(s, shading);
    return;
  }
  tasks_.resize(count);
  shadings_.resize(count);
  order_.resize(count);
  const auto task_of = [&](std::uint32_t s) {
    const std::uint32_t path = surfaces.path(s);
    const Vec3 direction(rays.direction_x[path], rays.direction_y[path], rays.direction_z[path]);
    return shade_task(context, hits[path], surfaces.point(s), direction, rays.time[path],
                      surfaces.pixel_seed(s), surfaces.first_index(s) / light_samples, vertex);
  };
  for (std::uint32_t s = 0; s < count; ++s) {
    order_[s] = std::uint64_t{task_of(s).material} << 32 | s;
  }
  std::sort(order_.begin(), order_.end());
  for (std::uint32_t k = 0; k < count; ++k) {
    tasks_[k] = task_of(static_cast<std::uint32_t>(order_[k]));
  }
  shader_.shade(context, tasks_, shadings_.data());
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto s = static_cast<std::uint32_t>(order_[k]);
    const ShadeTask& task = tasks_[k];
    surfaces.set_shading(s, shadings_[k]);
    const bool turned = task.point.geometric_normal != surfaces.geometric_normal(s);
    if (!turned && task.point.normal == surfaces.normal(s)) continue;
    surfaces.set_point(context, s, task.point,
                       terminator(context, task.hit, task.time, task.point.geometric_normal));
  }
}

}  // namespace komorebi
