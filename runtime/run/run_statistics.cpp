// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/run_statistics.hpp"

#include <algorithm>

namespace zonepack {
namespace {

constexpr double kWrongDepth_m = 0.3;
constexpr double kSamplePeriod_s = 0.0999;  // ten a second, rounding aside

// Keeps the first of every two.
template <typename T>
void halve(std::vector<T>& all) {
  for (std::size_t i = 1; 2 * i < all.size(); ++i) all[i] = std::move(all[2 * i]);
  all.resize((all.size() + 1) / 2);
}

// The value that this share of all is not above (nearest rank).
double percentile(const std::vector<float>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5);
  return static_cast<double>(sorted[rank]);
}

}  // namespace

CycleRecord record_of(std::int64_t now_ns, const CycleState& state, const Residency& memory) {
  return {now_ns,          state, memory.used_sum(), memory.resident_sum(), memory.counters(),
          memory.charged()};
}

RunStatistics::RunStatistics(const ZoneGraph& graph, std::span<const ZoneNeed> needs,
                             const TruthTrack* truth, std::int64_t period_ns,
                             const ResidencyLimits& limits)
    : graph_(&graph),
      needs_(needs),
      truth_(truth),
      period_ns_(period_ns),
      limits_(limits),
      held_(needs.size(), Held::kNot),
      sample_period_s_(kSamplePeriod_s) {}

void RunStatistics::change_map(const ZoneGraph& graph, std::span<const ZoneNeed> needs,
                               const ResidencyLimits& limits) {
  if (drawn_names_.empty()) {
    for (ZoneId zone = 0; zone < needs_.size(); ++zone) drawn_names_.push_back(graph_->name(zone));
  }
  drawn_.clear();
  for (ZoneId zone = 0; zone < needs.size(); ++zone) {
    const auto same = std::ranges::find(drawn_names_, graph.name(zone));
    drawn_.push_back(same == drawn_names_.end() ? kNoZone
                                                : static_cast<ZoneId>(same - drawn_names_.begin()));
  }
  // Those that are kept are counted again, as the new map's.
  for (ZoneId zone = 0; zone < held_.size(); ++zone) {
    if (held_[zone] != Held::kNot) charged_.remove(needs_[zone]);
  }
  graph_ = &graph;
  needs_ = needs;
  limits_ = limits;
  held_.assign(needs.size(), Held::kNot);
  holds_.end_all(static_cast<double>(now_ns_ - start_ns_) * 1e-9);
  true_zone_ = kNoZone;
}

// As the drawing names it.
ZoneId RunStatistics::drawn(ZoneId zone) const noexcept {
  return drawn_names_.empty() || zone == kNoZone ? zone : drawn_[zone];
}

void RunStatistics::begin_with(ZoneId zone) noexcept {
  held_[zone] = Held::kResident;
  charged_.add(needs_[zone]);
  if (keeps_trace_) {
    holds_.begin(zone, 0);
    holds_.ready(zone, 0);
  }
}

void RunStatistics::on_event(const Event& event) noexcept {
  if (keeps_trace_ && events_seen_++ % event_stride_ == 0) {
    trace_.events.push_back(
        {static_cast<double>(event.t_ns) * 1e-9, to_string(event.kind), drawn(event.zone)});
    if (trace_.events.size() >= kMostTraceEvents) {
      halve(trace_.events);
      event_stride_ *= 2;
    }
  }
  if (keeps_trace_ && event.zone != kNoZone) keep_hold(event);
  switch (event.kind) {
    case EventKind::kLoadStarted:
      held_[event.zone] = Held::kCharged;
      charged_.add(needs_[event.zone]);
      break;
    case EventKind::kLoadDone:
      held_[event.zone] = Held::kResident;
      break;
    case EventKind::kZoneKept:
      held_[event.zone] = Held::kResident;
      charged_.add(needs_[event.zone]);
      break;
    case EventKind::kLoadGivenUp:
    case EventKind::kLoadFailed:
    case EventKind::kEvicted:
      held_[event.zone] = Held::kNot;
      charged_.remove(needs_[event.zone]);
      break;
    default:
      break;
  }
}

