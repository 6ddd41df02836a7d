// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/figures.hpp"

#include <cmath>
#include <cstdio>

#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/run/event_log.hpp"

namespace zonepack {
namespace {

using Kind = Figure::Kind;

std::string seconds(std::int64_t ns) {
  char text[48];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(ns) / 1e9);
  return text;
}

std::string real(double value) {
  char text[48];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string flag(bool value) { return value ? "1" : "0"; }

double sigma_of(const wire::PoseReport* pose) {
  if (pose == nullptr || pose->covariance() == nullptr) return 0;
  return std::sqrt(std::max(pose->covariance()->xx(), pose->covariance()->yy()));
}

struct Percentile {
  const char* key;
  const char* label;
  std::int64_t ns;
};
std::vector<Percentile> percentiles(const wire::Timing* timing) {
  if (timing == nullptr) return {};
  return {{"p50", "50", timing->p50()},
          {"p99", "99", timing->p99()},
          {"p999", "99.9", timing->p999()},
          {"p9999", "99.99", timing->p9999()},
          {"max", "100", timing->max()}};
}

std::string timing_metric(const char* name, const char* help, const wire::Timing* timing) {
  std::string text = std::string("# HELP ") + name + " " + help + "\n# TYPE " + name + " gauge\n";
  for (const Percentile& p : percentiles(timing)) {
    text += std::string(name) + "{percentile=\"" + p.label + "\"} " + seconds(p.ns) + "\n";
  }
  return text;
}

std::string timing_json(const wire::Timing* timing) {
  std::string text = "{";
  for (const Percentile& p : percentiles(timing)) {
    text += std::string(text.size() > 1 ? "," : "") + "\"" + p.key +
            "\":" + real(static_cast<double>(p.ns) / 1e3);
  }
  return text + "}";
}

template <typename Fn>
void each_line(const wire::Status& status, Fn fn) {
  if (status.lines() == nullptr) return;
  for (const wire::Line* const line : *status.lines())
    fn(*line, std::string(view_of(line->name())));
}

struct LineMetric {
  const char *name, *type, *help;
  std::uint64_t (*value)(const wire::Line&);
};
constexpr LineMetric kLineMetrics[] = {
    {"zoned_line_active", "gauge", "The line is active.",
     [](const wire::Line& line) -> std::uint64_t { return line.active(); }},
    {"zoned_line_working", "gauge", "The line is open, and its last call went well.",
     [](const wire::Line& line) -> std::uint64_t { return line.working(); }},
    {"zoned_line_changes_total", "counter", "Times that the line changed.",
     [](const wire::Line& line) -> std::uint64_t { return line.changes(); }},
    {"zoned_line_failures_total", "counter", "Calls to the line that failed.",
     [](const wire::Line& line) -> std::uint64_t { return line.failures(); }}};

std::string line_metrics(const wire::Status& status) {
  if (status.lines() == nullptr || status.lines()->size() == 0) return {};
  std::string text;
  for (const LineMetric& metric : kLineMetrics) {
    const std::string name = metric.name;
    text += "# HELP " + name + " " + metric.help + "\n# TYPE " + name + " " + metric.type + "\n";
    each_line(status, [&](const wire::Line& line, const std::string& line_name) {
      text += name + "{line=" + json_quoted(line_name) + "} " + std::to_string(metric.value(line)) +
              "\n";
    });
  }
  return text + timing_metric("zoned_map_ready_latency_seconds",
                              "From the end of a load to map_ready's line, by percentile.",
                              status.map_ready_latency());
}

std::string lines_json(const wire::Status& status) {
  std::string text = "{";
  each_line(status, [&](const wire::Line& line, const std::string& name) {
    text += (text.size() > 1 ? "," : "") + json_quoted(name) +
            ":{\"active\":" + (line.active() ? "true" : "false") +
            ",\"working\":" + (line.working() ? "true" : "false") +
            ",\"changes\":" + std::to_string(line.changes()) +
            ",\"failures\":" + std::to_string(line.failures()) + "}";
  });
  return text + "}";
}

// A number that JSON has; what is not finite has none.
std::string json_real(double value) { return std::isfinite(value) ? real(value) : "null"; }

std::string pose_json(const wire::PoseReport* pose) {
  if (pose == nullptr || !pose->valid() || pose->pose() == nullptr) return "null";
  return "{\"x_m\":" + json_real(pose->pose()->x()) + ",\"y_m\":" + json_real(pose->pose()->y()) +
         ",\"yaw_rad\":" + json_real(pose->pose()->yaw()) +
         ",\"sigma_m\":" + json_real(sigma_of(pose)) +
         ",\"trusted\":" + (pose->trusted() ? "true" : "false") + "}";
}

}  // namespace

std::vector<Figure> figures_of(const wire::Status& s) {
  constexpr Kind kCounter = Kind::kCounter, kGauge = Kind::kGauge, kFlag = Kind::kFlag;
  const auto n = [](auto value) { return std::to_string(value); };
  return {
      {"uptime_s", "zoned_uptime_seconds", kGauge, "Time since the server started.",
       seconds(s.uptime_ns())},
      {"map_ready", "zoned_map_ready", kFlag, "The pose is trusted and its zone is in memory.",
       flag(s.map_ready())},
      {"zone_resident", "zoned_own_zone_resident", kFlag, "The robot's own zone is in memory.",
       flag(s.zone_resident())},
      {"pose_trusted", "zoned_pose_trusted", kFlag, "Two absolute fixes agreed.",
       flag(s.pose() != nullptr && s.pose()->trusted())},
      {"pose_sigma_m", "zoned_pose_sigma_meters", kGauge, "Standard deviation of the position.",
       real(sigma_of(s.pose()))},
      {"blocked", "zoned_blocked", kFlag, "A wanted zone does not fit beside what must stay.",
       flag(s.blocked())},
      {"frozen", "zoned_frozen", kFlag, "Nothing is evicted, by command.", flag(s.frozen())},
      {"not_keeping_up", "zoned_not_keeping_up_total", kCounter,
       "Zones entered before they were in memory.", n(s.not_keeping_up())},
      {"map_serial", "zoned_map_serial", kGauge, "Number of the map in use, 1 at the start.",
       n(s.map_serial())},
      {"map_changes", "zoned_map_changes_total", kCounter, "Other versions of the map taken.",
       n(s.map_changes_total())},
      {"map_refusals", "zoned_map_refusals_total", kCounter, "Versions of the map not taken.",
       n(s.map_refusals_total())},
      {"budget_bytes", "zoned_budget_bytes", kGauge, "Hard limit of what grows with the map.",
       n(s.budget_bytes())},
      {"charged_bytes", "zoned_charged_bytes", kGauge, "Bytes charged against the budget.",
       n(s.charged_bytes())},
      {"charged_signatures", "zoned_charged_signatures", kGauge, "Signatures charged for.",
       n(s.charged_signatures())},
      {"resident_signatures", "zoned_resident_signatures", kGauge, "Signatures in memory.",
       n(s.resident_signatures())},
      {"max_signatures", "zoned_max_signatures", kGauge, "Most signatures at once; 0: no limit.",
       n(s.max_signatures())},
      {"zones", "zoned_zones", kGauge, "Zones of the map.", n(s.zones())},
      {"zones_resident", "zoned_zones_resident", kGauge, "Zones in memory.", n(s.zones_resident())},
      {"zones_filling", "zoned_zones_filling", kGauge, "Zones being loaded.", n(s.zones_filling())},
      {"zones_pinned", "zoned_zones_pinned", kGauge, "Zones that are never evicted.",
       n(s.zones_pinned())},
      {"zones_loaded", "zoned_zones_loaded_total", kCounter, "Zones loaded.",
       n(s.zones_loaded_total())},
      {"zones_unloaded", "zoned_zones_unloaded_total", kCounter, "Zones evicted.",
       n(s.zones_unloaded_total())},
      {"signatures_loaded", "zoned_signatures_loaded_total", kCounter, "Signatures loaded.",
       n(s.signatures_loaded_total())},
      {"signatures_unloaded", "zoned_signatures_unloaded_total", kCounter, "Signatures evicted.",
       n(s.signatures_unloaded_total())},
      {"loads_given_up", "zoned_loads_given_up_total", kCounter, "Loads cancelled or failed.",
       n(s.loads_given_up_total())},
      {"leases_revoked", "zoned_leases_revoked_total", kCounter,
       "Leases run out, or in the way of the robot's own zone.", n(s.leases_revoked_total())},
      {"zone_switches", "zoned_zone_switches_total", kCounter, "Times the robot changed its zone.",
       n(s.zone_switches())},
      {"can_frames", "zoned_can_frames_total", kCounter, "CAN frames taken.",
       n(s.can_frames_total())},
      {"can_up", "zoned_can_up", kFlag, "The CAN interface is up, its controller on the bus.",
       flag(s.can_up())},
      {"can_error_frames", "zoned_can_error_frames_total", kCounter,
       "Troubles that the CAN controller told of.", n(s.can_error_frames_total())},
      {"bus_offs", "zoned_bus_offs_total", kCounter, "Times the controller left the bus.",
       n(s.bus_offs_total())},
      {"bus_restarts", "zoned_bus_restarts_total", kCounter, "Times it was started again.",
       n(s.bus_restarts_total())},
      {"can_reopened", "zoned_can_reopened_total", kCounter,
       "Times that the CAN interface vanished and came back.", n(s.can_reopened_total())},
      {"corrections_used", "zoned_corrections_used_total", kCounter, "Fixes that were believed.",
       n(s.fixes_used_total())},
      {"corrections_rejected", "zoned_corrections_rejected_total", kCounter,
       "Fixes that were refused.", n(s.fixes_rejected_total())},
      {"pose_reinitialised", "zoned_pose_reinitialised_total", kCounter,
       "Times that refused fixes agreed and moved the pose.", n(s.pose_reinitialised_total())},
      {"cycles", "zoned_cycles_total", kCounter, "Control cycles.", n(s.cycles())},
      {"missed_deadlines", "zoned_missed_deadlines_total", kCounter,
       "Cycles that began a period or more late.", n(s.missed_deadlines_total())},
      {"skipped_periods", "zoned_skipped_periods_total", kCounter, "Periods without a cycle.",
       n(s.skipped_periods_total())},
      {"deferred_frames", "zoned_deferred_frames_total", kCounter,
       "Cycles that left CAN frames waiting.", n(s.deferred_frames_total())},
      {"dropped_frames", "zoned_dropped_frames_total", kCounter, "CAN frames that were lost.",
       n(s.dropped_frames_total())},
      {"deferred_commands", "zoned_deferred_commands_total", kCounter,
       "Cycles that left commands waiting.", n(s.deferred_commands_total())},
      {"lost_events", "zoned_lost_events_total", kCounter, "Events that were not written.",
       n(s.lost_events_total())},
      {"lost_service_events", "zoned_lost_service_events_total", kCounter,
       "Events that did not reach the server.", n(s.lost_service_events_total())},
      {"lost_records", "zoned_lost_records_total", kCounter, "Cycles missing in the account.",
       n(s.lost_records_total())},
      {"lost_replies", "zoned_lost_replies_total", kCounter, "Replies to commands that were lost.",
       n(s.lost_replies_total())},
      {"lost_recordings", "zoned_lost_recordings_total", kCounter,
       "Cycles that could not be recorded.", n(s.lost_recordings_total())},
      {"realtime", "zoned_realtime", kFlag, "The control thread runs as SCHED_FIFO.",
       flag(s.realtime())},
      {"memory_locked", "zoned_memory_locked", kFlag, "All pages are kept in memory.",
       flag(s.memory_locked())},
      {"minor_faults", "zoned_minor_faults_total", kCounter, "Of the control thread, after start.",
       n(s.minor_faults_total())},
      {"major_faults", "zoned_major_faults_total", kCounter, "Of the control thread, after start.",
       n(s.major_faults_total())},
      {"voluntary_switches", "zoned_voluntary_switches_total", kCounter,
       "Of the control thread, after start.", n(s.voluntary_switches_total())},
      {"involuntary_switches", "zoned_involuntary_switches_total", kCounter,
       "Of the control thread, after start.", n(s.involuntary_switches_total())},
      {"worst_cycle_s", "zoned_worst_cycle_seconds", kGauge, "The longest cycle's own work.",
       seconds(s.worst_cycle_ns())},
      {"clients", "zoned_clients", kGauge, "Programs connected.", n(s.clients())},
      {"leases", "zoned_leases", kGauge, "Leases that readers hold.", n(s.leases())},
      {"requests", "zoned_requests_total", kCounter, "Requests taken.", n(s.requests_total())},
      {"clients_refused", "zoned_clients_refused_total", kCounter, "There were too many.",
       n(s.clients_refused_total())},
      {"clients_dropped", "zoned_clients_dropped_total", kCounter, "Programs that did not keep up.",
       n(s.clients_dropped_total())},
      {"throttled", "zoned_throttled_total", kCounter,
       "Times that a program had asked for all it may.", n(s.throttled_total())},
      {"malformed", "zoned_malformed_total", kCounter, "Messages that were none.",
       n(s.malformed_total())},
      {"events_undelivered", "zoned_events_undelivered_total", kCounter,
       "Events that a slow program lost.", n(s.events_undelivered_total())},
  };
}

std::string metrics_text(const wire::Status& status) {
  std::string text;
  for (const Figure& figure : figures_of(status)) {
    const std::string name = figure.metric;
    text += "# HELP " + name + " " + figure.help + "\n# TYPE " + name +
            (figure.kind == Kind::kCounter ? " counter\n" : " gauge\n") + name + " " +
            figure.value + "\n";
  }
  text +=
      timing_metric("zoned_cycle_seconds", "A cycle's own work, by percentile.", status.cycle());
  text += timing_metric("zoned_wakeup_seconds", "How late cycles begin, by percentile.",
                        status.wakeup());
  text += line_metrics(status);
  const std::string zone(view_of(status.zone()));
  text += "# HELP zoned_zone_info The robot's own zone.\n# TYPE zoned_zone_info gauge\n";
  if (!zone.empty()) text += "zoned_zone_info{zone=" + json_quoted(zone) + "} 1\n";
  return text;
}

std::string map_version(const wire::Status& status) {
  if (status.map_version() == nullptr) return {};
  return to_hex({status.map_version()->data(), status.map_version()->size()});
}

std::string status_json(const wire::Status& status) {
  std::string text = "{\"zone\":";
  const std::string zone(view_of(status.zone()));
  text += zone.empty() ? "null" : json_quoted(zone);
  text += ",\"map_version\":\"" + map_version(status) + "\"";
  text += ",\"pose\":" + pose_json(status.pose());
  for (const Figure& figure : figures_of(status)) {
    const bool is_flag = figure.kind == Kind::kFlag;
    text += std::string(",\"") + figure.key +
            "\":" + (is_flag ? (figure.value == "1" ? "true" : "false") : figure.value);
  }
  text += ",\"cycle_us\":" + timing_json(status.cycle());
  text += ",\"wakeup_us\":" + timing_json(status.wakeup());
  text += ",\"map_ready_latency_us\":" + timing_json(status.map_ready_latency());
  text += ",\"lines\":" + lines_json(status);
  return text + "}\n";
}

std::vector<std::string> line_words(const wire::Status& status) {
  std::vector<std::string> words;
  each_line(status, [&words](const wire::Line& line, const std::string& name) {
    words.push_back(name + (line.active() ? " active" : " inactive") +
                    (line.working() ? "" : ", not working") + ", " +
                    std::to_string(line.changes()) + " changes");
  });
  return words;
}

std::vector<std::string> complaints(const wire::Status& s) {
  std::vector<std::string> lines;
  const std::string zone(view_of(s.zone()));
  if (!zone.empty() && !s.zone_resident()) {
    lines.push_back("NOT KEEPING UP: the robot is in " + zone +
                    ", which is not in memory; raise memory.budget or preload.margin");
  }
  if (s.blocked()) {
    lines.push_back("BLOCKED: a wanted zone does not fit beside what must stay" +
                    std::string(s.frozen() ? "; zonectl unfreeze" : "; raise memory.budget"));
  }
  if (!s.can_up()) {
    lines.push_back("NO CAN BUS: no odometry, the pose gets less sure; ip -details link show");
  }
  if (s.pose() == nullptr || !s.pose()->valid()) {
    lines.push_back("NO POSE: waiting for a fix, or for zonectl pose X Y YAW_DEG");
  } else if (!s.pose()->trusted()) {
    lines.push_back("POSE NOT TRUSTED: until two fixes agree");
  }
  each_line(s, [&lines](const wire::Line& line, const std::string& name) {
    if (!line.working()) {
      lines.push_back("LINE NOT WORKING: " + name + "; see zoned run --check and its log");
    }
  });
  if (!s.realtime()) lines.push_back("NOT REAL-TIME: see zoned run --check");
  if (!s.memory_locked()) lines.push_back("MEMORY NOT LOCKED: see zoned run --check");
  return lines;
}

}  // namespace zonepack
