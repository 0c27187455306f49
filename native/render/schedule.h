#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <queue>
#include <vector>

#include "parallel/cancel.h"
#include "render/adaptive.h"
#include "render/film.h"

namespace komorebi {

/// A piece of a render: these sample indices of these cells of a tile.
struct WorkItem {
  std::uint32_t tile = 0;
  std::uint32_t pass = 0;
  std::uint32_t first = 0, count = 0;  ///< first includes the settings' sample_offset
  std::shared_ptr<const std::vector<Rect>> cells;
};

/// How far a render is.
struct ScheduleState {
  std::uint32_t sample = 0;  ///< whole passes over the frame, in samples
  std::uint32_t tile = 0;    ///< tiles done in the pass that is on (tile by tile: of all)
  std::uint32_t tiles = 0;
  double fraction = 0.0;  ///< of the samples that are still foreseen
  std::uint64_t pixel_samples = 0;
};

/// Gives out the work of a render: passes over all tiles (1 sample, then doubling, at most
/// samples_per_pass at a time, so that threads end together), so that a cancelled picture is whole
/// and only noisier; or, when not progressive, tile after tile to its end.
///
/// A pass of a tile waits for another only where a decision about its cells lies between them, and
/// then only for those of the same tile. So threads never meet at the end of a pass.
class Schedule {
 public:
  /// Tiles as make_tiles(): unions of whole cells of the film.
  Schedule(std::vector<Rect> tiles, const Settings& settings, const AdaptiveRule& rule);

  /// The next piece; waits while others must end first. Nothing when there is none left, the time
  /// is up or `cancel` is raised.
  std::optional<WorkItem> take(const Cancel& cancel);
  /// Gives a piece back, merged into the film when `done`.
  void finish(const WorkItem& item, bool done, const Film& film);

  /// The clock of the time limit; it stands between pause() and start().
  void start();
  void pause();
  double elapsed() const;

  std::vector<Rect> updated_tiles();  ///< since the last call
  ScheduleState state() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Pass {
    std::uint32_t first, end;  // without sample_offset
    std::uint32_t unfinished;  // tiles that have not done it
  };
  struct Tile {
    Rect rect;
    std::shared_ptr<const std::vector<Rect>> cells;  // still active
    std::size_t pixels = 0;                          // of them
    std::vector<float> half;  // their means when there were half as many samples
    std::uint32_t next_pass = 0;
    std::uint32_t open = 0;  // pieces queued or given out
    bool updated = false;
  };
  struct Place {  // in the order of work
    std::uint32_t major, minor;
    bool operator>(const Place& o) const {
      return major != o.major ? major > o.major : minor > o.minor;
    }
  };

  double elapsed_locked() const;
  bool decision_after(const Pass& pass) const;
  bool ensure_pass(std::uint32_t pass);
  std::uint32_t next_count(std::uint32_t done) const;
  std::uint32_t count_in_time(std::uint32_t wanted) const;
  void push(std::uint32_t tile, std::uint32_t pass);
  void review(Tile& tile, std::uint32_t samples, const Film& film) const;
  void retire(const Tile& tile);

  const AdaptiveRule rule_;
  const std::uint32_t samples_, samples_per_pass_, sample_offset_;
  const double time_limit_;
  const bool by_pass_;  // else tile by tile

  mutable std::mutex mutex_;  // guards all below; a tile under review belongs to its reviewer
  std::condition_variable changed_;
  std::vector<Tile> tiles_;
  std::vector<Pass> passes_;
  std::priority_queue<Place, std::vector<Place>, std::greater<>> queue_;
  std::uint32_t given_out_ = 0;    // pieces now with threads
  std::uint32_t live_tiles_ = 0;   // that have not converged
  std::size_t live_pixels_ = 0;    // of cells that have not converged
  std::uint32_t passes_done_ = 0;  // by all tiles
  std::uint32_t tiles_ended_ = 0;
  bool time_is_up_ = false;
  std::uint64_t pixel_samples_ = 0;
  std::uint64_t foreseen_;       // pixel samples, done or to be done if no more cells converge
  double seconds_before_ = 0.0;  // of runs before a pause
  std::optional<Clock::time_point> started_;
  std::vector<std::uint32_t> updated_;
};

}  // namespace komorebi
