#pragma once

#include "core/vector.h"

namespace komorebi::node {

/// The colour of a black body, linear Rec. 709 of luminance 1, as Cycles fits it by parts between
/// 800 and 12000 kelvin. Channels out of gamut are 0.
Vec3 blackbody(float kelvin);

/// The colour of light of one wavelength (CIE 1931, 2°), linear Rec. 709, scaled as Cycles does so
/// that no channel is above 1. @param nanometres  from 380 to 780; black otherwise
Vec3 wavelength(float nanometres);

}  // namespace komorebi::node
