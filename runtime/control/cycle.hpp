// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "platform/can/can_bus.hpp"
#include "runtime/control/command.hpp"
#include "runtime/control/event.hpp"
#include "runtime/control/line_edge.hpp"
#include "runtime/control/outlook.hpp"
#include "runtime/control/zone_keeper.hpp"
#include "runtime/control/zone_loader.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/odometry/pose_filter.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/zones/preload.hpp"
#include "runtime/zones/tracker.hpp"
#include "runtime/zones/transitions.hpp"
#include "runtime/zones/zone_graph.hpp"
#include "runtime/zones/zone_markers.hpp"

namespace zonepack {

struct CycleConfig {
  WheelOdometrySettings odometry;
  PoseFilterSettings filter;
  TrackerSettings tracker;
  PreloadSettings preload;
  ZoneKeeperSettings keeper;
  struct Dock {
    Pose2 T_map_base;
    double sigma_m = 0, sigma_rad = 0;
  };
  std::optional<Dock> dock;
  std::vector<ZoneMarkerSettings> markers;
};

// What a cycle works on; all of it outlives the cycle.
struct CycleParts {
  const ZoneGraph& graph;
  std::span<const ZoneNeed> needs;  // by ZoneId
  std::span<const float> load_s;    // by ZoneId: estimated seconds from request to use
  std::span<const ZoneId> pinned;
  Residency& memory;
  ZoneLoader& loader;
  EventSink& events;
  ZoneDirectory* directory = nullptr;  // where readers find resident zones
  std::uint32_t map = 1;               // number in the run of the map that all this belongs to
  Transitions* transitions = nullptr;  // what is known of the robot's habits; null: nothing
};

// Another map on offer: its number in this run, or why one that was to be offered cannot be used.
struct MapOffer {
  std::uint32_t map = 0;  // 0: none
  ErrorCode fault = ErrorCode::kOk;
  // Zones that both maps have with the same pack stay resident; false as in recordings of versions
  // that did not keep them.
  bool keeps = false;
};

// All that a cycle decides on besides the settings and the map; this is what is recorded. Frames
// and corrections are stamped on the clock of now_ns, which never goes back.
struct CycleInput {
  std::int64_t now_ns = 0;
  std::span<const CanFrame> frames{};
  std::span<const PoseCorrection> corrections{};
  std::span<const LoadResult> loads{};  // polled from the loader
  std::span<const Command> commands{};  // at most Cycle::kMostCommands
  MapOffer offer{};                     // MapSwitcher's
  std::span<const LineEdge> edges{};
};

struct CycleState {
  PoseEstimate pose;
  std::uint32_t map = 1;  // number in the run of the map that `zone` belongs to
  ZoneId zone = kNoZone;  // the robot's own, by the tracker
  bool zone_resident = false;
  bool map_ready = false;  // the pose is trusted and the robot's own zone resident
  bool blocked = false;    // a wanted zone does not fit
  bool odometry_stale = true;
  bool lost = false;        // a localizer said so, and no two fixes agreed since
  ZoneId sought = kNoZone;  // while lost: the zone that it waits for
  Pose2 T_wheels_base;      // by the wheels alone, from wherever the run began
  std::uint64_t cycles = 0;
  std::uint64_t zone_switches = 0;  // from one zone to another
};

// One step of control, the same in a replay and on the robot: what arrived since the last step goes
// through odometry, pose, zone and wanted zones to what is evicted and loaded.
//
// Invariant: decisions depend only on the settings, the map and what run() is given, in that order;
// never on wall clock, memory addresses or timing.
// Real-time: run() neither allocates, locks, waits nor throws; its work is bounded by the frames,
// corrections, commands and edges given, plus the bounds of tracker, preload and keeper.
// Threads: one.
class Cycle {
 public:
  static constexpr std::size_t kMostCommands = 16;

  Cycle(const CycleConfig& settings, const CycleParts& parts);

