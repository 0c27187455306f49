#include "render/batch.h"

#include <algorithm>

#include "bvh/traverse.h"
#include "core/path_key.h"
#include "render/camera_kernel.h"
#include "render/one_ray.h"
#include "render/pass_row.h"
#include "render/shade.h"

namespace komorebi {
namespace {

constexpr std::size_t kPathsPerBatch = 4096;
/// All samples of so many pixels follow each other, then those of the next: their light rays, which
/// are traced together, leave places that lie close.
constexpr std::size_t kPixelsTogether = 64;

}  // namespace

BatchIntegrator::BatchIntegrator(const RenderContext& context)
    : context_(context),
      of_light_(passes_of_light_rays(context)),
      light_caster_(context),
      lamp_caster_(context),
      added_light_(context, 0),
      has_catchers_(context.passes.keeps(Quantity::kCatcherLight)),
      bounces_(context),
      bounces_alone_(alone_context(context)) {
  for (const AmbientCast& cast : ambient_casts(context)) {
    ambient_.push_back({cast.passes, LightCaster(cast.context)});
  }
}

std::uint64_t BatchIntegrator::ray_count() const {
  std::uint64_t count = camera_ray_count_ + light_caster_.ray_count() + lamp_caster_.ray_count() +
                        added_light_.ray_count() + bounce_ray_count();
  for (const Ambient& ambient : ambient_) count += ambient.caster.ray_count();
  return count;
}

std::uint64_t BatchIntegrator::bounce_ray_count() const {
  return bounces_.ray_count() + bounces_alone_.ray_count();
}

RayTally BatchIntegrator::ambient_tally() const {
  if (context_.method == Method::kAmbientOcclusion) return light_caster_.tally();
  return ambient_.empty() ? RayTally{} : ambient_.front().caster.tally();
}

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
  camera_ray_count_ += paths_.size();
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
  if (!context_.scene.filter.exists()) return;
  for (std::uint32_t i = 0; i < count; ++i) {
    camera_rays_.words(3)[i] = path_key(block.pixel_seed[i], kDimensionPixel, block.sample[i]);
  }
}

void BatchIntegrator::shade() {
  const PassLayout& layout = context_.passes;
  const RaySpan rays = camera_rays_.span();
  results_.assign(paths_.size(), PixelSample{});
  rows_.resize(layout.size() * paths_.size());
  surfaces_.clear(rays.count);
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if (layout.size() > 0) clear_row(layout, row(i));
    if (!hits_[i].valid()) {
      const Vec3 direction(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
      results_[i] = missed(context_, direction, rays.t_max[i], row(i));
    } else if (is_holdout(context_, hits_[i])) {
      if (layout.size() > 0) put_values(context_, hits_[i], row(i));
    } else {
      results_[i].alpha = 1.0f;
      surfaces_.push(i, hits_[i], rays.time[i], pixels_[paths_[i].pixel].seed,
                     paths_[i].sample * context_.light_samples);
    }
  }
  surfaces_.fill(context_, hits_.data(), rays);
  if (context_.has_materials || context_.bounces > 0) {
    shader_.shade(context_, 0, hits_.data(), rays, context_.light_samples, surfaces_);
    for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
      results_[surfaces_.path(s)].alpha = 1.0f - surfaces_.shading(s).holdout;
    }
  }
  if (layout.size() == 0) return;
  for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
    const std::uint32_t path = surfaces_.path(s);
    const Shading shading =
        context_.has_materials ? surfaces_.shading(s) : clay_shading(context_, 0);
    put_surface(context_, hits_[path], rays[path], surfaces_.normal(s), surfaces_.depth(s), shading,
                paths_[path].sample, row(path));
  }
  values_.put(context_, rays, hits_.data(), [this](std::uint32_t i) { return row(i); });
}

bool BatchIntegrator::light(const Cancel& cancel) {
  const auto for_each_block = [&](const LightCaster& caster, const auto& cast) {
    const std::uint32_t size = caster.block_size();
    for (std::uint32_t begin = 0; begin < surfaces_.size(); begin += size) {
      if (cancel.raised()) return;
      cast(begin, std::min(surfaces_.size(), begin + size));
    }
  };
  if (!is_dark(context_)) {
    for_each_block(light_caster_,
                   [&](std::uint32_t begin, std::uint32_t end) { light_block(begin, end); });
  }
  for (Ambient& ambient : ambient_) {
    for_each_block(ambient.caster, [&](std::uint32_t begin, std::uint32_t end) {
      ambient_block(ambient.passes, ambient.caster, begin, end);
    });
  }
  if (cancel.raised()) return false;
  if (has_more_light(context_) && !find_more_light(cancel)) return false;
  add_direct_light();
  if (context_.bounces > 0 && !bounce(cancel)) return false;
  if (context_.passes.size() > 0) finish_passes();
  return !cancel.raised();
}

/// Sums over light rays → what the surfaces in view bring.
void BatchIntegrator::add_direct_light() {
  const PassLayout& layout = context_.passes;
  const auto light_rays = static_cast<float>(context_.light_samples);
  for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
    const std::uint32_t path = surfaces_.path(s);
    const Shading shading = context_.has_materials ? surfaces_.shading(s) : Shading{};
    Vec3& radiance = results_[path].radiance;
    Vec3 light = radiance / light_rays;
    if (has_more_light(context_)) light += more_light_[s];
    radiance = direct_light(context_, shading, light);
    if (!has_catchers_ || !is_catcher(context_, hits_[path].instance)) continue;
    Vec3 alone = layout.get(row(path), Quantity::kCatcherLight) / light_rays;
    if (context_.lamps.count > 0) alone += lamp_light_alone_[s];
    layout.put(row(path), Quantity::kCatcherLight, direct_light(context_, shading, alone));
  }
}

