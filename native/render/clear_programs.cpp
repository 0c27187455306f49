#include "render/clear_programs.h"

namespace komorebi {
namespace {

std::shared_ptr<const Program> transparency_of(const Program& surface) {
  WrittenProgram written = surface.written();
  const auto first = written.outputs.begin() + SurfaceProgram::kTransparency;
  return std::make_shared<const Program>(surface.name(), std::move(written.ops),
                                         std::vector<Operand>(first, first + 3));
}

}  // namespace

ClearPrograms::ClearPrograms(const Material& material) {
  if (!material.clear) return;
  const SurfaceProgram& scatter = material.of_vertex(1);
  auto& camera_program = of_kind[static_cast<std::size_t>(PathKind::kCamera)];
  auto& scatter_program = of_kind[static_cast<std::size_t>(PathKind::kScatter)];
  camera_program = transparency_of(*material.camera.program);
  scatter_program = scatter.program == material.camera.program ? camera_program
                                                               : transparency_of(*scatter.program);
  of_kind[static_cast<std::size_t>(PathKind::kLight)] = material.clear;
}

}  // namespace komorebi
