#include "render/material_run.h"

namespace komorebi {

float* const* MaterialRun::run(const RenderContext& context, const Program& program,
                               const ShadeTask* tasks, std::uint32_t count) {
  constexpr std::uint32_t kLanes = Program::kLanes;
  const std::size_t outputs = program.output_count();
  if (results_.size() < outputs * kLanes) results_.resize(outputs * kLanes);
  rows_.resize(outputs);
  for (std::size_t i = 0; i < outputs; ++i) rows_[i] = &results_[i * kLanes];
  program.run(points_.fill(context, program, tasks, count), scratch_, rows_.data());
  return rows_.data();
}

}  // namespace komorebi
