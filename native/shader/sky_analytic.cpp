#include <algorithm>

#include "shader/sky_hosek_data.h"
#include "shader/sky_radiance.h"

namespace komorebi {
namespace {

struct SunAngles {
  float theta, phi;
};

SunAngles sun_angles(const SkyDesc& sky) {
  return {sky_theta(sky.sun_direction), fn::atan2(sky.sun_direction.x, sky.sun_direction.y)};
}

/// Σ_k B_k(t) points[k]: the Bézier curve of degree 5 with these points, `stride` doubles apart.
double bezier(double t, const double* points, std::size_t stride) {
  constexpr double kBinomial[6] = {1, 5, 10, 10, 5, 1};
  double sum = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    double weight = kBinomial[k];
    for (std::size_t i = 0; i < 5; ++i) weight *= i < k ? t : 1.0 - t;
    sum += weight * points[k * stride];
  }
  return sum;
}

/// Where a sky lies between those of the data set.
struct HosekPlace {
  double albedo, turbidity, elevation;  ///< turbidity 0 to 9; elevation as the curves take it

  /// data: [albedo][turbidity][6][stride]
  double read(const double* data, std::size_t stride) const {
    const std::size_t low = std::min<std::size_t>(static_cast<std::size_t>(turbidity), 8);
    const double t = turbidity - static_cast<double>(low);
    const auto at = [&](std::size_t a, std::size_t i) {
      return bezier(elevation, data + (10 * a + i) * 6 * stride, stride);
    };
    return (1.0 - albedo) * ((1.0 - t) * at(0, low) + t * at(0, low + 1)) +
           albedo * ((1.0 - t) * at(1, low) + t * at(1, low + 1));
  }
};

}  // namespace

// Preetham et al., appendix A.2. Luminance is 0.06 of theirs, in kcd/m², as in Cycles.
std::vector<float> preetham_numbers(const SkyDesc& sky) {
  const SunAngles angles = sun_angles(sky);
  const float theta = angles.theta, phi = angles.phi;
  const float t = sky.turbidity;
  const float chi = (4.0f / 9.0f - t / 120.0f) * (kPiFloat - 2.0f * theta);
  const auto chromaticity = [&](const float(&c)[11]) {
    const auto cubic = [&](const float* k) {
      return ((k[0] * theta + k[1]) * theta + k[2]) * theta;
    };
    return (cubic(c) * t + cubic(c + 3) + c[9]) * t + cubic(c + 6) + c[10];
  };
  const float x = chromaticity({0.00166f, -0.00375f, 0.00209f, -0.02903f, 0.06377f, -0.03202f,
                                0.11693f, -0.21196f, 0.06052f, 0.00394f, 0.25886f});
  const float y = chromaticity({0.00275f, -0.00610f, 0.00317f, -0.04214f, 0.08970f, -0.04153f,
                                0.15346f, -0.26756f, 0.06670f, 0.00516f, 0.26688f});
  const float luminance = 0.06f * ((4.0453f * t - 4.9710f) * fn::tan(chi) - 0.2155f * t + 2.4192f);
  std::vector<float> numbers = {
      theta,
      phi,
      x,
      y,
      luminance,
      // of x
      -0.0193f * t - 0.2592f,
      -0.0665f * t + 0.0008f,
      -0.0004f * t + 0.2125f,
      -0.0641f * t - 0.8989f,
      -0.0033f * t + 0.0452f,
      // of y
      -0.0167f * t - 0.2608f,
      -0.0950f * t + 0.0092f,
      -0.0079f * t + 0.2102f,
      -0.0441f * t - 1.6537f,
      -0.0109f * t + 0.0529f,
      // of Y
      0.1787f * t - 1.4630f,
      -0.3554f * t + 0.4275f,
      -0.0227f * t + 5.3251f,
      0.1206f * t - 2.5771f,
      -0.0670f * t + 0.3703f,
  };
  for (std::size_t c = 0; c < 3; ++c) {
    numbers[2 + c] /= perez(&numbers[5 + 5 * c], 1.0f, fn::cos(theta), theta);
  }
  return numbers;
}

std::vector<float> hosek_numbers(const SkyDesc& sky) {
  auto [theta, phi] = sun_angles(sky);
  theta = std::min(theta, 0.5f * kPiFloat);
  const double height = std::max(1.0 - theta / (0.5 * kPi), 0.0);
  const HosekPlace place = {std::clamp(sky.ground_albedo, 0.0f, 1.0f),
                            std::clamp(sky.turbidity, 1.0f, 10.0f) - 1.0,
                            height > 0.0 ? exp_double(log_double(height) / 3.0) : 0.0};
  std::vector<float> numbers = {theta, phi};
  for (const auto* data : {&kHosekRadianceX, &kHosekRadianceY, &kHosekRadianceZ}) {
    numbers.push_back(static_cast<float>(place.read(&(*data)[0][0][0], 1)));
  }
  for (const auto* data : {&kHosekDistributionX, &kHosekDistributionY, &kHosekDistributionZ}) {
    for (std::size_t i = 0; i < 9; ++i) {
      numbers.push_back(static_cast<float>(place.read(&(*data)[0][0][0][i], 9)));
    }
  }
  return numbers;
}

}  // namespace komorebi
