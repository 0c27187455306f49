#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "parallel/cancel.h"
#include "parallel/thread_pool.h"
#include "render/batch.h"
#include "render/context.h"
#include "render/film.h"
#include "render/filter.h"
#include "render/scene.h"
#include "render/tiles.h"

namespace komorebi {

struct Progress {
  std::uint32_t sample = 0;  ///< every pixel has as many (tile by tile: on average)
  std::uint32_t samples = 0;
  double fraction = 0.0;   ///< of all samples of all pixels
  double elapsed = 0.0;    ///< seconds
  double remaining = 0.0;  ///< seconds, from the pace so far; 0 before the first tile
  std::uint64_t rays = 0;
  std::uint64_t clamped_samples = 0;
};

/// Renders a committed scene into a film on threads of its own until done or cancelled. It starts
/// at once; everything here may be called from any thread, and it may be destroyed at any time.
class Session {
 public:
  /// Throws std::invalid_argument: scene not committed, no camera, a setting out of range.
  Session(std::shared_ptr<const Scene> scene, const Settings& settings);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// True when the render is over (done, cancelled or failed) within `seconds`.
  bool wait(double seconds);
  /// Asks for the end; takes effect within some milliseconds. What has been merged stays.
  void cancel();
  /// Goes on after a cancel with what is missing; the picture is the same as without the break.
  /// Returns at once; without effect while running.
  void resume();

  /// Tiles that changed since the last call (full-frame pixels).
  std::vector<Rect> updated_tiles();
  Progress progress() const;
  const Film& film() const { return film_; }
  const Settings& settings() const { return settings_; }
  /// Why the render failed; empty when it did not.
  std::string error() const;
  std::size_t byte_count() const { return film_.byte_count(); }

 private:
  enum class ItemState : std::uint8_t { kPending, kRunning, kDone };
  using Clock = std::chrono::steady_clock;

  void launch();
  void run();
  void work();
  const WorkItem* take_item();
  void finish_item(const WorkItem& item, bool done);

  std::shared_ptr<const Scene> scene_;
  Settings settings_;
  FilterTable filter_;
  RenderContext context_;
  Film film_;
  std::vector<WorkItem> items_;
  ThreadPool pool_;
  std::thread thread_;

  std::shared_ptr<Cancel> cancel_;  // one a run
  std::atomic<std::uint64_t> rays_{0};
  mutable std::mutex mutex_;  // guards all below
  std::condition_variable over_changed_;
  bool over_ = true;
  std::string error_;
  std::vector<ItemState> item_states_;
  std::size_t next_ = 0;         // items before it are taken
  std::size_t done_before_ = 0;  // items before it are done
  std::vector<Rect> updated_;
  std::uint64_t samples_done_ = 0;
  double seconds_before_ = 0.0;  // of runs before a resume
  Clock::time_point started_;
};

}  // namespace komorebi
