#include "render/session.h"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "render/light_samples.h"
#include "render/tiles.h"

namespace komorebi {
namespace {

const CameraDesc& chosen_camera(const std::shared_ptr<const Scene>& scene,
                                const std::optional<CameraDesc>& camera) {
  if (!scene || !scene->committed()) throw std::invalid_argument("the scene is not committed");
  if (!camera && !scene->has_camera()) throw std::invalid_argument("the scene has no camera");
  return camera ? *camera : scene->camera_desc();
}

Settings checked(const CameraDesc& camera, Settings settings) {
  check_settings(settings, camera.width, camera.height);
  if (!settings.has_region) settings.region = {0, 0, camera.width, camera.height};
  return settings;
}

/// Adaptive sampling decides on whole cells: those that a border cuts are rendered whole, and what
/// lies outside is never read.
Rect film_region(const CameraDesc& camera, const Settings& settings) {
  if (!settings.use_adaptive_sampling) return settings.region;
  return whole_cells(settings.region, camera.width, camera.height);
}

}  // namespace

Session::Session(std::shared_ptr<const Scene> scene, const Settings& settings,
                 const std::optional<CameraDesc>& camera, const Cancel& before)
    : scene_(std::move(scene)),
      camera_(chosen_camera(scene_, camera)),
      settings_(checked(camera_, settings)),
      filter_(settings_.pixel_filter, settings_.filter_width),
      context_(make_context(*scene_, settings_, filter_.view(), before)),
      light_samples_(context_.light_samples),
      rule_(settings_, context_.light_samples),
      pool_(settings_.threads, settings_.has_low_priority ? Priority::kLow : Priority::kNormal),
      film_(film_region(camera_, settings_), settings_, max_radiance(*scene_, settings_),
            scene_->has_catchers(), scene_->tables().max_value()),
      schedule_(make_tiles(film_.region(), settings_.tile_size, pool_.size()), settings_, rule_) {
  if (camera) {
    context_.camera = make_camera(camera_, scene_->origin());
    camera_tables_ = CameraTables(camera_, scene_->origin(), context_.camera);
    camera_tables_.lend(context_.camera);
    context_.frame_width = static_cast<float>(camera_.width);
    context_.frame_height = static_cast<float>(camera_.height);
  }
  launch();
}

Session::~Session() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void Session::launch() {
  if (thread_.joinable()) thread_.join();
  {
    const std::lock_guard lock(mutex_);
    cancel_ = std::make_shared<Cancel>();
    over_ = false;
    schedule_.start();
  }
  thread_ = std::thread([this] { run(); });
}

bool Session::wait(double seconds) {
  std::unique_lock lock(mutex_);
  return over_changed_.wait_for(lock, std::chrono::duration<double>(std::max(0.0, seconds)),
                                [&] { return over_; });
}

void Session::cancel() {
  const std::lock_guard lock(mutex_);
  cancel_->raise();
}

void Session::resume() {
  {
    const std::lock_guard lock(mutex_);
    if (!over_ || !error_.empty()) return;
  }
  launch();
}

void Session::run() {
  if (settings_.has_low_priority) lower_priority();
  std::string error;
  try {
    prepare();
    pool_.run(pool_.size(), [this](unsigned) { work(); });
  } catch (const std::bad_alloc&) {
    error = "out of memory while rendering";
  } catch (const std::exception& e) {
    error = e.what();
  }
  schedule_.pause();
  const std::lock_guard lock(mutex_);
  error_ = error;
  over_ = true;
  over_changed_.notify_all();
}

void Session::prepare() {
  if (prepared_) return;
  const Cancel& cancel = *cancel_;
  if (settings_.guides_light) guide_.prepare(*scene_, pool_, cancel, context_);
  const std::uint32_t chosen = settings_.light_samples > 0
                                   ? settings_.light_samples
                                   : choose_light_samples(context_, pool_, cancel);
  if (cancel.raised()) return;  // what is missing is done when resumed
  light_samples_ = context_.light_samples = chosen;
  prepared_ = true;
}

void Session::work() {
  const Cancel& cancel = *cancel_;  // set before this thread began
  BatchIntegrator integrator(context_);
  TileSums sums;
  std::uint64_t counted = 0;
  RayTally tallied;
  while (const auto item = schedule_.take(cancel)) {
    const Cells cells = *item->cells;
    bool done = false;
    try {
      done = integrator.render(cells, item->first, item->count, film_, sums, cancel);
      if (done) film_.merge(cells, sums);
    } catch (...) {  // else the others would wait for this piece
      schedule_.finish(*item, false, film_);
      this->cancel();
      throw;
    }
    rays_ += integrator.ray_count() - counted;
    counted = integrator.ray_count();
    const RayTally tally = integrator.ambient_tally();
    ambient_cast_ += tally.cast - tallied.cast;
    ambient_blocked_ += tally.blocked - tallied.blocked;
    tallied = tally;
    schedule_.finish(*item, done, film_);
  }
}

std::vector<Rect> Session::updated_tiles() {
  const Rect& r = settings_.region;
  std::vector<Rect> tiles;
  for (const Rect& t : schedule_.updated_tiles()) {
    const Rect inside{std::max(t.x_min, r.x_min), std::max(t.y_min, r.y_min),
                      std::min(t.x_max, r.x_max), std::min(t.y_max, r.y_max)};
    tiles.push_back(inside);  // not empty: the film's cells all touch the region
  }
  return tiles;
}

Progress Session::progress() const {
  const ScheduleState state = schedule_.state();
  Progress p;
  p.clamped_samples = film_.clamped_samples();
  p.rays = rays_;
  p.ambient = {ambient_cast_, ambient_blocked_};
  p.samples = settings_.samples;
  p.tile = state.tile;
  p.tiles = state.tiles;
  p.mean_samples =
      static_cast<double>(state.pixel_samples) / static_cast<double>(film_.region().area());
  const bool by_pass = settings_.use_progressive || settings_.time_limit > 0.0f;
  p.sample = by_pass || state.tile == state.tiles ? state.sample
                                                  : static_cast<std::uint32_t>(p.mean_samples);
  p.fraction = state.fraction;
  p.elapsed = schedule_.elapsed();
  if (p.fraction > 0.0) p.remaining = p.elapsed * (1.0 - p.fraction) / p.fraction;
  return p;
}

void Session::read(const std::string& pass, const Rect& rect, float* out) {
  film_.read(pass, rect, out, pool_);
}

std::string Session::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

}  // namespace komorebi