bool BatchIntegrator::bounce(const Cancel& cancel) {
  bounces_.clear(surfaces_);
  if (has_catchers_) bounces_alone_.clear(surfaces_);
  for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
    const std::uint32_t path = surfaces_.path(s);
    const std::uint32_t sample = paths_[path].sample;
    bounces_.begin(surfaces_, s, path, sample);
    if (has_catchers_ && is_catcher(context_, hits_[path].instance)) {
      bounces_alone_.begin(surfaces_, s, path, sample);
    }
  }
  const auto add = [&](std::uint32_t path, const Vec3& light) { results_[path].radiance += light; };
  if (!bounces_.trace(surfaces_, cancel, add)) return false;
  return !has_catchers_ ||
         bounces_alone_.trace(surfaces_, cancel, [&](std::uint32_t path, const Vec3& light) {
           context_.passes.add(row(path), Quantity::kCatcherLight, light);
         });
}

void BatchIntegrator::light_block(std::uint32_t begin, std::uint32_t end) {
  const PassLayout& layout = context_.passes;
  if (!of_light_.any()) {
    light_caster_.cast(surfaces_, begin, end,
                       [&](std::uint32_t s, const Vec3&, const Vec3& contribution, bool visible) {
                         if (visible) results_[surfaces_.path(s)].radiance += contribution;
                       });
  } else {
    light_caster_.cast(
        surfaces_, begin, end,
        [&](std::uint32_t s, const Vec3& direction, const Vec3& contribution, bool visible) {
          if (!visible) return;
          const std::uint32_t path = surfaces_.path(s);
          results_[path].radiance += contribution;
          add_ambient(layout, of_light_, direction, contribution.x, row(path));
        });
  }
  if (!has_catchers_) return;
  light_caster_.cast_alone(
      surfaces_, begin, end,
      [&](std::uint32_t s) { return is_catcher(context_, hits_[surfaces_.path(s)].instance); },
      [&](std::uint32_t s, const Vec3& contribution) {
        layout.add(row(surfaces_.path(s)), Quantity::kCatcherLight, contribution);
      });
}

bool BatchIntegrator::find_more_light(const Cancel& cancel) {
  more_light_.assign(surfaces_.size(), Vec3(0.0f));
  lamp_light_alone_.assign(has_catchers_ ? surfaces_.size() : 0, Vec3(0.0f));
  const bool lamps = context_.lamps.count > 0;
  const std::uint32_t size = lamp_caster_.block_size();
  for (std::uint32_t begin = 0; lamps && begin < surfaces_.size(); begin += size) {
    if (cancel.raised()) return false;
    const std::uint32_t end = std::min(surfaces_.size(), begin + size);
    lamp_caster_.cast(surfaces_, begin, end, 0, more_light_.data());
    if (!has_catchers_) continue;
    lamp_caster_.cast_alone(
        surfaces_, begin, end,
        [&](std::uint32_t s) { return is_catcher(context_, hits_[surfaces_.path(s)].instance); },
        lamp_light_alone_.data());
  }
  return !context_.fast_gi.adds ||
         added_light_.add(context_, 0, surfaces_, cancel, more_light_.data());
}

void BatchIntegrator::ambient_block(const AmbientPasses& passes, LightCaster& caster,
                                    std::uint32_t begin, std::uint32_t end) {
  caster.cast(surfaces_, begin, end,
              [&](std::uint32_t s, const Vec3& direction, const Vec3& contribution, bool visible) {
                if (!visible) return;
                add_ambient(context_.passes, passes, direction, contribution.x,
                            row(surfaces_.path(s)));
              });
}

void BatchIntegrator::finish_passes() {
  const PassLayout& layout = context_.passes;
  const RaySpan rays = camera_rays_.span();
  for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
    const std::uint32_t path = surfaces_.path(s);
    if (layout.keeps_ambient()) finish_ambient(context_, row(path));
    if (!is_catcher(context_, hits_[path].instance)) {
      put_matte(layout, results_[path], row(path));
      continue;
    }
    put_environment(context_, rays[path].direction, row(path));
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
      visit(paths_[i].pixel, paths_[i].sample, results_[i], row(static_cast<std::uint32_t>(i)));
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
               [&](std::uint32_t pixel, std::uint32_t sample, const PixelSample& result,
                   const float* row) { film.add(sums, pixel, sample, result, row); });
}

bool BatchIntegrator::sample(std::span<const PixelPlace> pixels, std::uint32_t count,
                             Vec3* radiance, const Cancel& cancel) {
  pixels_.clear();
  for (const PixelPlace& pixel : pixels) add_pixel(pixel.x, pixel.y);
  return trace(
      0, count, cancel,
      [&](std::uint32_t pixel, std::uint32_t sample, const PixelSample& result, const float*) {
        radiance[std::size_t{pixel} * count + sample] = result.radiance;
      });
}

}  // namespace komorebi