void RunStatistics::keep_hold(const Event& event) {
  const ZoneId zone = drawn(event.zone);
  const double t_s = static_cast<double>(event.t_ns) * 1e-9;
  if (zone == kNoZone) return;  // not on the drawing
  switch (event.kind) {
    case EventKind::kLoadStarted:
      holds_.begin(zone, t_s);
      break;
    case EventKind::kLoadDone:
      holds_.ready(zone, t_s);
      break;
    case EventKind::kZoneKept:
      holds_.begin(zone, t_s);
      holds_.ready(zone, t_s);
      break;
    case EventKind::kLoadGivenUp:
    case EventKind::kLoadFailed:
    case EventKind::kEvicted:
      holds_.end(zone, t_s);
      break;
    default:
      break;
  }
}

RunTrace RunStatistics::take_trace() {
  trace_.holds = holds_.take(static_cast<double>(now_ns_ - start_ns_) * 1e-9);
  return std::move(trace_);
}

void RunStatistics::after_cycle(const CycleRecord& cycle) {
  if (cycles_ == 0) start_ns_ = cycle.now_ns;
  now_ns_ = cycle.now_ns;
  ++cycles_;
  counters_ = cycle.counters;
  check_limits(cycle);
  watch_zone(cycle);
  blocked_cycles_ += cycle.state.blocked;
  if (true_pose_ && cycle.state.pose.valid) {
    const Pose2 &truth = *true_pose_, &estimate = cycle.state.pose.T_map_base;
    keep_error(distance_m(Point2{truth.x_m, truth.y_m}, Point2{estimate.x_m, estimate.y_m}));
  }
  if (keeps_trace_) keep_sample(cycle);
}

void RunStatistics::keep_error(double error_m) {
  worst_error_m_ = std::max(worst_error_m_, static_cast<float>(error_m));
  if (errors_seen_++ % error_stride_ != 0) return;
  errors_m_.push_back(static_cast<float>(error_m));
  if (errors_m_.size() < kMostErrors) return;
  halve(errors_m_);
  error_stride_ *= 2;
}

void RunStatistics::check_limits(const CycleRecord& cycle) {
  peak_.slots = std::max(peak_.slots, charged_.slots);
  peak_.signatures = std::max(peak_.signatures, charged_.signatures);
  peak_bytes_ = std::max(peak_bytes_, cycle.charged_bytes);
  const bool over_bytes = limits_.fixed > limits_.budget || cycle.charged_bytes > limits_.budget ||
                          charged_.slots * limits_.slot_bytes > limits_.budget - limits_.fixed;
  const bool over_signatures =
      limits_.max_signatures > 0 && charged_.signatures > limits_.max_signatures;
  const bool differs =
      charged_.slots != cycle.charged.slots || charged_.signatures != cycle.charged.signatures;
  violations_ += over_bytes || over_signatures || differs;
}

void RunStatistics::watch_zone(const CycleRecord& cycle) {
  const CycleState& state = cycle.state;
  true_pose_ = truth_ != nullptr ? truth_->at(now_ns_) : std::nullopt;
  ZoneId own = state.zone;
  if (true_pose_) {
    ++true_cycles_;
    const Point2 place{true_pose_->x_m, true_pose_->y_m};
    const ZoneId holding = graph_->zone_at(place);
    if (holding != kNoZone) true_zone_ = holding;
    own = true_zone_;
    wrong_cycles_ += true_zone_ != kNoZone && state.zone != kNoZone && state.zone != true_zone_ &&
                     graph_->depth_m(true_zone_, place) > kWrongDepth_m;
  } else {
    true_zone_ = kNoZone;
  }
  if (!first_resident_ && cycle.counters.zones_loaded > 0) first_resident_ = cycles_ - 1;
  if (own != kNoZone && !graph_->loadable(own)) own = kNoZone;
  localised_ = localised_ || (own != kNoZone && held_[own] == Held::kResident);
  absent_ = first_resident_ && own != kNoZone && held_[own] != Held::kResident;
  absent_cycles_ += absent_;
}

