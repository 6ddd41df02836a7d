// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/localize/check/calibration_watch.hpp"
#include "runtime/localize/query/query_result.hpp"
#include "runtime/localize/replay/camera_loop.hpp"
#include "runtime/localize/replay/map_error.hpp"
#include "runtime/run/figures/run_summary.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/run/run.hpp"

namespace zonepack::localize {

// The values that half of all, 95 % and 99 % of all, are not above (nearest rank), and the largest.
struct Spread {
  double p50 = 0, p95 = 0, max = 0;
  std::optional<double> p99;  // where it is known
};
std::optional<Spread> spread_of(std::vector<double> values);

// How a closed loop went, in numbers; `zoneloc replay --json` prints these names.
struct LoopFigures {
  std::size_t images = 0;
  std::size_t accepted = 0;
  // Of the accepted: within 0.5 m and 10 degrees of the truth, and not. Nothing without truth.
  std::optional<std::size_t> right, wrong;
  double longest_gap_s = 0;               // without a fix; also before the first and after the last
  std::optional<Spread> fix_error_m;      // of accepted fixes, to the truth
  std::optional<Spread> fix_error_map_m;  // the same in the map's frame (MapError)
  std::optional<Spread> yaw_error_deg;    // of the pose, every cycle
  std::optional<Spread> query_ms;
  std::array<std::optional<Spread>, kStages> stage_ms;
  ByteCount rss_peak_bytes = 0;
  // Until the pose was trusted. Nothing: it never was.
  std::optional<std::size_t> found_after_views;
  std::optional<double> found_after_s;
  std::map<std::string, std::size_t> reasons;
  CalibrationReport calibration;
  LostLoop::Figures lost;
  // Squared Mahalanobis distance of the last fixes to the pose: 3 when covariances are honest; and
  // by what variances had to be widened at most, 1: not.
  double fix_distance2 = 0, fix_widened = 1;
  RunSummary run;
};

// Collects how far the heading is off the truth, every cycle with a pose.
// Memory: 4 bytes a cycle.
class HeadingWatch final : public RunObserver {
 public:
  explicit HeadingWatch(const TruthTrack* truth) : truth_(truth) {}
  void on_event(const Event&, const MapVersion&) noexcept override {}
  void after_cycle(const CycleRecord& cycle, const MapVersion&) noexcept override;
  std::optional<Spread> errors_deg() const;

 private:
  const TruthTrack* truth_;
  std::vector<float> errors_deg_;
};

// Whether a fix is right, by the truth.
bool is_right(const Pose2& fix, const Pose2& truth) noexcept;

// "accepted", a word of Reason, "no_pose" or "unreadable_image".
const char* reason_of(const LoopView& view) noexcept;

// `truth` may be null: what needs it is unknown.
LoopFigures figures_of(const CameraLoop& loop, const RunSummary& run, const HeadingWatch& heading,
                       const TruthTrack* truth);
// Adds fix_error_map_m.
void judge_in_map(const CameraLoop& loop, const TruthTrack& truth, const MapError& map,
                  LoopFigures& figures);

// One JSON object; what is unknown is null.
std::string figures_json(const LoopFigures& figures);
// For people.
std::string figures_table(const LoopFigures& figures);

}  // namespace zonepack::localize
