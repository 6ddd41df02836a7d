// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "platform/base/byte_count.hpp"
#include "platform/can/can_bus.hpp"
#include "runtime/control/cycle.hpp"
#include "runtime/memory/residency.hpp"

namespace zonepack {

// Percentiles of one thing that the control thread measures of itself, in nanoseconds.
struct TimingFigures {
  std::uint64_t count = 0;
  std::int64_t p50 = 0, p99 = 0, p999 = 0, p9999 = 0, max = 0;
};

// The parts of a cycle, for the cause of the worst one.
enum class CycleStep : std::uint8_t { kReceive, kCycle, kPublish };
const char* to_string(CycleStep step) noexcept;

struct WorstCycle {
  std::uint64_t cycle = 0;
  std::int64_t ns = 0;
  CycleStep step = CycleStep::kReceive;  // the longest part
  std::int64_t step_ns = 0;
  std::uint32_t frames = 0, corrections = 0, loads = 0, commands = 0;
};

// What was left undone or late. Counters only: serve/status_figures.cpp has a row for each.
struct OverloadCounters {
  std::uint64_t missed_deadlines = 0;     // cycles that began a period or more late
  std::uint64_t skipped_periods = 0;      // periods without a cycle for that reason
  std::uint64_t deferred_frames = 0;      // cycles that left frames waiting on the bus
  std::uint64_t dropped_frames = 0;       // lost before they could be read
  std::uint64_t deferred_commands = 0;    // cycles that left commands waiting
  std::uint64_t lost_events = 0;          // the queue to their writer was full
  std::uint64_t lost_service_events = 0;  // the queue to the server was full; it resyncs
  std::uint64_t lost_records = 0;         // records of what cycles did
  std::uint64_t lost_replies = 0;         // replies to commands
  std::uint64_t lost_recordings = 0;      // cycles whose inputs could not be recorded
};

// The state of the run, as the control thread publishes it after every cycle.
struct LiveStatus {
  std::int64_t now_ns = 0;           // the cycle's time
  std::int64_t began_ns = 0;         // when it began, CLOCK_MONOTONIC
  std::int64_t clock_offset_ns = 0;  // CLOCK_REALTIME, or a played log's, minus the run's clock

  // The run's clock at a moment after the cycle.
  std::int64_t run_ns(std::int64_t monotonic_ns) const noexcept {
    return now_ns + (monotonic_ns - began_ns);
  }
  CycleState state;
  ByteCount budget = 0;
  ByteCount charged = 0;
  std::uint64_t max_signatures = 0;
  NeedSum charged_sum;   // slots and signatures
  NeedSum resident_sum;  // of these, usable
  ResidencyCounters residency;
  WheelOdometryCounters odometry;
  PoseFilterCounters filter;
  OverloadCounters overload;
  std::uint64_t can_frames = 0;
  CanBusStatus bus;
  bool frozen = false;
  bool realtime = false;  // SCHED_FIFO was granted
  bool memory_locked = false;
  std::uint64_t minor_faults = 0, major_faults = 0;  // control thread, after start
  std::uint64_t voluntary_switches = 0, involuntary_switches = 0;
  // Updated once a second of cycles.
  TimingFigures wakeup, cycle;
  WorstCycle worst;
};

}  // namespace zonepack
