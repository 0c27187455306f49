#pragma once

#include "core/ray_bundles.h"
#include "parallel/function_ref.h"
#include "render/material_run.h"

namespace komorebi {

/// Writes what materials say for shader AOVs where it varies over them (SceneTables). One a thread;
/// what it says of a hit depends on that hit alone.
class MaterialValues {
 public:
  /// Of all hits, into their rays' rows of passes.
  void put(const RenderContext& context, const RaySpan& rays, const Hit* hits,
           FunctionRef<float*(std::uint32_t ray)> row_of);
  /// Of one.
  void put_one(const RenderContext& context, const Hit& hit, const Ray& ray, float* row);

 private:
  void add(const RenderContext& context, const Hit& hit, const Ray& ray, float* row);
  void run(const RenderContext& context);

  struct Place {
    std::uint32_t material, task;
  };

  MaterialRun run_;
  std::vector<ShadeTask> tasks_;
  std::vector<float*> rows_;  // of each task
  std::vector<Place> order_;
  std::vector<ShadeTask> together_;  // of one material
};

}  // namespace komorebi
