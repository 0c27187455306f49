#pragma once

#include "render/context.h"
#include "render/scene_tables.h"

namespace komorebi {

/// Decides by materials' transparency which hits count (core/hit_filter.h): a ray is blocked with
/// the probability that its surface is solid there, by a lot that is drawn for the ray and the
/// primitive. Rays that look for light ask the program that a material has for these.
class MaterialFilter {
 public:
  MaterialFilter() = default;
  MaterialFilter(const MaterialFilter&) = delete;
  MaterialFilter& operator=(const MaterialFilter&) = delete;

  /// Before the first query: the scene, which outlives this.
  void bind(const Scene& scene);

  HitFilter hit_filter() const { return {this, &MaterialFilter::accepts}; }

 private:
  static void accepts(const void* user, const HitQuery* queries, std::uint32_t count,
                      bool* accepted);

  RenderContext context_;
};

}  // namespace komorebi
