#include "render/batch.h"

#include <algorithm>

#include "bvh/traverse.h"
#include "render/camera_kernel.h"
#include "render/one_ray.h"

namespace komorebi {
namespace {

constexpr std::size_t kPathsPerBatch = 4096;
/// All samples of so many pixels follow each other, then those of the next: their light rays, which
/// are traced together, leave places that lie close.
constexpr std::size_t kPixelsTogether = 64;

}  // namespace

void BatchIntegrator::start(std::size_t begin, std::size_t end, std::uint32_t first,
                            std::uint32_t samples) {
  paths_.clear();
  const auto count = static_cast<std::uint32_t>(end - begin);
  for (auto& column : starts_) column.resize(std::size_t{count} + kPadding);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t group = (begin + i) / (kPixelsTogether * samples);
    const std::size_t within = (begin + i) % (kPixelsTogether * samples);
    const std::size_t in_group =
        std::min(kPixelsTogether, pixels_.size() - group * kPixelsTogether);
    const auto pixel = static_cast<std::uint32_t>(group * kPixelsTogether + within % in_group);
    const auto sample = first + static_cast<std::uint32_t>(within / in_group);
    const Pixel& at = pixels_[pixel];
    paths_.push_back({pixel, sample});
    starts_[kColumnX][i] = at.x;
    starts_[kColumnY][i] = at.y;
    starts_[kColumnSample][i] = sample;
    starts_[kColumnSeed][i] = at.seed;
  }
  start_camera_rays(count);
  hits_.resize(paths_.size());
  intersect(context_.scene, camera_rays_.span(), hits_.data());
  rays_ += paths_.size();
}

void BatchIntegrator::start_camera_rays(std::uint32_t count) {
  camera_rays_.resize(count, kPadding);
  CameraBlock block{};
  block.count = count;
  block.x = starts_[kColumnX].data();
  block.y = starts_[kColumnY].data();
  block.sample = starts_[kColumnSample].data();
  block.pixel_seed = starts_[kColumnSeed].data();
  for (std::size_t c = 0; c < 3; ++c) {
    block.origin[c] = camera_rays_.floats(c);
    block.direction[c] = camera_rays_.floats(3 + c);
  }
  block.t_max = camera_rays_.floats(7);
  block.time = camera_rays_.floats(8);
  start_rays(context_, block);
  std::fill_n(camera_rays_.floats(6), count, 0.0f);
  std::fill_n(camera_rays_.words(0), count, kMaskCamera);
  std::fill_n(camera_rays_.words(1), count, kNone);
  std::fill_n(camera_rays_.words(2), count, kNone);
}

void BatchIntegrator::shade() {
  const RaySpan rays = camera_rays_.span();
  results_.resize(paths_.size());
  surfaces_.clear(rays.count);
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if (hits_[i].valid()) {
      surfaces_.push(i, hits_[i], rays.time[i], pixels_[paths_[i].pixel].seed,
                     paths_[i].sample * context_.light_samples);
    } else {
      results_[i] =
          background(context_, Vec3(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]));
    }
  }
  surfaces_.fill(context_, hits_.data(), rays);
  for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
    results_[surfaces_.path(s)] = seen_surface(surfaces_.normal(s), surfaces_.depth(s));
  }
}

bool BatchIntegrator::light(const Cancel& cancel) {
  const std::uint32_t size = light_block_.capacity();
  for (std::uint32_t begin = 0; begin < surfaces_.size(); begin += size) {
    if (cancel.raised()) return false;
    cast_block(begin, std::min(surfaces_.size(), begin + size));
  }
  for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
    results_[surfaces_.path(s)].radiance /= static_cast<float>(context_.light_samples);
  }
  return !cancel.raised();
}

void BatchIntegrator::cast_block(std::uint32_t begin, std::uint32_t end) {
  light_block_.draw(context_, surfaces_.light_block(begin, end));
  first_ray_.clear();
  places_.clear();
  for (std::uint32_t p = 0; p < end - begin; ++p) {
    first_ray_.push_back(static_cast<std::uint32_t>(places_.size()));
    for (std::uint32_t j = 0; j < context_.light_samples; ++j) {
      const std::uint32_t place = light_block_.place(p, j);
      if (light_block_.contribution(place) != Vec3(0.0f)) places_.push_back(place);
    }
  }
  first_ray_.push_back(static_cast<std::uint32_t>(places_.size()));

  RayBundles bundles{};
  surfaces_.lend(bundles, begin, end);
  light_block_.lend(bundles, context_.light_distance);
  bundles.first_ray = first_ray_.data();
  bundles.place = places_.data();
  bundles.mask = kMaskShadow;
  occluded_bits_.resize((places_.size() + 31) / 32);
  occluded(context_.scene, bundles, occluded_bits_.data());
  rays_ += places_.size();
  for (std::uint32_t p = 0; p < end - begin; ++p) {
    Vec3& radiance = results_[surfaces_.path(begin + p)].radiance;
    for (std::uint32_t k = first_ray_[p]; k < first_ray_[p + 1]; ++k) {
      // in the order drawn: sums are in floats
      if ((occluded_bits_[k / 32] >> (k % 32)) & 1u) continue;
      radiance += light_block_.contribution(places_[k]);
    }
  }
}

void BatchIntegrator::add_pixel(std::uint32_t x, std::uint32_t y) {
  pixels_.push_back({x, y, Sampler(context_.seed, x, y).pixel_seed});
}

template <class Visit>
bool BatchIntegrator::trace(std::uint32_t first, std::uint32_t count, const Cancel& cancel,
                            const Visit& visit) {
  const std::size_t paths = pixels_.size() * count;
  for (std::size_t begin = 0; begin < paths; begin += kPathsPerBatch) {
    if (cancel.raised()) return false;
    start(begin, std::min(paths, begin + kPathsPerBatch), first, count);
    shade();
    if (!light(cancel)) return false;
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      visit(paths_[i].pixel, paths_[i].sample, results_[i]);
    }
  }
  return true;
}

bool BatchIntegrator::render(Cells cells, std::uint32_t first, std::uint32_t count,
                             const Film& film, TileSums& sums, const Cancel& cancel) {
  pixels_.clear();
  for (const Rect& cell : cells) {
    for (std::uint32_t y = cell.y_min; y < cell.y_max; ++y) {
      for (std::uint32_t x = cell.x_min; x < cell.x_max; ++x) add_pixel(x, y);
    }
  }
  film.reset(sums, pixels_.size());
  sums.samples = count;
  return trace(first, count, cancel,
               [&](std::uint32_t pixel, std::uint32_t sample, const PixelSample& result) {
                 film.add(sums, pixel, sample, result);
               });
}

bool BatchIntegrator::sample(std::span<const PixelPlace> pixels, std::uint32_t count,
                             Vec3* radiance, const Cancel& cancel) {
  pixels_.clear();
  for (const PixelPlace& pixel : pixels) add_pixel(pixel.x, pixel.y);
  return trace(0, count, cancel,
               [&](std::uint32_t pixel, std::uint32_t sample, const PixelSample& result) {
                 radiance[std::size_t{pixel} * count + sample] = result.radiance;
               });
}

}  // namespace komorebi
