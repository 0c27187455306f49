#include "render/material_values.h"

#include <algorithm>

#include "core/surface_point.h"
#include "render/pass_row.h"
#include "render/shade.h"

namespace komorebi {
namespace {

bool varies(const RenderContext& context) {
  return context.passes.values > 0 && !context.tables->value_programs.empty();
}

}  // namespace

void MaterialValues::add(const RenderContext& context, const Hit& hit, const Ray& ray, float* row) {
  // Programs of values draw no lots: they need not know which sample it is.
  const SurfacePoint point = surface_point(context.scene, hit, ray);
  const ShadeTask task = shade_task(context, hit, point, ray.direction, ray.time, 0, 0, 0);
  if (task.material == kNone || !context.tables->value_programs[task.material]) return;
  order_.push_back({task.material, static_cast<std::uint32_t>(tasks_.size())});
  tasks_.push_back(task);
  rows_.push_back(row_of_values(context.passes, row));
}

void MaterialValues::run(const RenderContext& context) {
  std::stable_sort(order_.begin(), order_.end(),
                   [](const Place& a, const Place& b) { return a.material < b.material; });
  for (std::size_t begin = 0; begin < order_.size(); begin += together_.size()) {
    const std::uint32_t material = order_[begin].material;
    together_.clear();
    for (std::size_t i = begin; i < order_.size() && order_[i].material == material; ++i) {
      if (together_.size() == Program::kLanes) break;
      together_.push_back(tasks_[order_[i].task]);
    }
    const Program& program = *context.tables->value_programs[material];
    const auto count = static_cast<std::uint32_t>(together_.size());
    float* const* values = run_.run(context, program, together_.data(), count);
    for (std::uint32_t i = 0; i < count; ++i) {
      float* to = rows_[order_[begin + i].task];
      for (std::uint32_t k = 0; k < context.passes.values; ++k) to[k] = values[k][i];
    }
  }
  tasks_.clear();
  rows_.clear();
  order_.clear();
}

void MaterialValues::put(const RenderContext& context, const RaySpan& rays, const Hit* hits,
                         FunctionRef<float*(std::uint32_t ray)> row_of) {
  if (!varies(context)) return;
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if (hits[i].valid()) add(context, hits[i], rays[i], row_of(i));
  }
  run(context);
}

void MaterialValues::put_one(const RenderContext& context, const Hit& hit, const Ray& ray,
                             float* row) {
  if (!varies(context)) return;
  add(context, hit, ray, row);
  run(context);
}

}  // namespace komorebi
