#pragma once

#include <cstdint>

namespace komorebi {

/// Blender's names: Closest, Linear, Cubic, Smart.
enum class Interpolation : std::uint8_t { kClosest, kLinear, kCubic, kSmart };
/// REPEAT, EXTEND, CLIP, MIRROR.
enum class Extension : std::uint8_t { kRepeat, kExtend, kClip, kMirror };

/// What an Image Texture node asks of its picture.
struct TextureSampling {
  Interpolation interpolation = Interpolation::kLinear;
  Extension extension = Extension::kRepeat;
  /// Colours are divided by alpha: Cycles does so where the node's Alpha is used (and never for
  /// data, packed channels, and where alpha is left out; Texture knows).
  bool straight = false;
};

}  // namespace komorebi
