#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/vector.h"

namespace komorebi {

/// How the samples of a pixel become its value in a pass.
enum class PassRule : std::uint32_t {
  kMean,         ///< sum of the samples over their number
  kMeanOfHits,   ///< over the number of those that have hit something
  kFirstSample,  ///< what the sample with the lowest index saw: places and indices, as Cycles
  kDirection,    ///< the sum of the samples as a unit vector; null where it is null
  kCount,        ///< the number of samples over the largest, `samples` (as Cycles)
  kVariance,     ///< of the samples' radiance
  kCatcher,      ///< the light on shadow catchers over what they would have alone (as Cycles)
  kMatte,        ///< two ranks of a Cryptomatte: id, coverage, id, coverage
};

/// What one camera sample can leave in a pixel besides its radiance and alpha.
enum class Quantity : std::uint8_t {
  // Of the first sample:
  kDepth,
  kPosition,
  kObjectIndex,
  kMaterialIndex,
  kInstanceIndex,
  // Means:
  kNormal,
  kUv,
  kMist,
  kEnvironment,
  kDiffuseColor,
  kEmission,
  kDenoisingNormal,
  kDenoisingRoughness,
  kDenoisingDepth,
  kAmbientOcclusion,
  kSkyVisibility,
  kBentNormal,
  kVector,
  kVectorWeight,   ///< 1 for a sample that has a vector
  kCatcherLight,   ///< of shadow catchers, were there nothing but them
  kMaterialValue,  ///< as many channels of SceneTables::values as passes ask for
  kMatte,          ///< what is no shadow catcher: premultiplied radiance and alpha
  // Cryptomatte ids:
  kMatteObject,
  kMatteMaterial,
  kMatteAsset,
  kCount
};
inline constexpr std::size_t kQuantities = static_cast<std::size_t>(Quantity::kCount);
inline constexpr std::uint32_t kMattes = 3;
inline constexpr std::uint32_t kMaxMatteRanks = 16;

struct PassDesc {
  const char* name;
  std::uint32_t channels;
  PassRule rule;
  Quantity quantity = Quantity::kCount;  ///< what it is made of; kCount: of radiance and alpha
};

/// The passes that a film can keep. Names are Blender's where it has one; a Cryptomatte comes in
/// parts of two ranks each, "CryptoObject00" and so on. "Material Value f n" is n (1 to 4) floats
/// of the material's row of SceneTables::values, from number f on: the mean over all samples.
std::span<const PassDesc> known_passes();

/// @throws std::invalid_argument if there is no such pass
const PassDesc& find_pass(const std::string& name);

/// The number at the end of a Cryptomatte part's name.
std::uint32_t matte_part(const std::string& name);

/// Where in the row of values a "Material Value" begins.
std::uint32_t first_value(const std::string& name);

/// Which quantities a film keeps, and where each stands in the row of floats that a sample leaves:
/// first the means, then what only the first sample counts for, then the ids of Cryptomattes.
struct PassLayout {
  static constexpr std::int16_t kNone = -1;

  std::int16_t place[kQuantities];
  std::uint16_t means = 0, firsts = 0, ids = 0;
  std::uint16_t values = 0;  ///< channels of kMaterialValue
  bool keeps_variance = false;

  PassLayout();
  std::size_t size() const { return std::size_t{means} + firsts + ids; }
  std::uint32_t channels_of(Quantity q) const;
  bool keeps(Quantity q) const { return place[static_cast<std::size_t>(q)] != kNone; }
  /// Rays of their own that no other part of the render casts.
  bool keeps_ambient() const;

  /// Writes a quantity's values into the row, if it is kept.
  void put(float* row, Quantity q, float value) const {
    if (keeps(q)) row[place[static_cast<std::size_t>(q)]] = value;
  }
  void put(float* row, Quantity q, const Vec3& v) const {
    if (!keeps(q)) return;
    float* to = row + place[static_cast<std::size_t>(q)];
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  }

  /// The same three channels added to, if they are kept, and read, which they must be.
  void add(float* row, Quantity q, const Vec3& v) const {
    if (!keeps(q)) return;
    float* to = row + place[static_cast<std::size_t>(q)];
    for (int c = 0; c < 3; ++c) to[c] += v[c];
  }
  Vec3 get(const float* row, Quantity q) const {
    const float* from = row + place[static_cast<std::size_t>(q)];
    return Vec3(from[0], from[1], from[2]);
  }
};

/// For these passes; with `catchers` also what the picture of a scene with shadow catchers is
/// composed of, its background too unless the film is transparent.
/// @throws std::invalid_argument for a pass that is not known
PassLayout make_pass_layout(const std::vector<std::string>& passes, bool catchers,
                            bool film_transparent);

}  // namespace komorebi
