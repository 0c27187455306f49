#include "render/schedule.h"

#include <algorithm>
#include <bit>

namespace komorebi {

Schedule::Schedule(std::vector<Rect> tiles, const Settings& settings, const AdaptiveRule& rule)
    : rule_(rule),
      samples_(settings.samples),
      samples_per_pass_(settings.samples_per_pass),
      sample_offset_(settings.sample_offset),
      time_limit_(settings.time_limit),
      by_pass_(settings.use_progressive || settings.time_limit > 0.0f),
      tiles_(tiles.size()),
      live_tiles_(static_cast<std::uint32_t>(tiles.size())) {
  for (std::uint32_t t = 0; t < tiles.size(); ++t) {
    Tile& tile = tiles_[t];
    tile.rect = tiles[t];
    tile.cells = std::make_shared<const std::vector<Rect>>(cells_of(tile.rect));
    tile.pixels = tile.rect.area();
    live_pixels_ += tile.pixels;
    push(t, 0);
  }
  foreseen_ = std::uint64_t{live_pixels_} * samples_;
}

void Schedule::push(std::uint32_t tile, std::uint32_t pass) {
  queue_.push(by_pass_ ? Place{pass, tile} : Place{tile, pass});
  ++tiles_[tile].open;
}

bool Schedule::decision_after(const Pass& pass) const {
  return rule_.decides_at(pass.end) || rule_.remembers_at(pass.end);
}

/// Samples of the pass that begins after `done`: it crosses no power of two, where cells may stop.
std::uint32_t Schedule::next_count(std::uint32_t done) const {
  const std::uint32_t doubling = std::min(std::max(done, 1u), samples_per_pass_);
  return std::min({doubling, std::bit_ceil(done + 1) - done, samples_ - done});
}

/// As many of them as end within the time limit at the pace so far; 0 when not even one does.
std::uint32_t Schedule::count_in_time(std::uint32_t wanted) const {
  const double elapsed = elapsed_locked();
  const double per_sample =
      elapsed / static_cast<double>(pixel_samples_) * static_cast<double>(live_pixels_);
  const double fit = (time_limit_ - elapsed) / per_sample;
  return fit < 1.0 ? 0 : fit < wanted ? static_cast<std::uint32_t>(fit) : wanted;
}

bool Schedule::ensure_pass(std::uint32_t pass) {
  if (pass < passes_.size()) return true;
  if (time_is_up_) return false;
  const std::uint32_t done = passes_.empty() ? 0 : passes_.back().end;
  std::uint32_t count = next_count(done);
  if (time_limit_ > 0.0 && done > 0) count = count_in_time(count);
  time_is_up_ = count == 0;
  if (!time_is_up_) passes_.push_back({done, done + count, live_tiles_});
  return !time_is_up_;
}

std::optional<WorkItem> Schedule::take(const Cancel& cancel) {
  std::unique_lock lock(mutex_);
  while (!cancel.raised()) {
    if (queue_.empty()) {
      if (given_out_ == 0) return {};
      changed_.wait(lock);
      continue;
    }
    const Place place = queue_.top();
    const std::uint32_t p = by_pass_ ? place.major : place.minor;
    const std::uint32_t t = by_pass_ ? place.minor : place.major;
    if (!ensure_pass(p)) {  // nor any that comes after it in the queue
      if (given_out_ == 0) return {};
      changed_.wait(lock);
      continue;
    }
    queue_.pop();
    Tile& tile = tiles_[t];
    const Pass& pass = passes_[p];
    if (tile.next_pass == p) {  // not one that comes back
      ++tile.next_pass;
      if (pass.end < samples_ && !decision_after(pass)) push(t, p + 1);
    }
    ++given_out_;
    return WorkItem{t, p, sample_offset_ + pass.first, pass.end - pass.first, tile.cells};
  }
  return {};
}

/// Decides which cells go on, or keeps their means for the next decision. The tile has no pieces
/// out, so nobody else looks at it.
void Schedule::review(Tile& tile, std::uint32_t n, const Film& film) const {
  std::vector<float> means(4 * tile.pixels);
  auto active = std::make_shared<std::vector<Rect>>();
  std::size_t from = 0, kept = 0;
  for (const Rect& cell : *tile.cells) {
    float* now = &means[from];
    film.cell_means(cell, now);
    const std::size_t values = 4 * cell.area();
    if (!rule_.decides_at(n) || !rule_.converged(now, &tile.half[from], cell.area(), n)) {
      active->push_back(cell);
      std::copy(now, now + values, &means[kept]);
      kept += values;
    }
    from += values;
  }
  means.resize(rule_.remembers_at(n) ? kept : 0);
  tile.half = std::move(means);
  tile.pixels = kept / 4;
  tile.cells = std::move(active);
}

/// A tile of which all cells have converged takes no part in later passes.
void Schedule::retire(const Tile& tile) {
  --live_tiles_;
  ++tiles_ended_;
  for (std::size_t p = tile.next_pass; p < passes_.size(); ++p) --passes_[p].unfinished;
}

void Schedule::finish(const WorkItem& item, bool done, const Film& film) {
  std::unique_lock lock(mutex_);
  Tile& tile = tiles_[item.tile];
  if (!done) {
    queue_.push(by_pass_ ? Place{item.pass, item.tile} : Place{item.tile, item.pass});
    --given_out_;
    changed_.notify_all();
    return;
  }
  pixel_samples_ += std::uint64_t{item.count} * tile.pixels;
  if (!tile.updated) updated_.push_back(item.tile);
  tile.updated = true;
  if (--tile.open == 0) {
    const std::uint32_t n = passes_[tile.next_pass - 1].end;
    if (n < samples_) {
      const std::size_t before = tile.pixels;
      lock.unlock();
      review(tile, n, film);
      lock.lock();
      live_pixels_ -= before - tile.pixels;
      foreseen_ -= std::uint64_t{before - tile.pixels} * (samples_ - n);
      if (tile.pixels > 0) {
        push(item.tile, tile.next_pass);
      } else {
        retire(tile);
      }
    } else {
      ++tiles_ended_;
    }
  }
  --passes_[item.pass].unfinished;
  while (passes_done_ < passes_.size() && passes_[passes_done_].unfinished == 0) ++passes_done_;
  --given_out_;
  changed_.notify_all();
}

void Schedule::start() {
  const std::lock_guard lock(mutex_);
  started_ = Clock::now();
}

void Schedule::pause() {
  const std::lock_guard lock(mutex_);
  seconds_before_ = elapsed_locked();
  started_.reset();
}

double Schedule::elapsed_locked() const {
  if (!started_) return seconds_before_;
  return seconds_before_ + std::chrono::duration<double>(Clock::now() - *started_).count();
}

double Schedule::elapsed() const {
  const std::lock_guard lock(mutex_);
  return elapsed_locked();
}

std::vector<Rect> Schedule::updated_tiles() {
  const std::lock_guard lock(mutex_);
  std::vector<Rect> rects;
  for (const std::uint32_t t : updated_) {
    rects.push_back(tiles_[t].rect);
    tiles_[t].updated = false;
  }
  updated_.clear();
  return rects;
}

ScheduleState Schedule::state() const {
  const std::lock_guard lock(mutex_);
  ScheduleState s;
  s.sample = passes_done_ > 0 ? passes_[passes_done_ - 1].end : 0;
  s.tiles = static_cast<std::uint32_t>(tiles_.size());
  s.tile = !by_pass_ || passes_done_ == passes_.size() ? tiles_ended_
                                                       : s.tiles - passes_[passes_done_].unfinished;
  s.fraction = static_cast<double>(pixel_samples_) / static_cast<double>(foreseen_);
  if (time_limit_ > 0.0) s.fraction = std::max(s.fraction, elapsed_locked() / time_limit_);
  if (time_is_up_ && given_out_ == 0) s.fraction = 1.0;
  s.fraction = std::min(s.fraction, 1.0);
  s.pixel_samples = pixel_samples_;
  return s;
}

}  // namespace komorebi
