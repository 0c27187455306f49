#pragma once

#include <numeric>
#include <vector>

#include "render/surface_batch.h"

namespace komorebi {

/// Rays that leave places of their own above their points (core/terminator.h), as arrays.
class LiftedRays {
 public:
  void clear() {
    for (auto& column : origin_) column.clear();
    for (auto* column : {&instance_, &primitive_, &places_}) column->clear();
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(places_.size()); }
  /// Where the rays' directions stand.
  const std::vector<std::uint32_t>& places() const { return places_; }

  /// A ray that goes below its own triangle (`below`) has to pass over its edge.
  void push(const SurfaceBatch& surfaces, std::uint32_t surface, std::uint32_t place, float share,
            bool below) {
    const Vec3 origin =
        surfaces.leaving_origin(surface) + share * surfaces.terminator(surface).lift;
    for (int c = 0; c < 3; ++c) origin_[c].push_back(origin[c]);
    origin_[3].push_back(surfaces.time(surface));
    instance_.push_back(below ? kNone : surfaces.instance(surface));
    primitive_.push_back(below ? kNone : surfaces.primitive(surface));
    places_.push_back(place);
  }

  /// Lends `bundles` everything but directions and lengths.
  void lend(RayBundles& bundles) {
    if (first_ray_.size() <= size()) {
      first_ray_.resize(std::size_t{size()} + 1);
      std::iota(first_ray_.begin(), first_ray_.end(), 0u);
    }
    bundles.point_count = size();
    bundles.origin_x = origin_[0].data();
    bundles.origin_y = origin_[1].data();
    bundles.origin_z = origin_[2].data();
    bundles.time = origin_[3].data();
    bundles.self_instance = instance_.data();
    bundles.self_primitive = primitive_.data();
    bundles.first_ray = first_ray_.data();
    bundles.place = places_.data();
  }

 private:
  std::vector<float> origin_[4];  // xyz and time
  std::vector<std::uint32_t> instance_, primitive_, places_, first_ray_;
};

}  // namespace komorebi
