#pragma once

#include <functional>

#include "bench/made_meshes.h"
#include "bench/views.h"
#include "core/environment.h"
#include "core/ray_bundles.h"

namespace komorebi::bench {

/// Occlusion rays that leave places, in chunks of at most kChunk rays (or one place), each as a
/// RayBundles of its own: what one call of the tracer gets, and one piece of work for a thread.
/// The same rays, one after the other, are in `list`.
class RaySet {
 public:
  static constexpr std::uint32_t kChunk = 4096;

  /// `direction(place, k)` is ray k's of `count` rays that leave a place.
  RaySet(const std::vector<Place>& from, std::uint32_t count, float t_max,
         const std::function<Vec3(const Place&, std::uint32_t)>& direction)
      : count_(count), points_a_chunk_(std::max(1u, kChunk / count)) {
    for (const Place& place : from) {
      for (int axis = 0; axis < 3; ++axis) origin_[axis].push_back(place.origin[axis]);
      instance_.push_back(place.instance);
      primitive_.push_back(place.primitive);
      for (std::uint32_t k = 0; k < count; ++k) {
        Ray ray;
        ray.origin = place.origin;
        ray.direction = direction(place, k);
        ray.t_max = t_max;
        ray.self_instance = place.instance;
        ray.self_primitive = place.primitive;
        list.push_back(ray);
      }
    }
    time_.assign(from.size(), 0.0f);
    for (std::uint32_t p = 0; p <= points_a_chunk_; ++p) first_ray_.push_back(p * count);
  }

  testing::RayList list;

  std::uint32_t chunk_count() const {
    const auto points = static_cast<std::uint32_t>(instance_.size());
    return (points + points_a_chunk_ - 1) / points_a_chunk_;
  }
  std::uint32_t first_ray(std::uint32_t chunk) const { return chunk * points_a_chunk_ * count_; }
  std::uint32_t end_ray(std::uint32_t chunk) const {
    return std::min(list.size(), first_ray(chunk + 1));
  }
  std::uint32_t rays_a_point() const { return count_; }

  RaySpan span(std::uint32_t chunk) const {
    return list.span(first_ray(chunk), end_ray(chunk) - first_ray(chunk));
  }

  RayBundles bundles(std::uint32_t chunk) const {
    const std::uint32_t p = chunk * points_a_chunk_;
    const RaySpan rays = span(chunk);
    RayBundles b{};
    b.origin_x = origin_[0].data() + p;
    b.origin_y = origin_[1].data() + p;
    b.origin_z = origin_[2].data() + p;
    b.time = time_.data() + p;
    b.self_instance = instance_.data() + p;
    b.self_primitive = primitive_.data() + p;
    b.first_ray = first_ray_.data();
    b.point_count = rays.count / count_;
    b.mask = kMaskAll;
    b.direction_x = rays.direction_x;
    b.direction_y = rays.direction_y;
    b.direction_z = rays.direction_z;
    b.t_max = rays.t_max;
    return b;
  }

 private:
  std::uint32_t count_, points_a_chunk_;
  std::vector<float> origin_[3], time_;
  std::vector<std::uint32_t> instance_, primitive_, first_ray_;
};

/// The camera rays themselves, each from a place of its own.
inline RaySet camera_set(const testing::RayList& camera) {
  std::vector<Place> eyes(camera.size());
  for (std::uint32_t i = 0; i < camera.size(); ++i) {
    eyes[i] = {camera[i].origin, Vec3(0.0f), kNone, kNone};
  }
  const Place* first = eyes.data();
  return RaySet(eyes, 1, kFloatMax, [&, first](const Place& eye, std::uint32_t) {
    return camera[static_cast<std::uint32_t>(&eye - first)].direction;
  });
}

/// Cosine-distributed rays, stratified over the elevation.
inline RaySet ambient_set(const std::vector<Place>& from, std::uint32_t count, float reach) {
  Numbers number;
  return RaySet(from, count, reach, [&](const Place& place, std::uint32_t k) {
    const Vec3 n = place.normal;
    const Vec3 side =
        glm::normalize(glm::cross(n, std::abs(n.x) < 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    const float u = (float(k) + number.next()) / float(count);
    const float phi = 6.2831853f * number.next();
    return std::sqrt(u) * (std::cos(phi) * side + std::sin(phi) * glm::cross(n, side)) +
           std::sqrt(1.0f - u) * n;
  });
}

/// Rays drawn from a map by its brightness, those above the surface; a place that sees none of the
/// map's bright parts in 64 draws gets the last one mirrored to its upper side.
inline RaySet environment_set(const std::vector<Place>& from, std::uint32_t count,
                              const EnvironmentView& map) {
  Numbers number;
  return RaySet(from, count, kFloatMax, [&](const Place& place, std::uint32_t) {
    Vec3 direction(0.0f);
    for (int draw = 0; draw < 64; ++draw) {
      const std::uint32_t x = number.bits(), y = number.bits();
      direction = sample_environment(map, {x, y}).direction;
      if (glm::dot(direction, place.normal) > 0.0f) return direction;
    }
    return direction - 2.0f * glm::dot(direction, place.normal) * place.normal;
  });
}

}  // namespace komorebi::bench
