#pragma once

#include "render/clear_programs.h"
#include "render/context.h"
#include "render/opacity_map.h"
#include "render/scene_tables.h"

namespace komorebi {

/// Decides by materials' transparency which hits count (core/hit_filter.h): a ray is blocked with
/// the probability that its surface is solid there, by a lot that is drawn for the ray and the
/// primitive. Rays that look for light ask the program that a material has for these. Where the
/// scene's OpacityMap knows the answer no program is run.
class MaterialFilter {
 public:
  MaterialFilter() = default;
  MaterialFilter(const MaterialFilter&) = delete;
  MaterialFilter& operator=(const MaterialFilter&) = delete;

  /// Before the first query: the scene, which outlives this.
  /// @param has_map  false: programs alone decide, with the same answers
  /// Throws Cancelled.
  void bind(const Scene& scene, ThreadPool& pool, const Cancel& cancel, bool has_map = true);

  HitFilter hit_filter() const { return {this, &MaterialFilter::accepts}; }
  const OpacityMap* opacity_map() const { return map_.get(); }
  std::size_t byte_count() const { return map_ ? map_->byte_count() : 0; }

 private:
  static void accepts(const void* user, const HitQuery* queries, std::uint32_t count,
                      bool* accepted);

  RenderContext context_;
  std::vector<ClearPrograms> clear_;  // of the scene's materials
  std::unique_ptr<const OpacityMap> map_;
};

}  // namespace komorebi
