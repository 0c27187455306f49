#include "render/scatter_batch.h"

#include <algorithm>

namespace komorebi {
namespace {

constexpr std::size_t kBlockPadding = 16;  ///< a ScatterBlock's

}  // namespace

void ScatterBatch::clear(std::uint32_t surfaces) {
  count_ = surfaces;
  const std::size_t size = surfaces + kBlockPadding;
  if (path_.size() < size) {
    for (auto* column : {&path_, &sample_, &goes_on_, &path_key_, &from_}) column->resize(size);
    for (auto& column : floats_) column.resize(size);
    for (auto& column : ordered_) column.resize(size);
  }
  for (int c = 0; c < 3; ++c) std::fill_n(floats_[c].begin(), count_, 0.0f);
}

ScatterBlock ScatterBatch::block(const SurfaceBatch& surfaces) {
  ScatterBlock block = surfaces.scatter_block();
  block.sample = sample_.data();
  block.goes_on = goes_on_.data();
  block.path_key = path_key_.data();
  for (std::size_t c = 0; c < 3; ++c) {
    block.throughput[c] = floats_[c].data();
    block.direction[c] = floats_[3 + c].data();
  }
  return block;
}

const std::vector<std::uint32_t>& ScatterBatch::going_on(const SurfaceBatch& surfaces) {
  std::uint32_t count = 0;
  for (std::uint32_t s = 0; s < count_; ++s) {
    from_[count] = s;
    const Vec3 origin = surfaces.leaving_origin(s);
    for (std::size_t c = 0; c < 3; ++c) {
      ordered_[c][count] = origin[static_cast<int>(c)];
      ordered_[3 + c][count] = floats_[3 + c][s];
    }
    count += goes_on_[s];
  }
  RaySpan rays{};
  rays.count = count;
  rays.origin_x = ordered_[0].data();
  rays.origin_y = ordered_[1].data();
  rays.origin_z = ordered_[2].data();
  rays.direction_x = ordered_[3].data();
  rays.direction_y = ordered_[4].data();
  rays.direction_z = ordered_[5].data();
  return order_.sort(rays);
}

void ScatterBatch::scatter(const RenderContext& context, std::uint32_t vertex,
                           const SurfaceBatch& surfaces, RayBatch& rays,
                           std::vector<PathState>& states) {
  scatter_all(context, vertex, block(surfaces));
  const std::vector<std::uint32_t>& order = going_on(surfaces);
  const auto count = static_cast<std::uint32_t>(order.size());
  rays.resize(count, 0);
  states.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t i = order[k], s = from_[i];
    for (std::size_t c = 0; c < 6; ++c) rays.floats(c)[k] = ordered_[c][i];
    rays.floats(8)[k] = surfaces.time(s);
    rays.words(1)[k] = surfaces.instance(s);
    rays.words(2)[k] = surfaces.primitive(s);
    rays.words(3)[k] = path_key_[s];
    states[k] = {path_[s], surfaces.pixel_seed(s), sample_[s],
                 Vec3(floats_[0][s], floats_[1][s], floats_[2][s]), surfaces.normal(s)};
  }
  std::fill_n(rays.floats(6), count, 0.0f);
  std::fill_n(rays.floats(7), count, context.light_distance);  // beyond, there is only sky
  std::fill_n(rays.words(0), count, context.scatter_mask);
}

}  // namespace komorebi
