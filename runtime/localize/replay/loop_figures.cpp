// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/loop_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "platform/process/realtime.hpp"
#include "runtime/odometry/poses_apart.hpp"

namespace zonepack::localize {
namespace {

constexpr double kRight_m = 0.5, kRight_deg = 10;
constexpr double kMs = 1e-6;  // a nanosecond

double turn_deg(double a_rad, double b_rad) {
  return std::abs(turn_rad(b_rad, a_rad)) * 180 / std::numbers::pi;
}

// The longest time without a fix.
double longest_gap_s(const CameraLoop& loop) {
  std::int64_t last = loop.start_ns(), longest = 0;
  for (const LoopView& view : loop.views()) {
    if (!view.result.accepted) continue;
    longest = std::max(longest, view.fix.stamp_ns - last);
    last = view.fix.stamp_ns;
  }
  return static_cast<double>(std::max(longest, loop.end_ns() - last)) * 1e-9;
}

void judge(const CameraLoop& loop, const TruthTrack& truth, LoopFigures& out) {
  std::vector<double> errors;
  out.right = 0;
  out.wrong = 0;
  for (const LoopView& view : loop.views()) {
    if (!view.result.accepted) continue;
    const auto true_pose = truth.at(view.fix.stamp_ns);
    if (!true_pose) continue;
    ++(is_right(view.fix.T_map_base, *true_pose) ? *out.right : *out.wrong);
    errors.push_back(apart_m(view.fix.T_map_base, *true_pose));
  }
  out.fix_error_m = spread_of(std::move(errors));
}

void measure(const CameraLoop& loop, LoopFigures& out) {
  std::vector<double> total;
  std::array<std::vector<double>, kStages> stages;
  for (const LoopView& view : loop.views()) {
    if (view.kind != LoopView::Kind::kQueried) continue;
    total.push_back(static_cast<double>(view.result.cpu_total_ns) * kMs);
    for (std::size_t i = 0; i < kStages; ++i) {
      stages[i].push_back(static_cast<double>(view.result.cpu_ns[i]) * kMs);
    }
  }
  out.query_ms = spread_of(std::move(total));
  for (std::size_t i = 0; i < kStages; ++i) out.stage_ms[i] = spread_of(std::move(stages[i]));
}

}  // namespace

std::optional<Spread> spread_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return Spread{at(0.5), at(0.95), values.back(), at(0.99)};
}

void HeadingWatch::after_cycle(const CycleRecord& cycle, const MapVersion&) noexcept {
  if (truth_ == nullptr || !cycle.state.pose.valid) return;
  const auto truth = truth_->at(cycle.now_ns);
  if (!truth) return;
  errors_deg_.push_back(
      static_cast<float>(turn_deg(cycle.state.pose.T_map_base.yaw_rad, truth->yaw_rad)));
}

std::optional<Spread> HeadingWatch::errors_deg() const {
  return spread_of({errors_deg_.begin(), errors_deg_.end()});
}

bool is_right(const Pose2& fix, const Pose2& truth) noexcept {
  return apart_m(fix, truth) <= kRight_m && turn_deg(fix.yaw_rad, truth.yaw_rad) <= kRight_deg;
}

const char* reason_of(const LoopView& view) noexcept {
  switch (view.kind) {
    case LoopView::Kind::kQueried:
      return to_string(view.result.reason);
    case LoopView::Kind::kNoPose:
      return "no_pose";
    case LoopView::Kind::kSearching:
      return view.result.accepted ? to_string(Reason::kAccepted) : "searching";
    case LoopView::Kind::kUnreadable:
      return "unreadable_image";
  }
  return "unknown";
}

LoopFigures figures_of(const CameraLoop& loop, const RunSummary& run, const HeadingWatch& heading,
                       const TruthTrack* truth) {
  LoopFigures out;
  out.images = loop.views().size();
  for (const LoopView& view : loop.views()) {
    ++out.reasons[reason_of(view)];
    out.accepted += view.result.accepted ? 1 : 0;
  }
  out.longest_gap_s = longest_gap_s(loop);
  if (truth != nullptr) judge(loop, *truth, out);
  out.yaw_error_deg = heading.errors_deg();
  measure(loop, out);
  out.rss_peak_bytes = process_peak_bytes();
  if (const auto found = loop.found_ns()) {
    out.found_after_views = loop.found_after_views();
    out.found_after_s = static_cast<double>(*found - loop.start_ns()) * 1e-9;
  }
  out.fix_distance2 = loop.consistency().mean();
  out.fix_widened = loop.widest();
  out.run = run;
  return out;
}

void judge_in_map(const CameraLoop& loop, const TruthTrack& truth, const MapError& map,
                  LoopFigures& figures) {
  std::vector<double> errors;
  for (const LoopView& view : loop.views()) {
    if (!view.result.accepted) continue;
    const auto true_pose = truth.at(view.fix.stamp_ns);
    const auto mapped = true_pose ? map.in_map(*true_pose) : std::nullopt;
    if (mapped) errors.push_back(apart_m(view.fix.T_map_base, *mapped));
  }
  figures.fix_error_map_m = spread_of(std::move(errors));
}

}  // namespace zonepack::localize
