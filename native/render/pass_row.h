#pragma once

#include "render/context.h"
#include "render/film.h"
#include "render/material.h"

namespace komorebi {

/// The row of floats that a camera sample leaves for the passes (PassLayout), as it is when the
/// sample has seen nothing.
void clear_row(const PassLayout& layout, float* row);

/// What is known of a surface in view before it is lit; `normal` and `depth` are its own.
void put_surface(const RenderContext& context, const Hit& hit, const Ray& ray, const Vec3& normal,
                 float depth, const Shading& shading, std::uint32_t sample, float* row);

/// What the hit's material says for shader AOVs, where it is the same all over it
/// (material_values.h: where it is not): part of put_surface, and all that a holdout leaves, as in
/// Cycles.
void put_values(const RenderContext& context, const Hit& hit, float* row);

/// What the world says for shader AOVs where there is nothing else.
void put_world_values(const RenderContext& context, const Vec3& direction, float* row);

/// Where values stand in a row, PassLayout::values of them.
float* row_of_values(const PassLayout& layout, float* row);

/// The world that a camera ray sees.
void put_environment(const RenderContext& context, const Vec3& direction, float* row);

/// What of the picture is no shadow catcher.
void put_matte(const PassLayout& layout, const PixelSample& sample, float* row);

}  // namespace komorebi
