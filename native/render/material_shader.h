#pragma once

#include <span>

#include "render/material.h"
#include "render/material_run.h"

namespace komorebi {

/// Runs materials at hits; one a thread. What it says of a hit depends on that hit alone.
class MaterialShader {
 public:
  /// The shading of hits that were not let through, each for its own path; their points become
  /// those of the lobes that were chosen. Hits of one material that follow each other run together.
  void shade(const RenderContext& context, std::span<ShadeTask> tasks, Shading* shadings);

  /// How much of the rays that meet some hits goes straight through: what a program says of at most
  /// Program::kLanes points. Its first outputs are a transparency.
  void clear_shares(const RenderContext& context, const Program& program, const ShadeTask* tasks,
                    std::uint32_t count, float* shares);

 private:
  MaterialRun run_;
};

}  // namespace komorebi
