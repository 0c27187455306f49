#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
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
#include "render/schedule.h"
#include "render/sky_guide.h"

namespace komorebi {

struct Progress {
  std::uint32_t sample = 0;  ///< every pixel has as many, or has converged (tile by tile: the mean)
  std::uint32_t samples = 0;
  std::uint32_t tile =
      0;  ///< tiles done in the pass over the frame that is on (tile by tile: of all)
  std::uint32_t tiles = 0;
  double mean_samples = 0.0;  ///< a pixel, so far
  double fraction = 0.0;      ///< of the samples of all pixels that have not converged
  double elapsed = 0.0;       ///< seconds
  double remaining = 0.0;     ///< seconds, from the pace so far; 0 before the first tile
  std::uint64_t rays = 0;
  RayTally ambient;  ///< rays for ambient occlusion, and those that hit something
  std::uint64_t clamped_samples = 0;
};

/// Renders a committed scene into a film on threads of its own until done or cancelled. It starts
/// at once; everything here may be called from any thread, and it may be destroyed at any time.
class Session {
 public:
  /// @param camera  in place of the scene's own, as a viewport looks from somewhere else all the
  ///                time; nothing of the scene is built anew. Its motion is what the scene's has.
  /// @param before  ends what is to be done before it starts, which then throws Cancelled
  /// Throws std::invalid_argument: scene not committed, no camera, a setting out of range.
  Session(std::shared_ptr<const Scene> scene, const Settings& settings,
          const std::optional<CameraDesc>& camera = std::nullopt,
          const Cancel& before = Cancel::never());
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

  /// Tiles that changed since the last call (full-frame pixels), within the region.
  std::vector<Rect> updated_tiles();
  Progress progress() const;
  /// A pass as Film::read(), on all threads when the render is over.
  void read(const std::string& pass, const Rect& rect, float* out);
  const Film& film() const { return film_; }
  const Settings& settings() const { return settings_; }
  /// With what is automatic in the settings decided.
  const AdaptiveRule& adaptive_rule() const { return rule_; }
  /// What is automatic is known when the render has begun to sample.
  std::uint32_t light_samples() const { return light_samples_; }
  /// Why the render failed; empty when it did not.
  std::string error() const;
  std::size_t byte_count() const { return film_.byte_count(); }

 private:
  void launch();
  void run();
  void prepare();
  void work();

  std::shared_ptr<const Scene> scene_;
  CameraDesc camera_;
  Settings settings_;
  FilterTable filter_;
  RenderContext context_;
  CameraTables camera_tables_;                // of a camera that is not the scene's
  SkyGuide guide_;                            // what context_ draws light rays by
  std::atomic<std::uint32_t> light_samples_;  // context_'s, for those who ask
  bool prepared_ = false;                     // context_ is as the whole render takes it
  AdaptiveRule rule_;
  ThreadPool pool_;
  Film film_;
  Schedule schedule_;
  std::thread thread_;

  std::atomic<std::uint64_t> rays_{0}, ambient_cast_{0}, ambient_blocked_{0};
  mutable std::mutex mutex_;        // guards all below
  std::shared_ptr<Cancel> cancel_;  // one a run
  std::condition_variable over_changed_;
  bool over_ = true;
  std::string error_;
};

}  // namespace komorebi
