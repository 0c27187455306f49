#pragma once

#include <random>
#include <string>
#include <vector>

#include "render/environment.h"

namespace komorebi::testing {

inline Environment make_map(std::uint32_t width, std::uint32_t height,
                            const std::vector<float>& texels) {
  return Environment("test", width, height, texels);
}

/// Every texel random: a tenth black, the rest over three decades, coloured.
inline Environment random_map(std::uint32_t width, std::uint32_t height, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  std::vector<float> texels;
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const double scale = uniform() < 0.1 ? 0.0 : std::exp(7.0 * uniform() - 4.0);
    for (int c = 0; c < 3; ++c) texels.push_back(static_cast<float>(scale * uniform()));
  }
  return make_map(width, height, texels);
}

/// A random map of numbers that this storage, and none that takes less room, holds exactly; one in
/// eight is tiny.
inline Environment stored_map(std::uint32_t width, std::uint32_t height, std::uint64_t seed,
                              LightStorage storage) {
  std::mt19937_64 engine(seed);
  std::vector<float> texels;
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const bool tiny = engine() % 8 == 0;
    const auto exponent = static_cast<std::uint32_t>(engine() % 8);
    if (storage == LightStorage::kRgbe) {
      const std::uint32_t rgb = static_cast<std::uint32_t>(engine()) & 0xffffffu;
      const Vec3 value = rgbe_texel(rgb | (tiny ? 15u : 124u + exponent) << 24);
      texels.insert(texels.end(), &value.x, &value.x + 3);
    } else {
      for (int c = 0; c < 3; ++c) {
        const auto fraction = static_cast<std::uint16_t>(engine() % 1024);
        const auto half =
            static_cast<std::uint16_t>((tiny ? 0u : (12u + exponent) << 10) | fraction);
        const float any = static_cast<float>(engine() >> 40) * 0x1p-24f;
        texels.push_back(storage == LightStorage::kHalf ? float_from_half(half) : any);
      }
    }
  }
  return make_map(width, height, texels);
}

/// A dim sky with a sun of one texel that has nearly all of the energy.
inline Environment sunny_map(std::uint32_t width, std::uint32_t height, std::uint32_t sun_column,
                             std::uint32_t sun_row, float sun, float sky = 0.01f) {
  std::vector<float> texels(std::size_t{3} * width * height, sky);
  for (std::size_t c = 0; c < 3; ++c) {
    texels[3 * (std::size_t{sun_row} * width + sun_column) + c] = sun;
  }
  return make_map(width, height, texels);
}

/// The integral of `f(radiance, direction)` over the sphere for a map without rotation, by the
/// midpoint rule in (u, v) with cos(latitude) and `points`² points a patch: another route than the
/// tables' own sums, which work in (u, z). Directions and radiance are worked out in double.
template <typename F>
double integrate_map(const EnvironmentView& e, int points, F f) {
  double total = 0.0;
  const double w = e.width, h = e.height;
  const auto texel = [&](std::uint32_t column, std::uint32_t row) {
    return Vec3d(detail::environment_texel(e, column % e.width, row % e.height));
  };
  for (std::uint32_t j = 0; j < e.height; ++j) {
    for (std::uint32_t i = 0; i < e.width; ++i) {
      const Vec3d a = texel(i, j), b = texel(i + 1, j), c = texel(i, j + 1),
                  d = texel(i + 1, j + 1);
      for (int q = 0; q < points; ++q) {
        const double t = (q + 0.5) / points;
        double v = (j + 0.5 + t) / h;
        if (v > 1.0) v -= 1.0;  // the last row's patch is half at one pole, half at the other
        const double latitude = kPi * (v - 0.5), cos_lat = std::cos(latitude);
        for (int p = 0; p < points; ++p) {
          const double s = (p + 0.5) / points;
          const double phi = 2.0 * kPi * (0.5 - (i + 0.5 + s) / w);
          const Vec3d radiance = (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * c + s * d);
          total += f(radiance,
                     Vec3d(cos_lat * std::cos(phi), cos_lat * std::sin(phi), std::sin(latitude))) *
                   cos_lat;
        }
      }
    }
  }
  return total * (2.0 * kPi / w) * (kPi / h) / (points * points);
}

inline double luminance_of(const Vec3d& rgb) {
  return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

/// ∫ luminance dω, by quadrature.
inline double exact_power(const EnvironmentView& e, int points) {
  return integrate_map(e, points, [](const Vec3d& l, const Vec3d&) { return luminance_of(l); });
}

/// The same, estimated with Sobol' points.
inline double estimated_power(const EnvironmentView& e, std::uint32_t count) {
  double sum = 0.0;
  const Sampler sampler(0, 1, 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto s = sample_environment(e, sampler.bits_2d(8, i));
    sum += luminance(s.radiance) / double{s.pdf};
  }
  return sum / count;
}

}  // namespace komorebi::testing
