#pragma once

#include <span>
#include <vector>

#include "core/vector.h"

namespace komorebi {

class ThreadPool;

/// The models of Blender's Sky Texture, as Cycles has them.
enum class SkyModel {
  kPreetham,            ///< "A Practical Analytic Model for Daylight", 1999
  kHosek,               ///< "An Analytic Model for Full Spectral Sky-Dome Radiance", 2012
  kNishita,             ///< until 4.5: light scattered once, by ray marching
  kSingleScattering,    ///< from 5.0: the same, fading below the horizon by its table (as in 5.2)
  kMultipleScattering,  ///< from 5.0: F. García Liñán's fit for four wavelengths
};

/// A sky. Angles in radians; the sun's elevation in [−π/2, π/2]. What a model has no use for is not
/// read.
struct SkyDesc {
  SkyModel model = SkyModel::kHosek;
  Vec3 sun_direction{0.0f, 0.0f, 1.0f};  ///< unit; of Preetham's and Hosek's, as are the next two
  float turbidity = 2.2f;
  float ground_albedo = 0.3f;
  bool sun_disc = true;  ///< whether directions in it are the sun's
  float sun_size = 0.0095f;
  float sun_intensity = 1.0f;
  float sun_elevation = 0.26f;
  float sun_rotation = 0.0f;  ///< from +y to +x
  float altitude = 0.0f;      ///< metres above the sea
  float air = 1.0f, aerosol = 1.0f, ozone = 1.0f;
};

// Numbers that operations on directions take; "sky_scattering" is that of the last three models.
inline constexpr std::uint32_t kPreethamNumbers = 20, kHosekNumbers = 32, kScatteringNumbers = 13;
inline constexpr std::uint32_t kSkyColumns = 256;  ///< of a table; the other half is its mirror

/// The numbers of a model's operation.
/// @throws std::invalid_argument if the sky has a number that is not finite
std::vector<float> sky_numbers(const SkyDesc& sky);

/// The table of "sky_scattering", [rows][kSkyColumns][3] in CIE XYZ: azimuths from the sun's
/// opposite to the sun, rows upwards and denser at the horizon. It depends on nothing but model,
/// elevation, altitude and densities.
/// @throws std::invalid_argument for other models, and as sky_numbers
std::vector<float> sky_table(const SkyDesc& sky, ThreadPool& pool);

/// The sun's disc as a light of its own: even, as large as the disc and of the same irradiance.
struct SkySun {
  Vec3 direction;  ///< towards it
  float radius;    ///< of the disc, an angle
  Vec3 radiance;   ///< linear Rec.709; how much it adds to the sky without it
};
/// @param table  sky_table of the same sky
SkySun sky_sun(const SkyDesc& sky, std::span<const float> table);

// The parts of the above, by model.
std::vector<float> preetham_numbers(const SkyDesc& sky);
std::vector<float> hosek_numbers(const SkyDesc& sky);
std::vector<float> single_scattering_table(const SkyDesc& sky, ThreadPool& pool);
std::vector<float> multiple_scattering_table(const SkyDesc& sky, ThreadPool& pool);

/// The sun's radiance in CIE XYZ at the disc's lowest and highest point, at the intensity 1.
struct SunEdges {
  Vec3d bottom, top;
};
SunEdges single_scattering_sun(const SkyDesc& sky);
SunEdges multiple_scattering_sun(const SkyDesc& sky);

}  // namespace komorebi
