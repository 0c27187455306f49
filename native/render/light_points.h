#pragma once

#include <vector>

#include "render/surface_batch.h"

namespace komorebi {

/// Where the light rays of some surfaces leave, as arrays: rays that are lifted (core/terminator.h)
/// leave points of their own, which follow their surface's, so that all are traced with their
/// neighbours.
class LightPoints {
 public:
  /// Makes room for at most so many rays, of at most as many surfaces.
  void clear(std::size_t rays) {
    count_ = ray_count_ = 0;
    if (places_.size() >= rays) return;
    places_.resize(rays);
    first_ray_.resize(2 * rays + 1);
    for (auto& column : floats_) column.resize(2 * rays);
    for (auto& column : words_) column.resize(2 * rays);
  }

  /// A surface's own point; its rays are pushed next.
  void begin(const SurfaceBatch& surfaces, std::uint32_t surface) {
    begin(surfaces.leaving_origin(surface), surfaces.time(surface), surfaces.instance(surface),
          surfaces.primitive(surface));
  }
  /// A point of a single ray. One that goes below its own triangle (`below`) has to pass over its
  /// edge.
  void begin_lifted(const SurfaceBatch& surfaces, std::uint32_t surface, float share, bool below) {
    begin(surfaces.leaving_origin(surface) + share * surfaces.lift(surface), surfaces.time(surface),
          below ? kNone : surfaces.instance(surface), below ? kNone : surfaces.primitive(surface));
  }
  void push_ray(std::uint32_t place) { places_[ray_count_++] = place; }

  /// Lends `bundles` everything but directions and lengths.
  void lend(RayBundles& bundles) {
    first_ray_[count_] = ray_count_;
    bundles.point_count = count_;
    bundles.origin_x = floats_[0].data();
    bundles.origin_y = floats_[1].data();
    bundles.origin_z = floats_[2].data();
    bundles.time = floats_[3].data();
    bundles.self_instance = words_[0].data();
    bundles.self_primitive = words_[1].data();
    bundles.first_ray = first_ray_.data();
    bundles.place = places_.data();
  }

 private:
  void begin(const Vec3& origin, float time, std::uint32_t instance, std::uint32_t primitive) {
    const float f[4] = {origin.x, origin.y, origin.z, time};
    for (std::size_t c = 0; c < 4; ++c) floats_[c][count_] = f[c];
    words_[0][count_] = instance;
    words_[1][count_] = primitive;
    first_ray_[count_++] = ray_count_;
  }

  std::uint32_t count_ = 0, ray_count_ = 0;
  std::vector<float> floats_[4];                              // origin and time
  std::vector<std::uint32_t> words_[2], first_ray_, places_;  // instance and primitive
};

}  // namespace komorebi
