#include "shader/sky.h"

#include <stdexcept>
#include <string>

#include "shader/sky_radiance.h"

namespace komorebi {
namespace {

bool is_scattering(SkyModel model) {
  return model != SkyModel::kPreetham && model != SkyModel::kHosek;
}

void check(const SkyDesc& sky) {
  const std::pair<const char*, float> numbers[] = {{"sun direction", sky.sun_direction.x},
                                                   {"sun direction", sky.sun_direction.y},
                                                   {"sun direction", sky.sun_direction.z},
                                                   {"turbidity", sky.turbidity},
                                                   {"ground albedo", sky.ground_albedo},
                                                   {"sun size", sky.sun_size},
                                                   {"sun intensity", sky.sun_intensity},
                                                   {"sun elevation", sky.sun_elevation},
                                                   {"sun rotation", sky.sun_rotation},
                                                   {"altitude", sky.altitude},
                                                   {"air density", sky.air},
                                                   {"aerosol density", sky.aerosol},
                                                   {"ozone density", sky.ozone}};
  for (const auto& [name, value] : numbers) {
    if (!is_finite(value))
      throw std::invalid_argument(std::string("sky: its ") + name + " is not a finite number");
  }
  if (is_scattering(sky.model) && !(sky.sun_size > 0.0f)) {
    throw std::invalid_argument("sky: its sun size is not above 0");
  }
}

// Below this elevation the earth, as large as in the last model, hides the sun.
float lowest_sun(const SkyDesc& sky) {
  constexpr float kEarth = 6371.0f;
  return fn::asin(std::min(kEarth / (kEarth + sky.altitude / 1000.0f), 1.0f)) - 0.5f * kPiFloat;
}

}  // namespace

std::vector<float> sky_numbers(const SkyDesc& sky) {
  check(sky);
  if (sky.model == SkyModel::kPreetham) return preetham_numbers(sky);
  if (sky.model == SkyModel::kHosek) return hosek_numbers(sky);
  const auto [bottom, top] = sky.model == SkyModel::kMultipleScattering
                                 ? multiple_scattering_sun(sky)
                                 : single_scattering_sun(sky);
  std::vector<float> numbers = {static_cast<float>(static_cast<int>(sky.model)),
                                sky.sun_disc ? 1.0f : 0.0f};
  for (const Vec3d& edge : {bottom, top}) {
    for (int c = 0; c < 3; ++c) numbers.push_back(static_cast<float>(edge[c]));
  }
  for (const float n :
       {sky.sun_elevation, sky.sun_rotation, sky.sun_size, sky.sun_intensity, lowest_sun(sky)}) {
    numbers.push_back(n);
  }
  return numbers;
}

std::vector<float> sky_table(const SkyDesc& sky, ThreadPool& pool) {
  check(sky);
  if (!is_scattering(sky.model)) throw std::invalid_argument("sky: its model has no table");
  return sky.model == SkyModel::kMultipleScattering ? multiple_scattering_table(sky, pool)
                                                    : single_scattering_table(sky, pool);
}

SkySun sky_sun(const SkyDesc& sky, std::span<const float> table) {
  if (!is_scattering(sky.model)) throw std::invalid_argument("sky: its model has no sun");
  SkyDesc with = sky;
  with.sun_disc = true;
  std::vector<float> numbers = sky_numbers(with);
  const ScatteringSky bright(numbers.data(), table);
  numbers[1] = 0.0f;
  const ScatteringSky dark(numbers.data(), table);
  const Vec3d axis(bright.sun());
  const Vec3d x =
      glm::normalize(glm::cross(axis, std::abs(axis.z) < 0.9 ? Vec3d(0, 0, 1) : Vec3d(1, 0, 0)));
  const Vec3d y = glm::cross(axis, x);
  // Rings and sectors of equal solid angle. The cosine to the disc's middle weights them, so that a
  // surface that faces the sun has the irradiance that it has from the disc.
  constexpr int kRings = 128, kSectors = 64;
  const double half = 0.5 * sky.sun_size, quarter = sin_cos_turns(half / (4.0 * kPi)).sin;
  const double depth = 2.0 * quarter * quarter;  // of the cap
  Vec3d sum(0.0);
  double weights = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double below = depth * (i + 0.5) / kRings, cosine = 1.0 - below;
    const double sine = std::sqrt(below * (2.0 - below));
    for (int j = 0; j < kSectors; ++j) {
      const auto turn = sin_cos_turns((j + 0.5) / kSectors);
      const Vec3 d(cosine * axis + sine * (turn.cos * x + turn.sin * y));
      sum += cosine * (Vec3d(bright.radiance(d)) - Vec3d(dark.radiance(d)));
      weights += cosine;
    }
  }
  return {bright.sun(), static_cast<float>(half), Vec3(glm::max(sum / weights, Vec3d(0.0)))};
}

}  // namespace komorebi
