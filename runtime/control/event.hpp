// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

// What happened, in the words of the event log (event_log.hpp lists each event's fields).
enum class EventKind : std::uint8_t {
  kStart,
  kPoseInitialised,     // the first hypothesis of where the robot is
  kPoseTrusted,         // two fixes agreed
  kPoseReinitialised,   // a run of rejected fixes agreed: the pose was moved there
  kCorrectionRejected,  // reason: the filter's verdict
  kOdometryStale,       // no sample for longer than the timeout
  kOdometryResumed,
  kBusOff,         // the CAN controller left the bus for too many errors
  kBusRestarted,   // and was started again
  kZoneEntered,    // the tracker's zone changed
  kZoneWanted,     // entered, approached, a hypothesis or pinned: to be resident
  kZoneUnwanted,   // no longer so
  kLoadStarted,    // admitted: charged from here on
  kLoadDone,       // resident
  kLoadCancelled,  // the loader was asked to give up
  kLoadGivenUp,    // it did: no longer charged
  kLoadFailed,     // reason: the error; no longer charged, tried again later if still wanted
  kEvicted,
  kBlocked,  // a wanted zone does not fit alongside what must stay
  kUnblocked,
  kNotKeepingUp,   // the robot entered a zone that is not resident
  kMapOffered,     // another version of the map is to be taken
  kMapChanged,     // it was; zones from here on are the new map's
  kMapRefused,     // it was not, reason says why: the old one stays
  kDocked,         // the dock's contact closed: the pose is where the dock is, and trusted
  kUndocked,       // it opened
  kHoldBegun,      // the hold line became active: nothing is evicted
  kHoldEnded,      // the hold line was released
  kZoneConfirmed,  // a marker was passed: the robot's zone, moved there if it was another
  kMarkerIgnored,  // reason: why what it says is not believed
  kEnd,
  kPoseLost,    // a localizer does not know where the robot is: the pose was given up
  kZoneSought,  // the zone is to be loaded and searched for the robot
  kTurnAsked,   // the robot should turn on the spot: what was seen fits several places, or none
  kPoseFound,   // the pose is trusted again
  kZoneKept,    // resident in the map before and, unchanged, in this one: not loaded again
};

// The word for it in the log ("zone_entered").
const char* to_string(EventKind kind) noexcept;

// One thing that happened, as plain integers, so that recording it costs the control thread a copy.
// Fields that an event does not use keep their defaults.
struct Event {
  EventKind kind = EventKind::kStart;
  std::uint64_t cycle = 0;
  std::int64_t t_ns = 0;  // since the start of the run
  std::uint32_t map = 1;  // number in the run of the map that the zone belongs to
  ZoneId zone = kNoZone;
  std::uint32_t generation = 0;
  std::uint32_t signatures = 0;          // of the zone
  ByteCount bytes = 0;                   // charged for the zone
  std::uint64_t charged_signatures = 0;  // of all zones, after the event
  ByteCount charged_bytes = 0;           // everything, after the event
  const char* reason = nullptr;          // a static word
  bool has_pose = false;
  std::int32_t x_mm = 0, y_mm = 0, yaw_mrad = 0;  // base_link in the map
};

// Receives events in their order.
// Real-time: on_event() neither blocks, allocates nor throws on the robot.
class EventSink {
 public:
  virtual ~EventSink() = default;
  virtual void on_event(const Event& event) noexcept = 0;
};

// Stamps events with their map and the cycle in which they happen.
class EventStamper {
 public:
  explicit EventStamper(EventSink& sink, std::uint32_t map = 1) noexcept : sink_(sink), map_(map) {}

  void begin_cycle(std::uint64_t cycle, std::int64_t t_ns) noexcept {
    cycle_ = cycle;
    t_ns_ = t_ns;
  }

  std::int64_t t_ns() const noexcept { return t_ns_; }

  void emit(Event event) noexcept {
    event.map = map_;
    event.cycle = cycle_;
    event.t_ns = t_ns_;
    sink_.on_event(event);
  }

 private:
  EventSink& sink_;
  std::uint32_t map_;
  std::uint64_t cycle_ = 0;
  std::int64_t t_ns_ = 0;
};

}  // namespace zonepack
