// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/control/command.hpp"
#include "runtime/control/event.hpp"
#include "runtime/control/line_edge.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/recording/bytes.hpp"

namespace zonepack {

// The state of a run before one of its cycles: enough to continue from there as from a good guess,
// not enough to decide identically before the first fixes.
struct Checkpoint {
  struct Held {
    ZoneId zone = kNoZone;
    std::uint32_t generation = 0;
    friend bool operator==(const Held&, const Held&) = default;
  };
  std::uint64_t cycle = 0;    // the one that comes next
  std::int64_t now_ns = 0;    // its time
  std::int64_t start_ns = 0;  // the time of cycle 0
  bool has_pose = false;
  Pose2 T_map_base;
  double sigma_m = 0, sigma_rad = 0;
  std::uint32_t map = 1;               // number in the run of the map in use
  std::uint32_t offered_map = 0;       // that is to replace it; 0: none
  ZoneId zone = kNoZone;               // the robot's own
  bool lost = false;                   // a localizer searches the map
  ZoneId sought = kNoZone;             // while lost: the zone that it waits for
  bool frozen = false;                 // by command
  bool held = false;                   // by the hold line
  std::vector<Held> resident;          // least recently used first
  std::vector<ZoneId> pinned;          // by command, besides those of the settings
  std::vector<ZoneId> route;           // the hint in force
  std::vector<std::byte> transitions;  // what the run learned, as a .zpt; empty: nothing
};

// The content of a checkpoint block. A map with more resident zones than a block has room for loses
// the least recently used.
std::vector<std::byte> write_checkpoint(const Checkpoint& checkpoint);
Result<Checkpoint> read_checkpoint(ByteSpan content);

// Tracks what a checkpoint needs besides the pose, from the run's events and inputs.
//
// Threads: one; not for the control thread.
class RunMirror {
 public:
  explicit RunMirror(std::size_t zones);

  void on_event(const Event& event);
  void on_commands(std::span<const Command> commands);
  void on_edges(std::span<const LineEdge> edges);
  void on_offer(std::uint32_t map) { offered_map_ = map; }

  // Another map is in use; its number.
  void change_map(std::uint32_t map, std::size_t zones);

  // Fills resident, pinned, route, frozen, held and the map on offer, as far as they belong to the
  // map of `checkpoint`.
  void describe(Checkpoint& checkpoint) const;

 private:
  void use(ZoneId zone);

  struct Entry {
    std::uint64_t used = 0;  // 0: not resident
    std::uint32_t generation = 0;
  };
  std::uint32_t map_ = 1;
  std::uint32_t offered_map_ = 0;
  std::vector<Entry> zones_;  // by ZoneId
  std::uint64_t clock_ = 0;
  std::vector<ZoneId> pinned_;
  std::vector<ZoneId> route_;
  bool frozen_ = false;
  bool held_ = false;
};

}  // namespace zonepack
