#pragma once

#include <vector>

#include "core/vector.h"
#include "parallel/cancel.h"
#include "parallel/thread_pool.h"
#include "render/context.h"
#include "shader/program.h"

namespace komorebi {

/// What a camera ray sees of the world.
Vec3 world_radiance(const RenderContext& context, const Vec3& direction);

/// Runs a world's program, of which the first three outputs are radiance, in some directions
/// (world space, unit), at most Program::kLanes of them. What is not finite becomes black, negative
/// channels 0, as in maps.
void run_world(const Program& program, Program::Scratch& scratch, const Vec3* directions,
               std::uint32_t count, Vec3* radiance);

/// The first `count` outputs of a world's program in a direction: what it says for shader AOVs.
void world_values(const Program& program, const Vec3& direction, std::uint32_t count,
                  float* values);

/// The largest channel of what a world's program says in some thousand directions.
float brightest(const Program& program);

/// What a world's program says in the directions of an equirectangular map's texel centres: the
/// map's texels [height][width][3], row 0 at the bottom. The same for any number of threads.
/// @throws Cancelled
std::vector<float> world_texels(const Program& program, std::uint32_t width, std::uint32_t height,
                                ThreadPool& pool, const Cancel& cancel);

}  // namespace komorebi
