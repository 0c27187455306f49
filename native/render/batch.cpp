#include "render/batch.h"

#include <algorithm>

#include "bvh/traverse.h"
#include "render/light.h"
#include "render/one_ray.h"

namespace komorebi {
namespace {

constexpr std::size_t kPathsPerBatch = 4096;
// Bounds what is traced between two looks at the cancel flag to a few milliseconds.
constexpr std::uint32_t kLightRaysPerBatch = 8192;

}  // namespace

void BatchIntegrator::start(const Rect& tile, std::size_t begin, std::size_t end,
                            std::uint32_t sample) {
  paths_.clear();
  camera_rays_.clear();
  for (std::size_t i = begin; i < end; ++i) {
    const auto pixel = static_cast<std::uint32_t>(i);
    const std::uint32_t x = tile.x_min + pixel % tile.width();
    const std::uint32_t y = tile.y_min + pixel / tile.width();
    paths_.push_back({x, y, pixel});
    camera_rays_.push(start_ray(context_, x, y, sample));
  }
  hits_.resize(paths_.size());
  intersect(context_.scene, camera_rays_.span(), hits_.data());
  rays_ += paths_.size();
}

void BatchIntegrator::shade() {
  points_.resize(paths_.size());
  results_.resize(paths_.size());
  const RaySpan rays = camera_rays_.span();
  for (std::uint32_t i = 0; i < paths_.size(); ++i) {
    const Ray ray = rays[i];
    if (!hits_[i].valid()) {
      results_[i] = background(context_, ray.direction);
      continue;
    }
    points_[i] = surface_point(context_.scene, hits_[i], ray);
    results_[i] = seen_surface(context_, points_[i]);
  }
}

bool BatchIntegrator::light(std::uint32_t sample, const Cancel& cancel) {
  const RaySpan rays = camera_rays_.span();
  for (std::uint32_t i = 0; i < paths_.size(); ++i) {
    if (!hits_[i].valid()) continue;
    const Sampler sampler(context_.seed, paths_[i].x, paths_[i].y);
    for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
      const LightSample drawn =
          sample_light(context_, points_[i], sampler, sample * context_.light_samples + j);
      if (drawn.contribution == Vec3(0.0f)) continue;
      light_rays_.push(light_ray(context_, points_[i], hits_[i], drawn.direction, rays.time[i]));
      contributions_.push_back(drawn.contribution);
      light_owners_.push_back(i);
      if (light_rays_.size() == kLightRaysPerBatch) {
        flush_light();
        if (cancel.raised()) return false;
      }
    }
  }
  flush_light();
  for (std::uint32_t i = 0; i < paths_.size(); ++i) {
    if (hits_[i].valid()) results_[i].radiance /= static_cast<float>(context_.light_samples);
  }
  return !cancel.raised();
}

void BatchIntegrator::flush_light() {
  const std::uint32_t count = light_rays_.size();
  occluded_bits_.resize((count + 31) / 32);
  occluded(context_.scene, light_rays_.span(), occluded_bits_.data());
  rays_ += count;
  for (std::uint32_t k = 0; k < count; ++k) {  // in the order drawn: sums are in floats
    if (!((occluded_bits_[k / 32] >> (k % 32)) & 1u)) {
      results_[light_owners_[k]].radiance += contributions_[k];
    }
  }
  light_rays_.clear();
  contributions_.clear();
  light_owners_.clear();
}

bool BatchIntegrator::render(const Rect& tile, std::uint32_t first, std::uint32_t count,
                             const Film& film, TileSums& sums, const Cancel& cancel) {
  sums.reset(tile.area());
  for (std::uint32_t sample = first; sample < first + count; ++sample) {
    for (std::size_t begin = 0; begin < tile.area(); begin += kPathsPerBatch) {
      if (cancel.raised()) return false;
      start(tile, begin, std::min(tile.area(), begin + kPathsPerBatch), sample);
      shade();
      if (!light(sample, cancel)) return false;
      for (std::size_t i = 0; i < paths_.size(); ++i) {
        film.add(sums, paths_[i].pixel, sample, results_[i]);
      }
    }
  }
  sums.samples = count;
  return true;
}

}  // namespace komorebi
