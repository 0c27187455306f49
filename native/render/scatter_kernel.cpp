#include "render/scatter_kernel.h"

#include "bvh/kernel.h"
#include "render/scatter.h"

namespace komorebi {
namespace {

Vec3 entry(const float* const (&columns)[3], std::size_t i) {
  return Vec3(columns[0][i], columns[1][i], columns[2][i]);
}

void set_entry(float* const (&columns)[3], std::size_t i, const Vec3& v) {
  for (int c = 0; c < 3; ++c) columns[c][i] = v[c];
}

void scatter_scalar(const RenderContext& context, std::uint32_t vertex, const ScatterBlock& block) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    ScatterPoint point;
    point.normal = entry(block.normal, i);
    point.geometric_normal = entry(block.geometric_normal, i);
    if (context.cuts_cosines) point.frequency = block.frequency[i];
    Vec3 throughput = entry(block.throughput, i);
    Ray ray;
    const bool goes_on = scatter(context, vertex, point, Sampler(block.pixel_seed[i]),
                                 block.sample[i], throughput, ray);
    block.goes_on[i] = goes_on ? 1 : 0;
    set_entry(block.throughput, i, throughput);
    set_entry(block.direction, i, ray.direction);
    block.path_key[i] = ray.path_key;
  }
}

void cut_cosines(const ScatterBlock& block) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    if (block.goes_on[i] == 0 || !(block.frequency[i] > 1.0f)) continue;
    Vec3 throughput = entry(block.throughput, i);
    if (!cut_scattered(block.frequency[i], entry(block.normal, i), entry(block.direction, i),
                       throughput)) {
      block.goes_on[i] = 0;
    }
    set_entry(block.throughput, i, throughput);
  }
}

}  // namespace

void scatter_all(const RenderContext& context, std::uint32_t vertex, const ScatterBlock& block) {
  const int kernel = active_kernel_index();
  if (kernel < 0) return scatter_scalar(context, vertex, block);
  kSimdScatterKernels[kernel]->scatter(vertex, block);
  if (context.cuts_cosines) cut_cosines(block);
}

}  // namespace komorebi
