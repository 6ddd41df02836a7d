// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/pack_format/ids.hpp"

// What a replay did, for drawing. Times are seconds since the start of the run.
namespace zonepack {

struct TraceZone {
  std::string name;
  std::string zone_type;
  Polygon polygon;
  std::uint32_t signatures = 0;
  ByteCount charged_bytes = 0;  // while held
};

struct TracePortal {
  Segment2 segment;
  ZoneId zone_a = kNoZone;
  ZoneId zone_b = kNoZone;
};

// One cycle; not every cycle is kept, but every one at which a count below changed is.
struct TraceSample {
  double t_s = 0;
  bool pose_valid = false;
  bool pose_trusted = false;
  Pose2 estimate;
  bool has_truth = false;
  Pose2 truth;
  ZoneId tracked_zone = kNoZone;
  ZoneId true_zone = kNoZone;  // by truth, kNoZone without
  bool zone_absent = false;    // the robot's own zone was not resident
  bool blocked = false;        // a wanted zone did not fit
  ByteCount charged_bytes = 0;
  std::uint64_t charged_signatures = 0;   // of zones resident or being loaded
  std::uint64_t resident_signatures = 0;  // of zones resident
  std::uint64_t signatures_loaded = 0;    // cumulative
  std::uint64_t signatures_unloaded = 0;  // cumulative
};

struct TraceEvent {
  double t_s = 0;
  std::string event;  // as in the event log
  ZoneId zone = kNoZone;
};

// A zone that took memory: from the start of its load until it was given up, failed or evicted.
struct TraceHold {
  ZoneId zone = kNoZone;
  double from_s = 0;
  double ready_s = 0;  // resident from here on; to_s: it never was
  double to_s = 0;
};

struct RunTrace {
  std::vector<TraceZone> zones;  // by ZoneId
  std::vector<TracePortal> portals;
  ByteCount budget_bytes = 0;
  ByteCount fixed_bytes = 0;         // of charged_bytes, what is charged before any zone is
  std::uint64_t max_signatures = 0;  // 0: no such limit
  double duration_s = 0;
  std::vector<TraceSample> samples;
  std::vector<TraceEvent> events;
  std::vector<TraceHold> holds;  // by from_s
};

}  // namespace zonepack
