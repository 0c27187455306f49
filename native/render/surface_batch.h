#pragma once

#include <vector>

#include "core/ray_bundles.h"
#include "render/light.h"
#include "render/light_kernel.h"
#include "render/material.h"
#include "render/scatter_kernel.h"
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
  std::uint32_t pixel_seed(std::uint32_t i) const { return pixel_seed_[i]; }
  /// Of its light rays in their pixel's sequence: sample · light_samples.
  std::uint32_t first_index(std::uint32_t i) const { return first_index_[i]; }
  float depth(std::uint32_t i) const { return floats_[9][i]; }
  Vec3 normal(std::uint32_t i) const { return vector(0, i); }
  Vec3 geometric_normal(std::uint32_t i) const { return vector(3, i); }
  float time(std::uint32_t i) const { return floats_[10][i]; }
  std::uint32_t instance(std::uint32_t i) const { return instance_[i]; }
  std::uint32_t primitive(std::uint32_t i) const { return primitive_[i]; }
  /// The terminator, when the context has any (fill).
  Vec3 lift(std::uint32_t i) const { return vector(14, i); }
  float cutoff(std::uint32_t i) const { return floats_[17][i]; }
  float frequency(std::uint32_t i) const { return floats_[18][i]; }
  Vec3 leaving_origin(std::uint32_t i) const { return vector(6, i); }

  void make_room_for_shading() {
    for (auto& column : shading_) {
      if (column.size() < path_.size()) column.resize(path_.size());
    }
  }
  void set_shading(std::uint32_t i, const Shading& shading) {
    for (int c = 0; c < 3; ++c) {
      const auto column = static_cast<std::size_t>(c);
      shading_[column][i] = shading.albedo[c];
      shading_[3 + column][i] = shading.emission[c];
      shading_[6 + column][i] = shading.color[c];
    }
    shading_[9][i] = shading.holdout;
  }
  /// A surface that its material has given another normal, or turned to its other side.
  void set_point(const RenderContext& context, std::uint32_t i, const SurfacePoint& point,
                 const Terminator& terminator) {
    set_vector(0, i, point.normal);
    set_vector(3, i, point.geometric_normal);
    set_vector(6, i, komorebi::leaving_origin(point));
    if (!context.has_terminators) return;
    set_vector(14, i, terminator.lift);
    floats_[17][i] = terminator.cutoff;
    floats_[18][i] = terminator.frequency;
    if (!context.bends_round) return;
    set_vector(11, i, terminator.cutoff > 0.0f ? point.normal : point.geometric_normal);
  }
  /// Where surfaces have materials.
  SurfacePoint point(std::uint32_t i) const {
    SurfacePoint point;
    point.position = vector(19, i);
    point.geometric_normal = geometric_normal(i);
    point.normal = normal(i);
    point.offset = floats_[22][i];
    return point;
  }
  /// What shade_surfaces has set.
  Vec3 albedo(std::uint32_t i) const {
    return Vec3(shading_[0][i], shading_[1][i], shading_[2][i]);
  }
  Shading shading(std::uint32_t i) const {
    const auto vector_at = [&](std::size_t first) {
      return Vec3(shading_[first][i], shading_[first + 1][i], shading_[first + 2][i]);
    };
    return {vector_at(0), vector_at(3), vector_at(6), shading_[9][i]};
  }

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
    for (std::size_t c = 0; c < 3; ++c) block.position[c] = floats_[19 + c].data();
    block.offset = floats_[22].data();
    for (std::size_t c = 0; c < 3; ++c) block.lift[c] = floats_[14 + c].data();
    block.cutoff = floats_[17].data();
    block.frequency = floats_[18].data();
    surface_points(context, block);
    if (!context.bends_round) return;
    const float* cutoff = floats_[17].data();
    for (std::size_t c = 0; c < 3; ++c) {
      float* to = floats_[11 + c].data();
      const float *bent = floats_[c].data(), *flat = floats_[3 + c].data();
      for (std::uint32_t i = 0; i < count_; ++i) to[i] = cutoff[i] > 0.0f ? bent[i] : flat[i];
    }
  }

  /// Which part of its lift a ray of each point [begin, end) starts at (core/terminator.h).
  void find_lifted_shares(std::uint32_t begin, std::uint32_t end, const Columns& direction,
                          float* share) const {
    const Columns normal = columns(0, begin), geometric = columns(3, begin);
    const float* cutoff = &floats_[17][begin];
    for (std::uint32_t p = 0; p < end - begin; ++p) {  // in vectors, so nothing is skipped
      const Vec3 d(direction.x[p], direction.y[p], direction.z[p]);
      const Vec3 n(normal.x[p], normal.y[p], normal.z[p]);
      const Vec3 g(geometric.x[p], geometric.y[p], geometric.z[p]);
      const float found = lifted_share(cutoff[p], glm::dot(d, n), glm::dot(d, g));
      share[p] = cutoff[p] > 0.0f ? found : 0.0f;
    }
  }

  /// For the light rays of points [begin, end).
  LightBlock light_block(const RenderContext& context, std::uint32_t begin,
                         std::uint32_t end) const {
    LightBlock block{};
    block.point_count = end - begin;
    for (std::size_t c = 0; c < 3; ++c) {
      block.normal[c] = &floats_[c][begin];
      block.geometric_normal[c] = &floats_[(context.bends_round ? 11 : 3) + c][begin];
      block.origin[c] = &floats_[6 + c][begin];
    }
    block.pixel_seed = &pixel_seed_[begin];
    block.first_index = &first_index_[begin];
    return block;
  }

  /// What paths that go on from all of them read of it.
  ScatterBlock scatter_block() const {
    ScatterBlock block{};
    block.count = count_;
    for (std::size_t c = 0; c < 3; ++c) {
      block.normal[c] = floats_[c].data();
      block.geometric_normal[c] = floats_[3 + c].data();
    }
    block.frequency = floats_[18].data();
    block.pixel_seed = pixel_seed_.data();
    return block;
  }

 private:
  static constexpr std::size_t kPadding = 16;

  Columns columns(std::size_t first, std::uint32_t i) const {
    return {&floats_[first][i], &floats_[first + 1][i], &floats_[first + 2][i]};
  }
  Vec3 vector(std::size_t first, std::uint32_t i) const {
    return Vec3(floats_[first][i], floats_[first + 1][i], floats_[first + 2][i]);
  }

  void set_vector(std::size_t first, std::uint32_t i, const Vec3& v) {
    for (std::size_t c = 0; c < 3; ++c) floats_[first + c][i] = v[static_cast<int>(c)];
  }

  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> path_, pixel_seed_, first_index_, instance_, primitive_;
  // normal, geometric normal, leaving origin, depth, time, the normal above which light comes, and
  // the terminator's lift, cutoff and frequency; position and offset
  std::vector<float> floats_[23];
  std::vector<float> shading_[10];  // albedo, emission, colour, holdout: once they are asked for
};

}  // namespace komorebi
