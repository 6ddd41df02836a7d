// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/cycle.hpp"
#include "runtime/event.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/replay/run_files.hpp"
#include "runtime/replay/run_summary.hpp"
#include "runtime/replay/run_trace.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// Watches a replay from outside and says how it went, in numbers and for drawing.
//
// It counts what is charged anew in every cycle, zone by zone, and does not believe the sums that
// Residency keeps. The robot's own zone is the zone that holds its true position (on no zone's
// ground the one before), or the tracker's where there is no truth.
class RunRecorder final : public EventSink {
 public:
  // truth may be null; everything must outlive this object. Events are passed on to `log`.
  RunRecorder(const ZoneGraph& graph, std::span<const ZoneNeed> needs, const TruthTrack* truth,
              std::int64_t period_ns, EventSink& log);

  void on_event(const Event& event) noexcept override;

  void after_cycle(std::int64_t now_ns, const CycleState& state, const Residency& memory);

  // Fills the parts that are known here.
  void summarise(const Residency& memory, RunSummary& summary) const;
  RunTrace take_trace() { return std::move(trace_); }

 private:
  struct Recount {
    std::uint64_t slots = 0;
    std::uint64_t signatures = 0;
  };

  Recount recount(const Residency& memory) const;
  void check_limits(const Recount& recount, const Residency& memory);
  void watch_zone(const CycleState& state, const Residency& memory);
  void keep_sample(const CycleState& state, const Recount& recount, const Residency& memory);
  double seconds(std::uint64_t cycles) const noexcept;

  const ZoneGraph& graph_;
  std::span<const ZoneNeed> needs_;
  const TruthTrack* truth_;
  std::int64_t period_ns_;
  EventSink& log_;

  std::int64_t start_ns_ = 0;
  std::int64_t now_ns_ = 0;
  std::uint64_t cycles_ = 0;
  std::optional<std::uint64_t> first_resident_;  // the cycle
  std::optional<Pose2> true_pose_;
  ZoneId true_zone_ = kNoZone;
  bool absent_ = false;
  std::uint64_t absent_cycles_ = 0, blocked_cycles_ = 0, wrong_cycles_ = 0, violations_ = 0;
  Recount peak_;
  std::vector<float> errors_m_;
  RunTrace trace_;
};

}  // namespace zonepack
