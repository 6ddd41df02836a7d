// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "platform/can/can_bus.hpp"
#include "platform/memory/seqlock.hpp"
#include "platform/memory/spsc_queue.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/control/input_sink.hpp"
#include "runtime/control/map_switcher.hpp"
#include "runtime/live/messages/live_notes.hpp"
#include "runtime/run/figures/histogram.hpp"
#include "runtime/run/figures/live_status.hpp"

namespace zonepack {

// Where the time of a run comes from: the robot's clock, or a log that is played.
class RunClock {
 public:
  virtual ~RunClock() = default;

  // The time of the cycle whose deadline has come; when it began, by CLOCK_MONOTONIC.
  virtual std::int64_t cycle_time_ns(std::uint64_t cycle, std::int64_t began_ns) noexcept = 0;

  // Waits until everything that arrives up to the cycle's time is there to be received, and its
  // watchers have kept up; false when the run is over. A robot never waits: it returns at once.
  virtual bool await_inputs(std::uint64_t cycle) noexcept = 0;

  // After the cycle: false when nothing will come any more.
  virtual bool more() noexcept = 0;

  virtual std::int64_t offset_ns() noexcept = 0;  // CLOCK_REALTIME minus the run's clock
};

struct ControlSettings {
  std::int64_t wall_period_ns = 10'000'000;  // between cycles, by CLOCK_MONOTONIC
  bool may_skip = true;         // late by whole periods: leave them out. A log's cycles all run
  bool judge_deadlines = true;  // false: a log played faster than it can be is played as it can
  std::uint32_t most_frames = 64;
};

// What the loop works on; all of it outlives the loop.
struct ControlPorts {
  RunClock& clock;
  CanBus& bus;
  MapSwitcher& maps;
  ZoneLoader& loader;
  EventFanOut& notes;
  OverloadCounters& overload;
  SpscQueue<PoseCorrection>& logged_corrections;  // in order of reception
  SpscQueue<PoseCorrection>* poses = nullptr;     // from other programs
  SpscQueue<Command>* commands = nullptr;
  SpscQueue<CommandReply>* replies = nullptr;
  SpscQueue<LineEdge>* edges = nullptr;  // stamps by CLOCK_MONOTONIC
  InputSink* tap = nullptr;
  Seqlock<LiveStatus>& status;
};

// The control thread: a cycle every period, on absolute times.
//
// Overload, each counted in OverloadCounters: frames beyond most_frames wait on the bus, commands,
// corrections and edges of lines beyond the bounds below in their queues, so a cycle's work stays
// bounded; a cycle that begins a period or more late leaves whole periods out instead of hurrying
// after them; a queue to a slower thread that is full loses what was for it, never time.
//
// Real-time: after the first cycle run() neither allocates, locks, reads files, logs nor throws.
class ControlLoop {
 public:
  static constexpr std::size_t kMostCorrections = 16;
  static constexpr std::size_t kMostLoads = 4;
  static constexpr std::size_t kMostEdges = 16;

  ControlLoop(const ControlSettings& settings, const ControlPorts& ports);

  // Whether memory is locked, for the status; before run().
  void set_memory_locked(bool locked) noexcept { status_.memory_locked = locked; }

  // Until the clock says that the run is over, or stop(). In the control thread.
  void run() noexcept;
  void stop() noexcept { stop_.store(true, std::memory_order_relaxed); }

  // Offers another map, once the one offered before was given back by take_unused(). One other
  // thread.
  bool offer(MapInUse& next) noexcept;
  // One that was to be offered cannot be used: the cycle reports why. The same thread.
  void offer_refused(ErrorCode fault) noexcept { refused_.store(fault, std::memory_order_relaxed); }
  // The map that is not used any more, once: after a change the one before, else the one offered.
  MapInUse* take_unused() noexcept { return unused_.exchange(nullptr, std::memory_order_acq_rel); }

  // The tables of the map before a change are gone.
  void map_freed() noexcept { freed_.store(true, std::memory_order_release); }

  // Cycles begun so far; any thread.
  std::uint64_t cycles() const noexcept { return cycles_.load(std::memory_order_relaxed); }

  // In the control thread, or after run() has returned. Woken: begun after the deadline that was
  // slept for; cycles of a log that hurry after a late one are not woken.
  const Histogram& wakeup() const noexcept { return wakeup_; }
  const Histogram& work() const noexcept { return work_; }
  const LiveStatus& last_status() const noexcept { return status_; }
  std::uint64_t allocations() const noexcept { return allocations_; }

 private:
  std::int64_t next_deadline(std::int64_t deadline_ns, std::int64_t began_ns) noexcept;
  void step(std::uint64_t cycle, std::int64_t began_ns) noexcept;
  std::size_t take_commands() noexcept;
  std::size_t take_corrections(std::int64_t now_ns) noexcept;
  std::size_t take_edges(std::int64_t now_ns, std::int64_t began_ns) noexcept;
  void answer() noexcept;
  void publish(const CycleInput& input, std::int64_t began_ns, std::int64_t offset_ns) noexcept;
  void measure(const CycleInput& input, std::uint64_t cycle,
               const std::array<std::int64_t, 4>& marks) noexcept;

  ControlSettings settings_;
  ControlPorts ports_;
  std::atomic<bool> stop_{false};
  std::atomic<MapInUse*> offered_{nullptr};
  std::atomic<MapInUse*> unused_{nullptr};
  std::atomic<ErrorCode> refused_{ErrorCode::kOk};
  std::atomic<bool> freed_{false};
  std::atomic<std::uint64_t> cycles_{0};
  std::vector<CanFrame> frames_;
  std::array<PoseCorrection, kMostCorrections> corrections_{};
  std::array<LoadResult, kMostLoads> loads_{};
  std::array<Command, Cycle::kMostCommands> commands_{};
  std::array<LineEdge, kMostEdges> edges_{};
  Histogram wakeup_;
  Histogram work_;
  LiveStatus status_;
  ThreadUsage usage_at_start_;
  std::uint64_t allocations_ = 0;
};

}  // namespace zonepack
