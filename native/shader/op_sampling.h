#pragma once

#include "texture/sampling.h"

namespace komorebi {

/// The parameters of an operation on a texture begin with these: interpolation, extension, whether
/// colours are divided by alpha.
inline TextureSampling sampling_of(const float* numbers) {
  return {static_cast<Interpolation>(static_cast<int>(numbers[0])),
          static_cast<Extension>(static_cast<int>(numbers[1])), numbers[2] != 0.0f};
}

}  // namespace komorebi
