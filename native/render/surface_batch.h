#pragma once

#include <vector>

#include "core/ray_bundles.h"
#include "render/light.h"
#include "render/light_kernel.h"
#include "render/surface_kernel.h"

namespace komorebi {

/// Owns the arrays behind a SurfaceBlock: the surfaces that a batch of camera rays has hit, and
/// where their light rays stand in their pixels' sequences. Grows once.
class SurfaceBatch {
 public:
  void clear(std::uint32_t capacity) {
    count_ = 0;
    const std::size_t size = std::size_t{capacity} + kPadding;
    if (path_.size() >= size) return;
    for (auto* column : {&path_, &pixel_seed_, &first_index_, &instance_, &primitive_}) {
      column->resize(size);
    }
    for (auto& column : floats_) column.resize(size);
  }

  std::uint32_t size() const { return count_; }
  std::uint32_t path(std::uint32_t i) const { return path_[i]; }
  float depth(std::uint32_t i) const { return floats_[9][i]; }
  Vec3 normal(std::uint32_t i) const { return vector(0, i); }
  Vec3 geometric_normal(std::uint32_t i) const { return vector(3, i); }
  float time(std::uint32_t i) const { return floats_[10][i]; }
  std::uint32_t instance(std::uint32_t i) const { return instance_[i]; }
  std::uint32_t primitive(std::uint32_t i) const { return primitive_[i]; }
  /// When the context has any (fill).
  const Terminator& terminator(std::uint32_t i) const { return terminators_[i]; }
  Vec3 leaving_origin(std::uint32_t i) const { return vector(6, i); }

  void push(std::uint32_t path, const Hit& hit, float time, std::uint32_t pixel_seed,
            std::uint32_t first_index) {
    path_[count_] = path;
    instance_[count_] = hit.instance;
    primitive_[count_] = hit.primitive;
    floats_[10][count_] = time;
    pixel_seed_[count_] = pixel_seed;
    first_index_[count_++] = first_index;
  }

  /// Works out the points of all.
  void fill(const RenderContext& context, const Hit* hits, const RaySpan& rays) {
    SurfaceBlock block{};
    block.count = count_;
    block.path = path_.data();
    block.hits = hits;
    block.rays = rays;
    for (std::size_t c = 0; c < 3; ++c) {
      block.normal[c] = floats_[c].data();
      block.geometric_normal[c] = floats_[3 + c].data();
      block.leaving_origin[c] = floats_[6 + c].data();
    }
    block.depth = floats_[9].data();
    surface_points(context, block);
    terminators_.clear();
    if (!context.has_terminators) return;
    for (std::uint32_t i = 0; i < count_; ++i) {
      terminators_.push_back(
          komorebi::terminator(context, hits[path_[i]], rays.time[path_[i]], geometric_normal(i)));
    }
    if (!context.bends_round) return;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::uint32_t i = 0; i < count_; ++i) {
        floats_[11 + c][i] = floats_[(terminators_[i].cutoff > 0.0f ? 0 : 3) + c][i];
      }
    }
  }

  /// Lends `bundles` points [begin, end), which their light rays leave.
  void lend(RayBundles& bundles, std::uint32_t begin, std::uint32_t end) const {
    bundles.point_count = end - begin;
    bundles.origin_x = &floats_[6][begin];
    bundles.origin_y = &floats_[7][begin];
    bundles.origin_z = &floats_[8][begin];
    bundles.time = &floats_[10][begin];
    bundles.self_instance = &instance_[begin];
    bundles.self_primitive = &primitive_[begin];
  }

  /// For the light rays of points [begin, end).
  LightBlock light_block(const RenderContext& context, std::uint32_t begin,
                         std::uint32_t end) const {
    LightBlock block{};
    block.point_count = end - begin;
    for (std::size_t c = 0; c < 3; ++c) {
      block.normal[c] = &floats_[c][begin];
      block.geometric_normal[c] = &floats_[(context.bends_round ? 11 : 3) + c][begin];
    }
    block.pixel_seed = &pixel_seed_[begin];
    block.first_index = &first_index_[begin];
    return block;
  }

 private:
  static constexpr std::size_t kPadding = 16;

  Vec3 vector(std::size_t first, std::uint32_t i) const {
    return Vec3(floats_[first][i], floats_[first + 1][i], floats_[first + 2][i]);
  }

  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> path_, pixel_seed_, first_index_, instance_, primitive_;
  std::vector<Terminator> terminators_;
  // normal, geometric normal, leaving origin, depth, time, and the normal above which light comes
  std::vector<float> floats_[14];
};

}  // namespace komorebi
