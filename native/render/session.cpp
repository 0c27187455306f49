#include "render/session.h"

#include <algorithm>
#include <new>
#include <stdexcept>

namespace komorebi {
namespace {

const Scene& require_ready(const std::shared_ptr<const Scene>& scene) {
  if (!scene || !scene->committed()) throw std::invalid_argument("the scene is not committed");
  if (!scene->has_camera()) throw std::invalid_argument("the scene has no camera");
  return *scene;
}

Settings checked(const Scene& scene, Settings settings) {
  const CameraDesc& camera = scene.camera_desc();
  check_settings(settings, camera.width, camera.height);
  if (!settings.has_region) settings.region = {0, 0, camera.width, camera.height};
  return settings;
}

}  // namespace

Session::Session(std::shared_ptr<const Scene> scene, const Settings& settings)
    : scene_(std::move(scene)),
      settings_(checked(require_ready(scene_), settings)),
      filter_(settings_.pixel_filter, settings_.filter_width),
      context_(make_context(*scene_, settings_, filter_.view())),
      film_(settings_.region, settings_, scene_->max_radiance()),
      items_(work_items(settings_.region, settings_)),
      pool_(settings_.threads),
      item_states_(items_.size(), ItemState::kPending) {
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
    next_ = 0;
    started_ = Clock::now();
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
  std::string error;
  try {
    pool_.run(pool_.size(), [this](unsigned) { work(); });
  } catch (const std::bad_alloc&) {
    error = "out of memory while rendering";
  } catch (const std::exception& e) {
    error = e.what();
  }
  const std::lock_guard lock(mutex_);
  error_ = error;
  seconds_before_ += std::chrono::duration<double>(Clock::now() - started_).count();
  over_ = true;
  over_changed_.notify_all();
}

const WorkItem* Session::take_item() {
  const std::lock_guard lock(mutex_);
  if (cancel_->raised()) return nullptr;
  while (next_ < items_.size() && item_states_[next_] != ItemState::kPending) ++next_;
  if (next_ == items_.size()) return nullptr;
  item_states_[next_] = ItemState::kRunning;
  return &items_[next_++];
}

void Session::finish_item(const WorkItem& item, bool done) {
  const std::lock_guard lock(mutex_);
  item_states_[static_cast<std::size_t>(&item - items_.data())] =
      done ? ItemState::kDone : ItemState::kPending;
  if (!done) return;
  while (done_before_ < items_.size() && item_states_[done_before_] == ItemState::kDone) {
    ++done_before_;
  }
  samples_done_ += std::uint64_t{item.count} * item.tile.area();
  const auto same = [&](const Rect& r) {
    return r.x_min == item.tile.x_min && r.y_min == item.tile.y_min;
  };
  if (std::none_of(updated_.begin(), updated_.end(), same)) updated_.push_back(item.tile);
}

void Session::work() {
  BatchIntegrator integrator(context_);
  TileSums sums;
  std::uint64_t counted = 0;
  while (const WorkItem* item = take_item()) {
    const std::vector<Rect> cells = cells_of(item->tile);
    const bool done = integrator.render(cells, item->first, item->count, film_, sums, *cancel_);
    if (done) film_.merge(cells, sums);
    finish_item(*item, done);
    rays_ += integrator.ray_count() - counted;
    counted = integrator.ray_count();
  }
}

std::vector<Rect> Session::updated_tiles() {
  const std::lock_guard lock(mutex_);
  std::vector<Rect> tiles;
  tiles.swap(updated_);
  return tiles;
}

Progress Session::progress() const {
  Progress p;
  p.clamped_samples = film_.clamped_samples();
  p.rays = rays_;
  const std::lock_guard lock(mutex_);
  const double pixels = static_cast<double>(settings_.region.area());
  p.samples = settings_.samples;
  if (!settings_.use_progressive || done_before_ == items_.size()) {
    p.sample = static_cast<std::uint32_t>(samples_done_ / settings_.region.area());
  } else {  // items come pass after pass
    p.sample = items_[done_before_].first - settings_.sample_offset;
  }
  p.fraction = static_cast<double>(samples_done_) / (pixels * settings_.samples);
  p.elapsed = seconds_before_;
  if (!over_) p.elapsed += std::chrono::duration<double>(Clock::now() - started_).count();
  if (p.fraction > 0.0) p.remaining = p.elapsed * (1.0 - p.fraction) / p.fraction;
  return p;
}

std::string Session::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

}  // namespace komorebi
