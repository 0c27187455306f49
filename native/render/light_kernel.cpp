#include "render/light_kernel.h"

#include "bvh/kernel.h"
#include "render/light.h"

namespace komorebi {
namespace {

/// Gathers read by signed 32-bit indices.
bool in_reach(const RenderContext& context) {
  const EnvironmentView& e = context.sky;
  return 3 * std::uint64_t{e.width} * e.height < (1u << 31);
}

/// Whether rays are drawn by the cosine alone, for light that is the same from everywhere.
bool is_even(const RenderContext& context) {
  return context.method == Method::kWorldLight && context.sky.width == 0 &&
         context.cosine_share == 1.0f;
}

Vec3 entry(const float* const (&columns)[3], std::size_t i) {
  return Vec3(columns[0][i], columns[1][i], columns[2][i]);
}

void sample_lights_scalar(const RenderContext& context, const LightBlock& block) {
  for (std::uint32_t p = 0; p < block.point_count; ++p) {
    SurfacePoint point;
    point.normal = entry(block.normal, p);
    point.geometric_normal = entry(block.geometric_normal, p);
    point.position = entry(block.origin, p);  // with the offset 0 it is the leaving_origin
    const Sampler sampler(block.pixel_seed[p]);
    for (std::uint32_t j = 0; j < block.rays_per_point; ++j) {
      const LightSample drawn = sample_light(context, point, sampler, block.first_index[p] + j);
      const std::size_t to = std::size_t{j} * block.stride + p;
      for (int c = 0; c < 3; ++c) {
        block.direction[c][to] = drawn.direction[c];
        block.contribution[c][to] = drawn.contribution[c];
      }
    }
  }
}

}  // namespace

void sample_lights(const RenderContext& context, const LightBlock& block) {
  const int index = active_kernel_index();
  const LightKernel* const kernel = index < 0 ? nullptr : kSimdLightKernels[index];
  if (kernel != nullptr && context.product.bins > 0 && in_reach(context)) {
    kernel->product(context, block);
  } else if (kernel != nullptr && context.method == Method::kAmbientOcclusion &&
             context.ao_sampling == AoSampling::kCosine) {
    kernel->ambient(context, block);
  } else if (kernel != nullptr && is_even(context)) {
    kernel->even(context, block);
  } else {
    sample_lights_scalar(context, block);
  }
}

}  // namespace komorebi
