#include "render/sky_survey.h"

#include <algorithm>

#include "bvh/traverse.h"
#include "core/path_key.h"
#include "core/warp.h"
#include "render/bundle_batch.h"
#include "render/light.h"
#include "render/one_ray.h"
#include "render/pixel_grid.h"
#include "render/ray_batch.h"
#include "render/scatter.h"

namespace komorebi {
namespace {

constexpr std::size_t kRowsPerChunk = 4;  ///< rays enough for the tracer to sort

/// Paths from some rows of the grid, vertex by vertex.
class Surveyor {
 public:
  Surveyor(const RenderContext& context, std::uint32_t rays_per_point, SkySurvey& found)
      : context_(context), rays_per_point_(rays_per_point), found_(found) {}

  void begin(std::uint32_t x, std::uint32_t y) {
    next_.push(start_ray(context_, x, y, 0));
    next_seeds_.push_back(Sampler(context_.seed, x, y).pixel_seed);
  }

  void follow(const Cancel& cancel) {
    for (std::uint32_t vertex = 0; vertex <= context_.bounces && next_.size() > 0; ++vertex) {
      if (cancel.raised()) return;
      std::swap(rays_, next_);
      std::swap(seeds_, next_seeds_);
      next_.clear();
      next_seeds_.clear();
      light_rays_.clear();
      find_surfaces(vertex);
      look();
    }
  }

 private:
  void find_surfaces(std::uint32_t vertex) {
    const RaySpan rays = rays_.span();
    hits_.resize(rays.count);
    intersect(context_.scene, rays, hits_.data());
    for (std::uint32_t i = 0; i < rays.count; ++i) {
      if (!hits_[i].valid()) continue;
      const Ray ray = rays[i];
      const SurfacePoint point = surface_point(context_.scene, hits_[i], ray);
      add_point(vertex, point, ray.time, hits_[i], Sampler(seeds_[i]));
      const ScatterPoint from{point.normal, point.geometric_normal, leaving_origin(point), 1.0f,
                              ray.time,     hits_[i].instance,      hits_[i].primitive};
      Ray onwards;
      Vec3 throughput(1.0f);
      if (vertex == context_.bounces ||
          !scatter(context_, vertex, from, Sampler(seeds_[i]), 0, throughput, onwards)) {
        continue;
      }
      next_.push(onwards);
      next_seeds_.push_back(seeds_[i]);
    }
  }

  void add_point(std::uint32_t vertex, const SurfacePoint& point, float time, const Hit& hit,
                 const Sampler& sampler) {
    const Mat3& into_map = context_.sky.texture_from_world;
    const Vec3 origin = leaving_origin(point);
    found_.points.push_back({origin, into_map * point.normal});
    light_rays_.begin_point(origin, time, hit);
    const Frame frame = make_frame(point.normal);
    const std::uint32_t dimension = vertex_dimension(vertex, kVertexLightDirection);
    for (std::uint32_t i = 0; i < rays_per_point_; ++i) {
      const Vec3 direction =
          frame.to_world(cosine_hemisphere_disk(sampler.sample_2d(dimension, i)));
      light_rays_.push_ray(direction, context_.light_distance,
                           path_key(sampler.pixel_seed, dimension, i));
      found_.directions.push_back(into_map * direction);
    }
  }

  void look() {
    const RayBundles bundles = light_rays_.bundles(context_.light_mask);
    bits_.resize((bundles.ray_count() + 31) / 32);
    occluded(context_.scene, bundles, bits_.data());
    if (context_.surface_mask != 0) {  // light comes where either of Cycles' kinds of rays does
      RayBundles of_surface = bundles;
      of_surface.mask = context_.surface_mask;
      surface_t_max_.assign(bundles.ray_count(), context_.surface_distance);
      of_surface.t_max = surface_t_max_.data();
      more_bits_.resize(bits_.size());
      occluded(context_.scene, of_surface, more_bits_.data());
      for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] &= more_bits_[i];
    }
    for (std::uint32_t i = 0; i < bundles.ray_count(); ++i) {
      found_.seen.push_back(((bits_[i / 32] >> (i % 32)) & 1u) == 0);
    }
  }

  const RenderContext& context_;
  std::uint32_t rays_per_point_;
  SkySurvey& found_;
  RayBatch rays_, next_;
  std::vector<std::uint32_t> seeds_, next_seeds_;
  BundleBatch light_rays_;
  std::vector<Hit> hits_;
  std::vector<std::uint32_t> bits_, more_bits_;
  std::vector<float> surface_t_max_;
};

}  // namespace

bool survey_sky(const RenderContext& given, const SurveyEffort& effort, ThreadPool& pool,
                const Cancel& cancel, SkySurvey& survey) {
  RenderContext context = given;
  context.seed = 0;  // the same for all seeds
  const PixelGrid grid(context.camera, effort.paths);
  const double pixels = 4.0 * double{context.camera.film_center_x} * context.camera.film_center_y;
  const double rays = std::min(effort.rays, effort.most_rays_per_pixel * pixels);
  const double points = static_cast<double>(grid.size()) * (context.bounces + 1.0);
  survey = {};
  survey.rays_per_point =
      std::max(static_cast<std::uint32_t>(rays / points), effort.least_rays_per_point);
  const std::size_t chunks = (grid.rows() + kRowsPerChunk - 1) / kRowsPerChunk;
  std::vector<SkySurvey> found(chunks);  // joined in their order, whoever made them
  pool.for_each_chunk(chunks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end && !cancel.raised(); ++chunk) {
      Surveyor surveyor(context, survey.rays_per_point, found[chunk]);
      const std::size_t first = chunk * kRowsPerChunk;
      const std::size_t last = std::min<std::size_t>(grid.rows(), first + kRowsPerChunk);
      for (std::size_t row = first; row < last; ++row) {
        const std::uint32_t y = grid.y(static_cast<std::uint32_t>(row));
        for (std::uint32_t column = 0; column < grid.columns(); ++column) {
          surveyor.begin(grid.x(column), y);
        }
      }
      surveyor.follow(cancel);
    }
  });
  if (cancel.raised()) return false;
  for (const SkySurvey& part : found) {
    survey.points.insert(survey.points.end(), part.points.begin(), part.points.end());
    survey.directions.insert(survey.directions.end(), part.directions.begin(),
                             part.directions.end());
    survey.seen.insert(survey.seen.end(), part.seen.begin(), part.seen.end());
  }
  return true;
}

}  // namespace komorebi