void RunStatistics::keep_sample(const CycleRecord& cycle) {
  const CycleState& state = cycle.state;
  TraceSample sample;
  sample.t_s = static_cast<double>(now_ns_ - start_ns_) * 1e-9;
  sample.pose_valid = state.pose.valid;
  sample.pose_trusted = state.pose.trusted;
  sample.estimate = state.pose.T_map_base;
  sample.has_truth = true_pose_.has_value();
  if (true_pose_) sample.truth = *true_pose_;
  sample.tracked_zone = drawn(state.zone);
  sample.true_zone = drawn(true_zone_);
  sample.zone_absent = absent_;
  sample.blocked = state.blocked;
  sample.charged_bytes = limits_.fixed + charged_.slots * limits_.slot_bytes;
  sample.charged_signatures = charged_.signatures;
  sample.resident_signatures = cycle.resident.signatures;
  sample.signatures_loaded = cycle.counters.signatures_loaded;
  sample.signatures_unloaded = cycle.counters.signatures_unloaded;
  if (!trace_.samples.empty()) {
    const TraceSample& last = trace_.samples.back();
    const bool same = last.tracked_zone == sample.tracked_zone &&
                      last.true_zone == sample.true_zone &&
                      last.zone_absent == sample.zone_absent && last.blocked == sample.blocked &&
                      last.charged_bytes == sample.charged_bytes &&
                      last.charged_signatures == sample.charged_signatures &&
                      last.signatures_loaded == sample.signatures_loaded &&
                      last.signatures_unloaded == sample.signatures_unloaded;
    if (same && sample.t_s - last.t_s < sample_period_s_) return;
  }
  trace_.samples.push_back(sample);
  if (trace_.samples.size() >= kMostSamples) thin_samples();
}

void RunStatistics::thin_samples() {
  const auto worse = [](const TraceSample& a, const TraceSample& b) {
    const bool a_trouble = a.zone_absent || a.blocked, b_trouble = b.zone_absent || b.blocked;
    return a_trouble != b_trouble ? a_trouble : a.charged_bytes > b.charged_bytes;
  };
  std::vector<TraceSample>& all = trace_.samples;
  std::size_t kept = 1;  // the first stays: drawings begin with it
  for (std::size_t i = 1; i + 1 < all.size(); i += 2) {
    all[kept++] = worse(all[i + 1], all[i]) ? all[i + 1] : all[i];
  }
  if (all.size() % 2 == 0) all[kept++] = all.back();
  all.resize(kept);
  sample_period_s_ *= 2;
}

double RunStatistics::seconds(std::uint64_t cycles) const noexcept {
  return static_cast<double>(cycles) * static_cast<double>(period_ns_) / 1e9;
}

void RunStatistics::summarise(RunSummary& summary) const {
  summary.budget_bytes = limits_.budget;
  summary.peak_charged_bytes =
      std::max(limits_.fixed + peak_.slots * limits_.slot_bytes, peak_bytes_);
  summary.budget_violations = violations_;
  summary.max_signatures = limits_.max_signatures;
  summary.peak_signatures = peak_.signatures;
  summary.signatures_loaded = counters_.signatures_loaded;
  summary.signatures_unloaded = counters_.signatures_unloaded;
  summary.zones_loaded = counters_.zones_loaded;
  summary.zones_unloaded = counters_.zones_unloaded;
  summary.start_s = seconds(first_resident_.value_or(cycles_));
  summary.zone_absent_s = seconds(absent_cycles_);
  summary.blocked_s = seconds(blocked_cycles_);
  if (true_cycles_ > 0) summary.wrong_zone_s = seconds(wrong_cycles_);
  summary.localised = localised_;
  summary.cycles = cycles_;
  if (!errors_m_.empty()) {
    std::vector<float> sorted = errors_m_;
    std::sort(sorted.begin(), sorted.end());
    summary.pose_error_m = PoseError{percentile(sorted, 0.5), percentile(sorted, 0.95),
                                     static_cast<double>(worst_error_m_)};
  }
}

}  // namespace zonepack
