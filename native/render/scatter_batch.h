#pragma once

#include <vector>

#include "render/ray_batch.h"
#include "render/ray_order.h"
#include "render/scatter_kernel.h"
#include "render/surface_batch.h"

namespace komorebi {

/// A path on its way from one vertex to the next.
struct PathState {
  std::uint32_t path, pixel_seed, sample;
  Vec3 throughput;
  Vec3 normal;  ///< of the surface that its ray has left
};

/// Lets paths go on from the surfaces of a vertex. Its arrays grow once.
class ScatterBatch {
 public:
  /// For so many surfaces, at all of which paths end unless they are set.
  void clear(std::uint32_t surfaces);
  /// Lets a path go on from a surface; `throughput` includes the surface's albedo.
  void set(std::uint32_t surface, std::uint32_t path, std::uint32_t sample,
           const Vec3& throughput) {
    path_[surface] = path;
    sample_[surface] = sample;
    for (int c = 0; c < 3; ++c) floats_[c][surface] = throughput[c];
  }
  /// The rays of the paths that go on, in an order that they are well traced in (RayOrder).
  void scatter(const RenderContext& context, std::uint32_t vertex, const SurfaceBatch& surfaces,
               RayBatch& rays, std::vector<PathState>& states);

 private:
  ScatterBlock block(const SurfaceBatch& surfaces);
  /// Surfaces that paths go on from, in the order that their rays are best traced in.
  const std::vector<std::uint32_t>& going_on(const SurfaceBatch& surfaces);

  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> path_, sample_, goes_on_, path_key_;
  std::vector<float> floats_[6];     // throughput, direction
  std::vector<std::uint32_t> from_;  // surfaces of the rays that are put in order
  std::vector<float> ordered_[6];    // their origins and directions
  RayOrder order_;
};

}  // namespace komorebi
