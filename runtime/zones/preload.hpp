// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// A zone the robot is about to enter, or may be in already.
struct Approach {
  ZoneId zone = kNoZone;
  bool ahead = false;        // its path leads there; else a portal is within three sigma
  double entry_s = 0;        // ahead: when it will be entered, from seen_ns on
  std::int64_t seen_ns = 0;  // when this was last true
};

struct PreloadSettings {
  double margin_m = 0.3;           // on top of three sigma: how far ahead a zone must be ready
  double motion_average_s = 0.15;  // over which speed and yaw rate are smoothed
  double standing_m_s = 0.02;      // slower than this is standing or turning in place
  double hold_s = 0.3;             // an approach not seen for this long is given up
  double most_turn_rad = 1.5;      // an arc is followed this far; then the path goes straight on
  double most_reach_m = 20;        // and no path is followed farther
  bool off = false;                // nothing is approached: for comparison (zoned evaluate)
  // What Transitions are used for (Cycle), besides this path:
  std::string transitions;  // file of what was learned; empty: none
  bool learn = false;       // the run goes on learning
  double pays = 1.5;        // seconds saved for each second of reading that may be for nothing
};

// Whether what was learned of the robot's habits is used.
inline bool uses_habits(const PreloadSettings& settings) noexcept {
  return settings.learn || !settings.transitions.empty();
}

// Which zones are being approached: those whose portal the robot's path crosses within the horizon
//
//   time to load the zone + (3 sigma + margin_m) / speed,
//
// where the path is the arc of the present speed and yaw rate, in whichever direction the robot
// goes; and those whose portal is within three sigma, where the robot may be on the other side
// already. So driving past a door approaches nothing. While the robot stands or turns in place,
// nothing is newly approached and nothing is given up.
//
// Real-time: no allocation; a cycle tests at most kMaxSteps + kMaxHops pieces of path against the
// portals of one zone each (at most kMaxPortalsPerZone).
// Threads: owned by the control thread.
class Preload {
 public:
  static constexpr std::size_t kMaxApproaches = 8;
  static constexpr int kMaxSteps = 32;
  static constexpr int kMaxHops = 3;

  // load_s: for every zone the estimated seconds from request to use; must outlive this object.
  Preload(const ZoneGraph& graph, std::span<const float> load_s,
          const PreloadSettings& settings = {});

  // Takes the pose of this cycle (valid, not older than the last) and the zone that holds it.
  void update(const PoseEstimate& pose, ZoneId zone) noexcept;

  // Forgets approaches and motion, as after re-initialisation.
  void restart() noexcept;

  // Zones ahead first, the soonest entered first, then lowest ZoneId. Never the zone given to
  // update().
  std::span<const Approach> approaches() const noexcept { return {held_.data(), count_}; }

 private:
  void smooth(const PoseEstimate& pose) noexcept;
  double speed() const noexcept;
  void follow_path(const PoseEstimate& pose, ZoneId zone, double margin_m) noexcept;
  const Exit* exit_on(ZoneId zone, Point2 from, Point2 to, double slack_m) const noexcept;
  void see(const Approach& seen) noexcept;

  const ZoneGraph& graph_;
  std::span<const float> load_s_;
  float longest_load_s_ = 0;
  PreloadSettings settings_;
  double speed_m_s_ = 0;
  double sideways_m_s_ = 0;
  double yaw_rate_rad_s_ = 0;
  std::int64_t last_ns_ = 0;
  bool moved_ = false;
  std::array<Approach, kMaxApproaches> held_{};
  std::size_t count_ = 0;
};

}  // namespace zonepack
