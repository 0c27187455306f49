#include <algorithm>
#include <stdexcept>

#include "render/scene.h"
#include "render/world_program.h"

namespace komorebi {

void Scene::set_world_program(std::shared_ptr<const Program> program, float max_radiance) {
  require_open();
  if (program && program->output_count() != 3) {
    throw std::invalid_argument(program->name() + ": a world has three outputs, its radiance");
  }
  world_program_max_ = program ? std::max(max_radiance, brightest(*program)) : 0.0f;
  world_program_ = std::move(program);
}

void Scene::set_surfaces(std::vector<Material> surfaces, std::vector<float> instance_random) {
  require_open();
  if (surfaces.size() != tables_.materials.size()) {
    throw std::invalid_argument(std::to_string(surfaces.size()) + " surfaces for " +
                                std::to_string(tables_.materials.size()) + " materials");
  }
  for (const Material& material : surfaces) {
    if (material.camera.program) {
      emission_max_ = std::max(emission_max_, bound_of_emission(*material.camera.program));
    }
  }
  tables_.surfaces = std::move(surfaces);
  tables_.instance_random = std::move(instance_random);
}

float Scene::max_radiance() const {
  const float light = environment_ ? static_cast<float>(strength_) * environment_->max_radiance()
                                   : max_abs(world_color_);
  return std::max({light, world_program_max_, emission_max_});
}

}  // namespace komorebi
