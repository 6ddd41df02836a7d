// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/control/cycle.hpp"
#include "runtime/control/event.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/run/figures/run_summary.hpp"
#include "runtime/run/figures/run_trace.hpp"
#include "runtime/run/hold_keeper.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// What a cycle did, for those who watch.
struct CycleRecord {
  std::int64_t now_ns = 0;
  CycleState state;
  NeedSum charged;   // as Residency counts
  NeedSum resident;  // of that, usable
  ResidencyCounters counters;
  ByteCount charged_bytes = 0;  // everything, also what is set aside for a change of map
};
CycleRecord record_of(std::int64_t now_ns, const CycleState& state, const Residency& memory);

// Watches a run from outside and says how it went, in numbers and for drawing.
//
// It keeps its own account of what is charged, zone by zone, from the events alone, and does not
// believe the sums that Residency keeps: a cycle in which the two differ is a violation, like one
// over a limit. The robot's own zone is the zone that holds its true position (the one before when
// that is on no zone's ground), or the tracker's where there is no truth.
//
// Threads: one.
// Memory: allocates; bounded by zones and the constants below, however long the run.
class RunStatistics final : public EventSink {
 public:
  // A longer run keeps every second of what it has, then less and less often: 12 MB of samples and
  // 2 MB of events for drawing, 1 MB of holds, 4 MB of position errors. Of two samples, the one
  // that shows trouble or charges more stays.
  static constexpr std::size_t kMostSamples = 60'000;
  static constexpr std::size_t kMostTraceEvents = 20'000;
  static constexpr std::size_t kMostErrors = 1'000'000;

  // truth may be null; everything must outlive this object.
  RunStatistics(const ZoneGraph& graph, std::span<const ZoneNeed> needs, const TruthTrack* truth,
                std::int64_t period_ns, const ResidencyLimits& limits);

  // Another map is in use from the next event on. Drawings stay on the first one's ground; its
  // zones go by their names there.
  void change_map(const ZoneGraph& graph, std::span<const ZoneNeed> needs,
                  const ResidencyLimits& limits);

  // A zone that is resident before the first cycle, which no event reports.
  void begin_with(ZoneId zone) noexcept;

  void on_event(const Event& event) noexcept override;

  // After the events of the cycle.
  void after_cycle(const CycleRecord& cycle);

  // Fills the parts that are known here.
  void summarise(RunSummary& summary) const;

  // Without keep_trace() before the run, empty: a robot has no memory for it.
  void keep_trace() noexcept { keeps_trace_ = true; }
  RunTrace take_trace();

 private:
  enum class Held : std::uint8_t { kNot, kCharged, kResident };

  void check_limits(const CycleRecord& cycle);
  void watch_zone(const CycleRecord& cycle);
  void keep_error(double error_m);
  void keep_hold(const Event& event);
  void keep_sample(const CycleRecord& cycle);
  void thin_samples();
  ZoneId drawn(ZoneId zone) const noexcept;
  double seconds(std::uint64_t cycles) const noexcept;

  const ZoneGraph* graph_;
  std::span<const ZoneNeed> needs_;
  const TruthTrack* truth_;
  std::int64_t period_ns_;
  ResidencyLimits limits_;

  std::vector<Held> held_;                // by ZoneId
  std::vector<std::string> drawn_names_;  // of the first map; empty until another is in use
  std::vector<ZoneId> drawn_;             // zones of the first map, by ZoneId of the one in use
  NeedSum charged_;
  std::int64_t start_ns_ = 0;
  std::int64_t now_ns_ = 0;
  std::uint64_t cycles_ = 0;
  std::optional<std::uint64_t> first_resident_;  // the cycle
  std::optional<Pose2> true_pose_;
  ZoneId true_zone_ = kNoZone;
  bool absent_ = false;
  bool localised_ = false;         // the robot's own zone was resident once
  std::uint64_t true_cycles_ = 0;  // with a true pose
  std::uint64_t absent_cycles_ = 0, blocked_cycles_ = 0, wrong_cycles_ = 0, violations_ = 0;
  NeedSum peak_;
  ByteCount peak_bytes_ = 0;
  ResidencyCounters counters_;
  std::vector<float> errors_m_;
  float worst_error_m_ = 0;
  std::uint64_t error_stride_ = 1, errors_seen_ = 0;  // every error_stride_-th is kept
  std::uint64_t event_stride_ = 1, events_seen_ = 0;
  double sample_period_s_;
  bool keeps_trace_ = false;
  RunTrace trace_;
  HoldKeeper holds_;
};

}  // namespace zonepack
