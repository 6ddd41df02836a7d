// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "platform/base/byte_count.hpp"

namespace zonepack {

// The result of a run in numbers; `zoned replay --json` and `zoned run --json` print these names.
struct PoseError {
  double p50 = 0, p95 = 0, max = 0;  // metres, distance to the true position
};

// What a live run measured of itself; "live" is not about replays.
struct LiveFigures {
  struct Timing {
    double p50 = 0, p99 = 0, p999 = 0, p9999 = 0, max = 0;  // microseconds
  };
  struct Worst {  // the longest cycle, and why
    std::uint64_t cycle = 0;
    double us = 0, step_us = 0;
    const char* step = "";  // its longest part
    std::uint32_t frames = 0, corrections = 0, loads = 0, commands = 0;
  };
  ByteCount process_peak_bytes = 0;  // resident, by the kernel
  ByteCount overhead_bytes = 0;      // of that, what lies outside of slots and map tables
  std::uint64_t minor_faults = 0;    // these of the control thread, after its start
  std::uint64_t major_faults = 0;
  std::uint64_t allocations = 0;
  std::uint64_t missed_deadlines = 0;
  Timing cycle_us;   // the cycle's own work
  Timing wakeup_us;  // begun after its deadline
  Timing ready_us;   // from the end of a load to map_ready, of loads that it waited for
  std::uint64_t ready_count = 0;
  std::uint64_t lines_not_working = 0;  // GPIO lines, at the end
  Worst worst;
  std::uint64_t lost_events = 0;
  bool realtime = false;
  bool memory_locked = false;
};

struct RunSummary {
  ByteCount budget_bytes = 0;
  ByteCount peak_charged_bytes = 0;
  std::uint64_t budget_violations = 0;  // cycles over either limit
  std::uint64_t max_signatures = 0;     // 0: no such limit
  std::uint64_t peak_signatures = 0;
  std::uint64_t signatures_loaded = 0;
  std::uint64_t signatures_unloaded = 0;
  std::uint64_t zones_loaded = 0;
  std::uint64_t zones_unloaded = 0;
  ByteCount bytes_loaded = 0;
  std::uint64_t zone_switches = 0;
  bool localised = true;     // the robot's own zone was resident at some time
  double start_s = 0;        // until the first zone is resident
  double zone_absent_s = 0;  // after that: time without the robot's own zone, by truth where given
  double blocked_s = 0;
  // Truth more than 0.3 m inside another zone than the tracker's. Nothing without truth.
  std::optional<double> wrong_zone_s;
  std::optional<PoseError> pose_error_m;  // nothing without truth
  std::uint64_t cycles = 0;
  std::uint64_t can_frames = 0;
  std::uint64_t can_rejected = 0;
  std::string can_rejected_why;  // "312 above max_speed 3 m/s"; empty: nothing known
  std::uint64_t corrections_used = 0;
  std::uint64_t corrections_rejected = 0;
  std::string corrections_rejected_why;
  std::string event_log_hash;  // BLAKE2b-256 of the event log, hex
  std::optional<LiveFigures> live;
};

}  // namespace zonepack
