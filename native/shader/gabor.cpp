#include "shader/gabor.h"

#include "core/functions.h"
#include "shader/hash.h"

namespace komorebi {
namespace {

constexpr int kWaves = 8;  // in a cell

// A Gaussian bell that a Hann window ends at distance 1, times a wave.
void add_wave(float squared_distance, float turns_times_2pi, float weight, Phasor& sum) {
  const float window = 0.5f + 0.5f * fn::cos(kPiFloat * squared_distance);
  const float bell = weight * fn::exp(-kPiFloat * squared_distance) * window;
  const SinCos<double> wave = fn::sin_cos(turns_times_2pi);
  sum.re += bell * static_cast<float>(wave.cos);
  sum.im += bell * static_cast<float>(wave.sin);
}

void add_cell(const float (&cell)[2], const float (&p)[2], float frequency, float isotropy,
              float orientation, Phasor& sum) {
  for (int i = 0; i < kWaves; ++i) {
    const auto seed = static_cast<float>(3 * i);
    const float x = p[0] - hash_floats(cell[0], cell[1], seed + 1.0f);
    const float y = p[1] - hash_floats(seed + 1.0f, cell[0], cell[1]);
    const float squared = x * x + y * y;
    if (!(squared < 1.0f)) continue;
    const float turn = (hash_floats(cell[0], cell[1], seed) - 0.5f) * kPiFloat;
    const SinCos<double> way = fn::sin_cos(orientation + turn * isotropy);
    const float along = x * (frequency * static_cast<float>(way.cos)) +
                        y * (frequency * static_cast<float>(way.sin));
    const float weight = hash_floats(cell[0], cell[1], seed + 2.0f) < 0.5f ? -1.0f : 1.0f;
    add_wave(squared, kTwoPi * along, weight, sum);
  }
}

// `orientation` turned by what `seed` and the cell say, in spherical coordinates.
void turn_3d(const float (&cell)[3], float seed, float isotropy, const float (&orientation)[3],
             float (&way)[3]) {
  for (int d = 0; d < 3; ++d) way[d] = orientation[d];
  if (isotropy == 0.0f) return;
  const float x = orientation[0], y = orientation[1];
  float inclination = fn::acos(orientation[2]);
  float azimuth = (y < 0.0f ? -1.0f : 1.0f) * fn::acos(x / std::sqrt(x * x + y * y));
  inclination += hash_floats(cell[0], cell[1], cell[2], seed) * kPiFloat * isotropy;
  azimuth += hash_floats(cell[2], cell[0], seed, cell[1]) * kPiFloat * isotropy;
  const float radius = fn::sin(inclination);
  way[0] = radius * fn::cos(azimuth);
  way[1] = radius * fn::sin(azimuth);
  way[2] = fn::cos(inclination);
}

void add_cell(const float (&cell)[3], const float (&p)[3], float frequency, float isotropy,
              const float (&orientation)[3], Phasor& sum) {
  for (int i = 0; i < kWaves; ++i) {
    const auto seed = static_cast<float>(3 * i);
    const float s = seed + 1.0f;
    const float x = p[0] - hash_floats(cell[0], cell[1], cell[2], s);
    const float y = p[1] - hash_floats(cell[2], cell[0], s, cell[1]);
    const float z = p[2] - hash_floats(s, cell[2], cell[1], cell[0]);
    const float squared = x * x + y * y + z * z;
    if (!(squared < 1.0f)) continue;
    float way[3];
    turn_3d(cell, seed, isotropy, orientation, way);
    const float along =
        x * (frequency * way[0]) + y * (frequency * way[1]) + z * (frequency * way[2]);
    const float weight = hash_floats(cell[0], cell[1], cell[2], seed + 2.0f) < 0.5f ? -1.0f : 1.0f;
    add_wave(squared, kTwoPi * along, weight, sum);
  }
}

}  // namespace

Phasor gabor_2d(const float (&p)[2], float frequency, float isotropy, float orientation) {
  const float corner[2] = {fn::floor(p[0]), fn::floor(p[1])};
  Phasor sum;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const float step[2] = {static_cast<float>(i), static_cast<float>(j)};
      const float cell[2] = {corner[0] + step[0], corner[1] + step[1]};
      const float local[2] = {p[0] - corner[0] - step[0], p[1] - corner[1] - step[1]};
      add_cell(cell, local, frequency, isotropy, orientation, sum);
    }
  }
  return sum;
}

Phasor gabor_3d(const float (&p)[3], float frequency, float isotropy,
                const float (&orientation)[3]) {
  const float corner[3] = {fn::floor(p[0]), fn::floor(p[1]), fn::floor(p[2])};
  Phasor sum;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        const float step[3] = {static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)};
        float cell[3], local[3];
        for (int d = 0; d < 3; ++d) {
          cell[d] = corner[d] + step[d];
          local[d] = p[d] - corner[d] - step[d];
        }
        add_cell(cell, local, frequency, isotropy, orientation, sum);
      }
    }
  }
  return sum;
}

}  // namespace komorebi
