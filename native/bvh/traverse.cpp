#include "bvh/traverse.h"

#include <algorithm>
#include <stdexcept>

namespace komorebi {

void intersect(const SceneView& scene, const RaySpan& rays, Hit* hits) {
  for (std::uint32_t i = 0; i < rays.count; ++i) hits[i] = intersect_scalar(scene, rays[i]);
}

void occluded(const SceneView& scene, const RaySpan& rays, std::uint32_t* bits) {
  std::fill(bits, bits + (rays.count + 31) / 32, 0u);
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if (occluded_scalar(scene, rays[i])) bits[i / 32] |= 1u << (i % 32);
  }
}

std::vector<std::string> built_instruction_sets() {
  return {"SCALAR"};
}

const char* active_instruction_set() {
  return "SCALAR";
}

void force_instruction_set(const std::string& name) {
  if (!name.empty() && name != "SCALAR") {
    throw std::invalid_argument("this build has no kernel for the instruction set \"" + name +
                                "\"");
  }
}

}  // namespace komorebi
