#include "render/sky_survey.h"

#include <algorithm>

#include "bvh/traverse.h"
#include "core/octahedral.h"
#include "core/path_key.h"
#include "render/light_block.h"
#include "render/light_points.h"
#include "render/one_ray.h"
#include "render/pixel_grid.h"
#include "render/scatter_batch.h"
#include "render/surface_batch.h"

namespace komorebi {
namespace {

constexpr std::size_t kRowsPerChunk = 8;  ///< rays enough for the tracer to sort

/// Of what only rendering needs, the survey knows nothing.
RenderContext survey_context(const RenderContext& given) {
  RenderContext context = given;
  context.seed = 0;  // the same for all seeds
  context.has_terminators = context.lifts_rays = false;
  context.bends_round = context.cuts_cosines = false;
  return context;
}

/// By which directions are drawn, by the cosine alone.
RenderContext cosine_context(const RenderContext& survey, std::uint32_t rays_per_point) {
  RenderContext context = survey;
  context.method = Method::kAmbientOcclusion;
  context.ao_sampling = AoSampling::kCosine;
  context.product = {};
  context.light_samples = rays_per_point;
  return context;
}

/// Paths from some rows of the grid, vertex by vertex.
class Surveyor {
 public:
  Surveyor(const RenderContext& context, std::uint32_t rays_per_point, SkySurvey& found)
      : context_(context),
        drawn_by_(cosine_context(context, rays_per_point)),
        found_(found),
        block_(rays_per_point) {}

  void begin(std::uint32_t x, std::uint32_t y) {
    rays_.push(start_ray(context_, x, y, 0));
    PathState state{};
    state.pixel_seed = Sampler(context_.seed, x, y).pixel_seed;
    states_.push_back(state);
  }

  void follow(const Cancel& cancel) {
    for (std::uint32_t vertex = 0; rays_.size() > 0; ++vertex) {
      if (cancel.raised()) return;
      find_surfaces();
      look_around(vertex);
      if (vertex == context_.bounces) return;
      leaving_.clear(surfaces_.size());
      for (std::uint32_t s = 0; s < surfaces_.size(); ++s) leaving_.set(s, 0, 0, Vec3(1.0f));
      leaving_.scatter(context_, vertex, surfaces_, rays_, states_);
    }
  }

 private:
  void find_surfaces() {
    const RaySpan rays = rays_.span();
    hits_.resize(rays.count);
    intersect(context_.scene, rays, hits_.data());
    surfaces_.clear(rays.count);
    for (std::uint32_t i = 0; i < rays.count; ++i) {
      if (hits_[i].valid()) surfaces_.push(i, hits_[i], rays.time[i], states_[i].pixel_seed, 0);
    }
    surfaces_.fill(context_, hits_.data(), rays);
  }

  void look_around(std::uint32_t vertex) {
    const Mat3& into_map = context_.sky.texture_from_world;
    drawn_by_.light_dimension = vertex_dimension(vertex, kVertexLightDirection);
    for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
      found_.points.push_back({surfaces_.leaving_origin(s), into_map * surfaces_.normal(s)});
    }
    for (std::uint32_t begin = 0; begin < surfaces_.size(); begin += block_.capacity()) {
      look(begin, std::min(surfaces_.size(), begin + block_.capacity()));
    }
  }

  /// From the surfaces [begin, end).
  void look(std::uint32_t begin, std::uint32_t end) {
    block_.draw(drawn_by_, surfaces_.light_block(drawn_by_, begin, end));
    const bool has_filter = context_.scene.filter.exists();
    if (has_filter) path_keys_.resize(block_.size());
    places_.clear();
    points_.clear(block_.size());
    for (std::uint32_t s = begin; s < end; ++s) {
      points_.begin(surfaces_, s);
      for (std::uint32_t j = 0; j < drawn_by_.light_samples; ++j) {
        const std::uint32_t place = block_.place(s - begin, j);
        places_.push_back(place);
        points_.push_ray(place);
        if (!has_filter) continue;
        path_keys_[place] = path_key(surfaces_.pixel_seed(s), drawn_by_.light_dimension, j);
      }
    }
    trace(context_.light_mask, context_.light_distance, bits_);
    if (context_.surface_mask != 0) {  // light comes where either of Cycles' kinds of rays does
      trace(context_.surface_mask, context_.surface_distance, more_bits_);
      for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] &= more_bits_[i];
    }
    const Mat3& into_map = context_.sky.texture_from_world;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Vec3 direction = into_map * block_.direction(places_[i]);
      found_.cells.push_back(
          static_cast<std::uint16_t>(octahedral_cell(direction, SkySurvey::kGrid)));
      found_.seen.push_back(((bits_[i / 32] >> (i % 32)) & 1u) == 0);
    }
  }

  void trace(std::uint32_t mask, float distance, std::vector<std::uint32_t>& bits) {
    RayBundles bundles{};
    points_.lend(bundles);
    block_.lend(bundles, distance);
    bundles.mask = mask;
    bundles.path_key = path_keys_.data();
    bits.resize((places_.size() + 31) / 32);
    occluded(context_.scene, bundles, bits.data());
  }

  const RenderContext& context_;
  RenderContext drawn_by_;
  SkySurvey& found_;
  RayBatch rays_;
  std::vector<PathState> states_;  // of each ray
  std::vector<Hit> hits_;
  SurfaceBatch surfaces_;
  ScatterBatch leaving_;
  LightBlockBuffer block_;
  LightPoints points_;
  std::vector<std::uint32_t> places_;  // of the rays of a block, point by point
  std::vector<std::uint32_t> path_keys_, bits_, more_bits_;
};

template <class T>
void append(std::vector<T>& all, const std::vector<T>& part) {
  all.insert(all.end(), part.begin(), part.end());
}

}  // namespace

bool survey_sky(const RenderContext& given, const SurveyEffort& effort, ThreadPool& pool,
                const Cancel& cancel, SkySurvey& survey) {
  const RenderContext context = survey_context(given);
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
  std::size_t found_points = 0;
  for (const SkySurvey& part : found) found_points += part.points.size();
  survey.points.reserve(found_points);
  survey.cells.reserve(found_points * survey.rays_per_point);
  survey.seen.reserve(found_points * survey.rays_per_point);
  for (const SkySurvey& part : found) {
    append(survey.points, part.points);
    append(survey.cells, part.cells);
    append(survey.seen, part.seen);
  }
  return true;
}

}  // namespace komorebi
