// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "platform/process/realtime.hpp"
#include "runtime/control/cycle.hpp"
#include "runtime/state/state_store.hpp"

namespace zonepack {

// What the saver looks at: the latest that the control thread published.
struct StateGlimpse {
  std::int64_t now_ns = 0;  // the run's clock
  PoseEstimate pose;
  std::uint32_t map = 1;  // number in the run of the map that the zone belongs to
  ZoneId zone = kNoZone;
};

// Saves the robot's state when its zone changes, when the run ends, and otherwise once a minute:
// flash wears. A folder that cannot be written costs the state, never the run: it is counted,
// reported once, and tried again.
//
// Threads: one that watches, its own unless watch() is called by hand; the control thread only
// publishes.
class StateSaver {
 public:
  static constexpr std::int64_t kPeriod_ns = 60'000'000'000;

  // look: the newest glimpse. place: fills the map's version and the name of the zone; false when
  // that map is gone. report: receives complete messages. All must outlive this object. `like`
  // gives the map's lineage and the number of runs.
  StateSaver(StateStore& store, SavedState like, std::function<StateGlimpse()> look,
             std::function<bool(const StateGlimpse&, SavedState&)> place,
             std::function<void(std::string)> report);
  ~StateSaver() { end_thread(); }

  // Called by the thread that saves, after each look, and a last time at the end: saves what else
  // there is. Before start(). A failure is reported as one of the state.
  void also(std::function<Result<void>(bool at_end)> save) { also_ = std::move(save); }

  Result<void> start();
  // Saves a last time.
  void stop();

  // Looks, and saves if it is time to.
  void watch();

  // Any thread.
  std::uint64_t saved() const noexcept { return saved_.load(); }
  std::uint64_t failures() const noexcept { return failures_.load(); }

 private:
  void save(const StateGlimpse& glimpse);
  void save_also(bool at_end);
  void conclude(const Result<void>& done);
  void end_thread() noexcept;

  StateStore& store_;
  SavedState state_;
  std::function<StateGlimpse()> look_;
  std::function<bool(const StateGlimpse&, SavedState&)> place_;
  std::function<void(std::string)> report_;
  std::function<Result<void>(bool at_end)> also_;
  std::uint32_t map_ = 1;  // as saved, or tried to
  ZoneId zone_ = kNoZone;
  std::int64_t last_ns_ = 0;
  bool tried_ = false;
  bool failing_ = false;
  std::atomic<std::uint64_t> saved_{0}, failures_{0};
  std::atomic<bool> stop_{false};
  Thread thread_;
};

// A restored pose and how certain it is assumed to be: no more than a given pose, and less than it
// was.
struct RestoredStart {
  Pose2 T_map_base;
  double sigma_m = 0, sigma_rad = 0;
};
RestoredStart guess_from(const SavedState& state, const PoseFilterSettings& settings);

}  // namespace zonepack
