#include <glm/gtc/type_ptr.hpp>

#include "io/array_file.h"
#include "render/dump.h"

namespace komorebi {

void put_lamps(ArrayFile& file, const std::vector<LampInput>& lamps) {
  const std::size_t n = lamps.size();
  if (n == 0) return;
  std::vector<std::uint32_t> kind, flags, by_cosine;
  std::vector<double> radiance, matrices;
  for (const LampInput& lamp : lamps) {
    kind.push_back(static_cast<std::uint32_t>(lamp.kind));
    flags.push_back(lamp.flags);
    by_cosine.push_back(lamp.spot_scales_by_cosine ? 1 : 0);
    radiance.insert(radiance.end(), glm::value_ptr(lamp.radiance),
                    glm::value_ptr(lamp.radiance) + 3);
    const double* matrix = glm::value_ptr(lamp.world_from_lamp);
    matrices.insert(matrices.end(), matrix, matrix + 16);
  }
  file.put<std::uint32_t>("lamp/kind", kind, {n});
  file.put<std::uint32_t>("lamp/flags", flags, {n});
  file.put<std::uint32_t>("lamp/scales_by_cosine", by_cosine, {n});
  file.put<double>("lamp/radiance", radiance, {n, 3});
  file.put<double>("lamp/world_from_lamp", matrices, {n, 4, 4});
  std::vector<double> numbers;
  for (const LampInput& lamp : lamps) {
    for_each_lamp_number(lamp, [&](const char*, double number) { numbers.push_back(number); });
  }
  file.put<double>("lamp/numbers", numbers, {n, numbers.size() / n});
}

void get_lamps(const ArrayFile& file, Scene& scene) {
  if (!file.has("lamp/kind")) return;
  const auto kind = file.get<std::uint32_t>("lamp/kind");
  const std::size_t n = kind.size();
  const auto flags = file.get<std::uint32_t>("lamp/flags", n);
  const auto by_cosine = file.get<std::uint32_t>("lamp/scales_by_cosine", n);
  const auto radiance = file.get<double>("lamp/radiance", 3 * n);
  const auto matrices = file.get<double>("lamp/world_from_lamp", 16 * n);
  std::vector<LampInput> lamps(n);
  std::size_t columns = 0, read = 0;
  if (n > 0) for_each_lamp_number(lamps[0], [&](const char*, double) { ++columns; });
  const auto numbers = file.get<double>("lamp/numbers", columns * n);
  for (std::size_t i = 0; i < n; ++i) {
    if (kind[i] > static_cast<std::uint32_t>(LampKind::kEllipse)) {
      throw std::runtime_error("the scene has a lamp of an unknown kind");
    }
    lamps[i].name = std::to_string(i);
    lamps[i].kind = static_cast<LampKind>(kind[i]);
    lamps[i].flags = flags[i];
    lamps[i].spot_scales_by_cosine = by_cosine[i] != 0;
    lamps[i].radiance = glm::make_vec3(&radiance[3 * i]);
    lamps[i].world_from_lamp = glm::make_mat4(&matrices[16 * i]);
    for_each_lamp_number(lamps[i], [&](const char*, double& number) { number = numbers[read++]; });
    scene.add_lamp(lamps[i]);
  }
}

}  // namespace komorebi
