#pragma once

#include <span>
#include <vector>

#include "parallel/cancel.h"
#include "render/added_light.h"
#include "render/ambient.h"
#include "render/bounce_tracer.h"
#include "render/cells.h"
#include "render/context.h"
#include "render/film.h"
#include "render/lamp_caster.h"
#include "render/light_caster.h"
#include "render/material_values.h"
#include "render/ray_batch.h"
#include "render/shade.h"
#include "render/surface_batch.h"

namespace komorebi {

/// A pixel of the full frame.
struct PixelPlace {
  std::uint32_t x, y;
};

/// Renders cells in batches of some thousand paths, stage by stage: start → closest hits → light
/// rays → occlusion → bounces → film. The arrays live as long as the object, one a thread.
class BatchIntegrator {
 public:
  explicit BatchIntegrator(const RenderContext& context);

  /// Adds samples [first, first + count) of every pixel of `cells` to `sums`.
  /// False when cancelled on the way; the sums are then to be thrown away.
  bool render(Cells cells, std::uint32_t first, std::uint32_t count, const Film& film,
              TileSums& sums, const Cancel& cancel);

  /// Samples [0, count) of single pixels, which nothing is added up of: radiance[p · count + s].
  bool sample(std::span<const PixelPlace> pixels, std::uint32_t count, Vec3* radiance,
              const Cancel& cancel);

  std::uint64_t ray_count() const;
  std::uint64_t bounce_ray_count() const;
  /// Of the rays that look for ambient occlusion, as picture or as pass.
  RayTally ambient_tally() const;

 private:
  struct Pixel {
    std::uint32_t x, y;  // in the full frame
    std::uint32_t seed;  // of its sampler
  };
  struct Path {
    std::uint32_t pixel, sample;  // index among the cells' pixels, and of the sample
  };
  // The columns of a CameraBlock, and what they are padded by.
  enum { kColumnX, kColumnY, kColumnSample, kColumnSeed, kColumns };
  static constexpr std::uint32_t kPadding = 16;

  void add_pixel(std::uint32_t x, std::uint32_t y);
  /// Samples [first, first + count) of pixels_; visit(pixel, sample, result, row) is told each.
  template <class Visit>
  bool trace(std::uint32_t first, std::uint32_t count, const Cancel& cancel, const Visit& visit);
  /// Paths [begin, end) of the samples [first, first + samples) of pixels_.
  void start(std::size_t begin, std::size_t end, std::uint32_t first, std::uint32_t samples);
  void start_camera_rays(std::uint32_t count);
  void shade();
  bool light(const Cancel& cancel);
  void light_block(std::uint32_t begin, std::uint32_t end);
  void ambient_block(const AmbientPasses& passes, LightCaster& caster, std::uint32_t begin,
                     std::uint32_t end);
  void add_direct_light();
  bool bounce(const Cancel& cancel);
  /// What lamps bring to the surfaces in view, and what Fast GI adds.
  bool find_more_light(const Cancel& cancel);
  void finish_passes();
  float* row(std::uint32_t path) { return rows_.data() + context_.passes.size() * path; }

  RenderContext context_;
  std::vector<Pixel> pixels_;
  std::vector<Path> paths_;
  std::vector<std::uint32_t> starts_[kColumns];
  RayBatch camera_rays_;
  std::vector<Hit> hits_;
  SurfaceBatch surfaces_;
  BatchShader shader_;
  MaterialValues values_;
  std::vector<PixelSample> results_;
  std::vector<float> rows_;  // [paths][context_.passes.size()]
  AmbientPasses of_light_;   // passes that light rays fill
  LightCaster light_caster_;
  LampCaster lamp_caster_;
  AddedLight added_light_;
  std::vector<Vec3> more_light_, lamp_light_alone_;  // of each surface; of those that are catchers
  struct Ambient {
    AmbientPasses passes;
    LightCaster caster;
  };
  std::vector<Ambient> ambient_;
  bool has_catchers_;
  BounceTracer bounces_, bounces_alone_;  // the latter among shadow catchers
  std::uint64_t camera_ray_count_ = 0;
};

}  // namespace komorebi
