#include "render/material.h"

#include <stdexcept>

namespace komorebi {

SurfaceProgram::SurfaceProgram(std::shared_ptr<const Program> of,
                               const std::vector<LobeInput>& inputs)
    : program(std::move(of)) {
  std::uint32_t next = kFirstLobe;
  for (const LobeInput& input : inputs) {
    SurfaceLobe lobe{input.transmits, next, kNone};
    next += 3;
    if (input.has_normal) {
      lobe.normal = next;
      next += 3;
    }
    lobes.push_back(lobe);
  }
  if (program->output_count() != next || next > kMostOutputs * 2) {
    throw std::invalid_argument(program->name() + ": a surface with these lobes has " +
                                std::to_string(next) + " outputs, the program " +
                                std::to_string(program->output_count()));
  }
}

}  // namespace komorebi