  // Where the robot may be: a guess to start from. Before the first run().
  void start_at(std::int64_t now_ns, const Pose2& T_map_base) noexcept;
  // The same, with its standard deviations.
  void start_at(std::int64_t now_ns, const Pose2& T_map_base, double sigma_m,
                double sigma_rad) noexcept;

  // Continues the numbers and times of a run: the next run() is its cycle `cycle`, start_ns the
  // time of its cycle 0. Before the first run().
  void continue_from(std::uint64_t cycle, std::int64_t start_ns) noexcept;
  // The run was lost then, and `sought` the zone that its localizer waited for (kNoZone: none).
  void continue_lost(ZoneId sought) noexcept;

  // The first call starts the run.
  const CycleState& run(const CycleInput& input) noexcept;

  // The replies to the commands of the last run(), in their order.
  std::span<const CommandReply> replies() const noexcept { return {replies_.data(), reply_count_}; }

  // Records the end of the run.
  void finish() noexcept;

  // Takes over from the cycle of another map: its pose, odometry, counters and time, with this
  // one's map. Both need the same settings. Before the first run().
  // Real-time: copies, no allocation.
  void go_on_from(const Cycle& other) noexcept;

  ZoneKeeper& keeper() noexcept { return zone_keeper_; }

  // Records an event that is not the cycle's own, at its time.
  void report(EventKind kind, const char* reason = nullptr) noexcept {
    emit(kind, kNoZone, reason);
  }

  const CycleState& state() const noexcept { return state_; }
  const WheelOdometryCounters& odometry_counters() const noexcept { return odometry_.counters(); }
  const PoseFilterCounters& filter_counters() const noexcept { return filter_.counters(); }

 private:
  void take(const PoseCorrection& fix, std::int64_t now_ns) noexcept;
  void take(const LineEdge& edge, std::int64_t now_ns) noexcept;
  void dock(const LineEdge& edge, std::int64_t now_ns) noexcept;
  void pass_marker(std::size_t marker) noexcept;
  void freeze(bool by_command, bool by_line) noexcept;
  void lose_pose() noexcept;
  void find_pose() noexcept;
  void watch_odometry(std::int64_t now_ns) noexcept;
  CommandReply obey(const Command& command, std::int64_t now_ns) noexcept;
  void follow_zones(ZoneId before, std::int64_t now_ns) noexcept;
  struct Wanted {
    std::array<ZoneId, ZoneKeeper::kMaxWanted> zones{};
    std::size_t count = 0;
    std::size_t urgent = 0;
    std::size_t needed = 0;
    std::size_t useful = 0;
    std::size_t due = 0;
    const ZoneGraph* graph = nullptr;
    void add(ZoneId zone) noexcept;
  };
  Wanted list_wanted(std::int64_t now_ns) const noexcept;
  void want_view(Wanted& wanted) const noexcept;
  void emit(EventKind kind, ZoneId zone = kNoZone, const char* reason = nullptr) noexcept;

  const ZoneGraph& graph_;
  std::span<const ZoneNeed> needs_;
  Residency& memory_;
  EventStamper events_;
  WheelOdometry odometry_;
  PoseFilter filter_;
  ZoneTracker tracker_;
  Preload preload_;
  ZoneKeeper zone_keeper_;
  ZoneMarkers markers_;
  std::optional<CycleConfig::Dock> dock_;
  TrackerSettings tracker_settings_;
  CycleState state_;
  Outlook outlook_;
  std::array<CommandReply, kMostCommands> replies_{};
  std::size_t reply_count_ = 0;
  std::int64_t start_ns_ = 0;
  double view_m_ = 0;               // how far a localizer sees that gave a fix …
  std::int64_t view_until_ns_ = 0;  // … lately
  bool frozen_ = false;             // by command
  bool held_ = false;               // by the hold line
};

}  // namespace zonepack
