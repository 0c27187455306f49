#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/filter.h"
#include "core/vector.h"

namespace komorebi {

enum class Method : std::uint32_t { kAmbientOcclusion, kWorldLight };
enum class AoSampling : std::uint32_t { kCosine, kUniform };
/// How mist grows with distance: Blender's names.
enum class MistFalloff : std::uint32_t { kQuadratic, kLinear, kInverseQuadratic };
enum class EnvironmentSampling : std::uint32_t { kMis, kCosine, kEnvironment, kProduct };
enum class FastGiMethod : std::uint32_t { kReplace, kAdd };

/// A rectangle of full-frame pixels, half open; row 0 at the bottom.
struct Rect {
  std::uint32_t x_min = 0, y_min = 0, x_max = 0, y_max = 0;
  std::uint32_t width() const { return x_max - x_min; }
  std::uint32_t height() const { return y_max - y_min; }
  std::size_t area() const { return static_cast<std::size_t>(width()) * height(); }
};

/// Films of up to as many samples have finer units than larger ones.
inline constexpr std::uint32_t kManySamples = 1u << 16;

/// Light rays per camera sample when the settings leave it open, or half as many, with bounces less
/// (choose_light_samples): those with which a picture is good soonest. More than these leave too
/// few camera samples to edges, and to a map seen behind.
inline constexpr std::uint32_t kAutomaticLightSamples = 8;

/// Everything about a render that is not in the scene. Names are those of `scene.komorebi`.
struct Settings {
  Method method = Method::kAmbientOcclusion;
  std::uint32_t samples = 32;       ///< camera samples a pixel
  std::uint32_t light_samples = 0;  ///< light rays per camera sample; 0: automatic
  std::uint32_t sample_offset = 0;  ///< index of the first camera sample
  std::uint32_t seed = 0;
  bool use_adaptive_sampling = false;      ///< stop where the noise is below the threshold
  float adaptive_threshold = 0.0f;         ///< noise; 0: from the number of samples
  std::uint32_t adaptive_min_samples = 0;  ///< before the first stop; 0: from the threshold
  float time_limit = 0.0f;                 ///< seconds; 0: none
  float ao_distance = 0.0f;                ///< metres; 0: unlimited
  AoSampling ao_sampling = AoSampling::kCosine;
  Vec3 clay_color{0.8f};  ///< albedo under World Light, and of later surfaces; linear Rec.709
  std::uint32_t bounces =
      0;  ///< from surface to surface; 0: light that comes straight from the sky
  /// Most that one vertex of a sample brings, as the mean of the channels; 0: anything. What the
  /// camera sees without and with bounces; names, meaning and values are those of Cycles.
  float sample_clamp_direct = 0.0f, sample_clamp_indirect = 10.0f;
  /// After so many bounces light of a map counts by the surface's own rays alone, as in Cycles.
  std::uint32_t world_max_bounces = 1024;
  bool use_fast_gi = false;  ///< under World Light
  FastGiMethod fast_gi_method = FastGiMethod::kReplace;
  std::uint32_t fast_gi_bounces = 1;  ///< after which Replace sets in; 0: never
  float fast_gi_distance = 10.0f;     ///< metres
  float fast_gi_factor = 1.0f;        ///< of ambient light; 0: none of it
  EnvironmentSampling environment_sampling = EnvironmentSampling::kProduct;
  /// Whether parts of the sky that surfaces see get the light rays, which is measured before the
  /// first sample (SkyGuide). It is for pictures that are soon thrown away that it does not pay.
  bool guides_light = true;
  PixelFilter pixel_filter = PixelFilter::kBlackmanHarris;
  float filter_width = 1.5f;    ///< pixels
  bool use_progressive = true;  ///< refine the whole frame, not one tile to its end
  /// Of a pixel, at most, before the next ones; what is made of more takes a little less time.
  std::uint32_t samples_per_pass = 16;
  bool film_transparent = false;
  float mist_start = 5.0f;   ///< metres from the camera
  float mist_depth = 25.0f;  ///< metres from there to full mist
  MistFalloff mist_falloff = MistFalloff::kQuadratic;
  std::uint32_t threads = 0;      ///< 0: one per core
  bool has_low_priority = false;  ///< its threads let those come first that draw what they render
  std::uint32_t tile_size = 64;   ///< pixels
  bool has_region = false;        ///< false: the whole frame
  Rect region;
  std::vector<std::string> passes{"Combined", "Depth", "Normal"};
};

/// Light rays that each camera sample casts, at most.
inline std::uint32_t resolved_light_samples(const Settings& settings) {
  return settings.light_samples > 0 ? settings.light_samples : kAutomaticLightSamples;
}

/// What bounces may multiply the radiance of a surface by, at most: all of them bring what it has,
/// less what each surface keeps.
double bounce_gain(const Settings& settings);

/// Throws std::invalid_argument with a sentence that names the setting out of range.
void check_settings(const Settings& settings, std::uint32_t width, std::uint32_t height);

}  // namespace komorebi
