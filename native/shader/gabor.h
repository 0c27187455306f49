#pragma once

namespace komorebi {

/// A sum of waves under bells, as a complex number.
struct Phasor {
  float re = 0.0f, im = 0.0f;
};

/// Gabor noise in two dimensions (Lagae et al. 2009; Tavernier et al. 2019; as a phasor, Tricard et
/// al. 2019): eight waves in each cell.
/// @param isotropy     how far waves turn away from `orientation`, 0 to 1
/// @param orientation  in radians
Phasor gabor_2d(const float (&p)[2], float frequency, float isotropy, float orientation);

/// In three; `orientation` has length 1.
Phasor gabor_3d(const float (&p)[3], float frequency, float isotropy,
                const float (&orientation)[3]);

}  // namespace komorebi
