#pragma once

#include <cstdint>

#include "parallel/cancel.h"
#include "parallel/thread_pool.h"
#include "render/context.h"

namespace komorebi {

/// How many light rays a camera sample casts where the settings leave it open: those with which a
/// picture is good soonest. Many of them share the camera ray, its hit point and the tracer's
/// bundles; but where neighbouring camera samples differ whatever the light rays tell (surfaces
/// smaller than a pixel, shadows of a sun), fewer of them leave time for more camera samples.
///
/// Measured from what samples of a pixel differ by, with four light rays each and with eight, in
/// some pixels of the full frame: a function of the scene, the camera and the method alone, the
/// same for every seed, border and part of a picture. Where the context's seed and light_samples
/// lie does not matter.
///
/// With bounces most of a sample's time and noise lie elsewhere, and down to one ray is tried.
///
/// @returns kAutomaticLightSamples or half of it, with bounces also less; the former for frames too
/// small to tell, and
///          when cancelled
std::uint32_t choose_light_samples(const RenderContext& context, ThreadPool& pool,
                                   const Cancel& cancel);

}  // namespace komorebi
