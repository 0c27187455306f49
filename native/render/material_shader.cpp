#include "render/material_shader.h"

#include <algorithm>
#include <cmath>

namespace komorebi {
namespace {

constexpr std::uint32_t kLanes = Program::kLanes;

/// Not negative and finite; 0 else, as nothing is lit by what is not a number.
float weight_of(float x) {
  return x > 0.0f && std::isfinite(x) ? x : 0.0f;
}

float mean(const Vec3& v) {
  return (v.x + v.y + v.z) * (1.0f / 3.0f);
}

/// A column's outputs at one point.
struct Outputs {
  float* const* rows;
  std::uint32_t lane;

  Vec3 weight(std::uint32_t first) const {
    return Vec3(weight_of(rows[first][lane]), weight_of(rows[first + 1][lane]),
                weight_of(rows[first + 2][lane]));
  }
  Vec3 vector(std::uint32_t first) const {
    return Vec3(rows[first][lane], rows[first + 1][lane], rows[first + 2][lane]);
  }
};

/// One lobe in proportion to what it reflects, chosen by u.
Shading choose(const SurfaceProgram& surface, const Outputs& at, float u, ChosenLobe& lobe_chosen) {
  Shading shading;
  shading.albedo = shading.color = Vec3(0.0f);
  // What has met the surface was not let through: the weights are those of the rest.
  const float solid = 1.0f - clear_share(at.vector(SurfaceProgram::kTransparency));
  const float scale = solid > 0.0f ? 1.0f / solid : 0.0f;
  shading.emission = scale * at.weight(SurfaceProgram::kEmission);
  shading.holdout = std::min(scale * weight_of(at.rows[SurfaceProgram::kHoldout][at.lane]), 1.0f);
  float total = 0.0f;
  for (const SurfaceLobe& lobe : surface.lobes) {
    const Vec3 weight = scale * at.weight(lobe.weight);
    if (!lobe.transmits) shading.color += weight;
    total += mean(weight);
  }
  if (!(total > 0.0f)) return shading;
  float position = u * total;
  const SurfaceLobe* chosen = nullptr;
  float share = 0.0f;
  for (const SurfaceLobe& lobe : surface.lobes) {
    const float own = mean(scale * at.weight(lobe.weight));
    if (!(own > 0.0f)) continue;
    chosen = &lobe;
    share = own;
    if (position < own) break;
    position -= own;
  }
  const Vec3 weight = scale * at.weight(chosen->weight);
  shading.albedo = share == total ? weight : weight * (total / share);
  lobe_chosen.transmits = chosen->transmits;
  if (chosen->normal != kNone) {
    lobe_chosen.normal = detail::unit_or(at.vector(chosen->normal), lobe_chosen.normal);
  }
  return shading;
}

}  // namespace

void MaterialShader::shade(const RenderContext& context, std::span<ShadeTask> tasks,
                           Shading* shadings) {
  for (std::size_t begin = 0; begin < tasks.size();) {
    const std::uint32_t index = tasks[begin].material;
    const std::uint32_t vertex = tasks[begin].vertex;
    std::size_t end = begin + 1;
    while (end < tasks.size() && end - begin < kLanes && tasks[end].material == index) ++end;
    const SurfaceProgram& surface = context.tables->surface(index).of_vertex(vertex);
    if (!surface.program) {  // a surface without a material
      std::fill(shadings + begin, shadings + end,
                Shading{context.clay_albedo, Vec3(0.0f), context.clay_albedo, 0.0f});
      begin = end;
      continue;
    }
    float* const* rows =
        run_.run(context, *surface.program, &tasks[begin], static_cast<std::uint32_t>(end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      ShadeTask& task = tasks[i];
      const bool draws = surface.lobes.size() > 1;
      const Sampler sampler(task.pixel_seed);
      const float u =
          draws ? sampler.sample_1d(vertex_dimension(vertex, kVertexLobe), task.sample) : 0.0f;
      ChosenLobe lobe{task.point.normal, false};
      shadings[i] = choose(surface, {rows, static_cast<std::uint32_t>(i - begin)}, u, lobe);
      task.point.normal = lobe.transmits ? -lobe.normal : lobe.normal;
      if (lobe.transmits) task.point.geometric_normal = -task.point.geometric_normal;
    }
    begin = end;
  }
}

void MaterialShader::clear_shares(const RenderContext& context, const Program& program,
                                  const ShadeTask* tasks, std::uint32_t count, float* shares) {
  float* const* rows = run_.run(context, program, tasks, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    shares[i] = clear_share(Outputs{rows, i}.vector(0));
  }
}

}  // namespace komorebi
