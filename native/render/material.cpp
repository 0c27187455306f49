#include "render/material.h"

#include <algorithm>
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

bool is_plain(const Material& material, Vec3* albedo) {
  const SurfaceProgram& surface = material.camera;
  if (!surface.program || material.clear || material.bounce.program) return false;
  if (!surface.program->constant() || surface.lobes.size() != 1) return false;
  if (surface.lobes[0].transmits || surface.lobes[0].normal != kNone) return false;
  for (std::uint32_t i = 0; i < SurfaceProgram::kFirstLobe; ++i) {
    if (surface.program->constant_value(i) != 0.0f) return false;
  }
  for (std::uint32_t c = 0; c < 3; ++c) {
    const float value = surface.program->constant_value(SurfaceProgram::kFirstLobe + c);
    (*albedo)[static_cast<int>(c)] = value > 0.0f ? value : 0.0f;
  }
  return true;
}

float bound_of_emission(const Program& surface) {
  float bound = 0.0f;
  for (std::uint32_t i = SurfaceProgram::kEmission; i < SurfaceProgram::kEmission + 3; ++i) {
    bound = std::max(bound,
                     surface.constant(i) ? surface.constant_value(i) : surface.largest_constant());
  }
  return std::min(bound, 1e6f);
}

}  // namespace komorebi
