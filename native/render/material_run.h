#pragma once

#include "render/material_points.h"

namespace komorebi {

/// Runs materials' programs at hits. One a thread.
class MaterialRun {
 public:
  /// The program's outputs at some hits, at most Program::kLanes: [outputs][kLanes], valid until
  /// the next call.
  float* const* run(const RenderContext& context, const Program& program, const ShadeTask* tasks,
                    std::uint32_t count);

 private:
  MaterialPoints points_;
  Program::Scratch scratch_;
  std::vector<float> results_;  // [outputs][kLanes]
  std::vector<float*> rows_;
};

}  // namespace komorebi
