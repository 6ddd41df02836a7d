// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/figures/summary_text.hpp"

#include <iostream>
#include <string_view>
#include <type_traits>

#include "platform/base/counted.hpp"
#include "platform/base/json_text.hpp"
#include "platform/base/number_text.hpp"
#include "platform/files/atomic_file.hpp"

namespace zonepack {
namespace {

// "2.33 MiB (2441160 bytes)".
std::string bytes_text(ByteCount bytes) {
  return decimals_text(static_cast<double>(bytes) / static_cast<double>(kMiB), 2) + " MiB (" +
         counted(bytes, "byte") + ")";
}

class JsonObject {
 public:
  template <typename T>
  void add(std::string_view key, T value) {
    text_ += text_.empty() ? "{\n  " : ",\n  ";
    text_ += json_quoted(key) + ": ";
    if constexpr (std::is_integral_v<T>) {
      text_ += std::to_string(value);
    } else if constexpr (std::is_floating_point_v<T>) {
      text_ += shortest_number(value);
    } else {
      text_ += value;
    }
  }
  std::string finish() { return text_ + "\n}\n"; }

 private:
  std::string text_;
};

std::string number_json(const std::optional<double>& value) {
  return value ? shortest_number(*value) : "null";
}

std::string with_reasons(std::uint64_t rejected, const std::string& why) {
  return std::to_string(rejected) + (why.empty() ? "" : " (" + why + ")");
}

std::string error_json(const std::optional<PoseError>& error) {
  if (!error) return "null";
  return "{\"p50\": " + shortest_number(error->p50) + ", \"p95\": " + shortest_number(error->p95) +
         ", \"max\": " + shortest_number(error->max) + "}";
}

std::string timing_json(const LiveFigures::Timing& timing) {
  return "{\"p50\": " + shortest_number(timing.p50) + ", \"p99\": " + shortest_number(timing.p99) +
         ", \"p999\": " + shortest_number(timing.p999) +
         ", \"p9999\": " + shortest_number(timing.p9999) +
         ", \"max\": " + shortest_number(timing.max) + "}";
}

std::string worst_json(const LiveFigures::Worst& worst) {
  return "{\"cycle\": " + std::to_string(worst.cycle) + ", \"us\": " + shortest_number(worst.us) +
         ", \"step\": " + json_quoted(worst.step) +
         ", \"step_us\": " + shortest_number(worst.step_us) +
         ", \"frames\": " + std::to_string(worst.frames) +
         ", \"corrections\": " + std::to_string(worst.corrections) +
         ", \"loads\": " + std::to_string(worst.loads) +
         ", \"commands\": " + std::to_string(worst.commands) + "}";
}

void add_live(JsonObject& json, const LiveFigures& live) {
  json.add("process_peak_bytes", live.process_peak_bytes);
  json.add("overhead_bytes", live.overhead_bytes);
  json.add("minor_faults", live.minor_faults);
  json.add("major_faults", live.major_faults);
  json.add("allocations", live.allocations);
  json.add("missed_deadlines", live.missed_deadlines);
  json.add("cycle_us", timing_json(live.cycle_us));
  json.add("wakeup_us", timing_json(live.wakeup_us));
  json.add("map_ready_latency_us", timing_json(live.ready_us));
  json.add("map_ready_latency_count", live.ready_count);
  json.add("lines_not_working", live.lines_not_working);
  json.add("worst_cycle", worst_json(live.worst));
  json.add("lost_events", live.lost_events);
  json.add("realtime", live.realtime ? "true" : "false");
  json.add("memory_locked", live.memory_locked ? "true" : "false");
}

}  // namespace

std::string summary_json(const RunSummary& s) {
  JsonObject json;
  json.add("budget_bytes", s.budget_bytes);
  json.add("peak_charged_bytes", s.peak_charged_bytes);
  json.add("budget_violations", s.budget_violations);
  json.add("max_signatures", s.max_signatures);
  json.add("peak_signatures", s.peak_signatures);
  json.add("signatures_loaded", s.signatures_loaded);
  json.add("signatures_unloaded", s.signatures_unloaded);
  json.add("zones_loaded", s.zones_loaded);
  json.add("zones_unloaded", s.zones_unloaded);
  json.add("bytes_loaded", s.bytes_loaded);
  json.add("zone_switches", s.zone_switches);
  json.add("localised", s.localised ? "true" : "false");
  json.add("start_s", number_json(s.localised ? std::optional(s.start_s) : std::nullopt));
  json.add("zone_absent_s",
           number_json(s.localised ? std::optional(s.zone_absent_s) : std::nullopt));
  json.add("blocked_s", s.blocked_s);
  json.add("wrong_zone_s", number_json(s.wrong_zone_s));
  json.add("pose_error_m", error_json(s.pose_error_m));
  json.add("cycles", s.cycles);
  json.add("can_frames", s.can_frames);
  json.add("can_rejected", s.can_rejected);
  json.add("corrections_used", s.corrections_used);
  json.add("corrections_rejected", s.corrections_rejected);
  json.add("event_log_hash", json_quoted(s.event_log_hash));
  if (s.live) add_live(json, *s.live);
  return json.finish();
}

std::string summary_table(const RunSummary& s) {
  std::string text;
  const auto row = [&text](std::string_view name, const std::string& value) {
    text += "  ";
    text += name;
    text.append(name.size() < 26 ? 26 - name.size() : 1, ' ');
    text += value + '\n';
  };
  const auto count = [](std::uint64_t n) { return std::to_string(n); };
  if (!s.localised) {
    row("NEVER LOCALISED", "the robot's own zone was never known and in memory");
  }
  row("budget", bytes_text(s.budget_bytes));
  row("most charged", bytes_text(s.peak_charged_bytes));
  row("cycles over a limit", count(s.budget_violations) + " of " + count(s.cycles));
  row("most signatures", count(s.peak_signatures) +
                             (s.max_signatures > 0 ? ", limit " + count(s.max_signatures) : ""));
  row("signatures loaded",
      count(s.signatures_loaded) + ", unloaded " + count(s.signatures_unloaded));
  row("zones loaded", count(s.zones_loaded) + ", unloaded " + count(s.zones_unloaded));
  row("read from storage", bytes_text(s.bytes_loaded));
  row("zone switches", count(s.zone_switches));
  row("first zone resident",
      s.zones_loaded == 0 ? "never" : "after " + decimals_text(s.start_s, 2) + " s");
  row("own zone absent", s.localised ? decimals_text(s.zone_absent_s, 2) + " s" : "always");
  row("waiting for room", decimals_text(s.blocked_s, 2) + " s");
  if (s.wrong_zone_s) row("in a wrong zone", decimals_text(*s.wrong_zone_s, 2) + " s");
  if (s.pose_error_m) {
    row("pose error", "median " + decimals_text(s.pose_error_m->p50, 3) + " m, 95 % " +
                          decimals_text(s.pose_error_m->p95, 3) + " m, most " +
                          decimals_text(s.pose_error_m->max, 3) + " m");
  }
  row("CAN frames",
      count(s.can_frames) + ", rejected " + with_reasons(s.can_rejected, s.can_rejected_why));
  row("corrections used", count(s.corrections_used) + ", rejected " +
                              with_reasons(s.corrections_rejected, s.corrections_rejected_why));
  row("event log", s.event_log_hash);
  if (s.live) {
    const auto timing = [](const LiveFigures::Timing& t) {
      return "median " + decimals_text(t.p50, 1) + " us, 99 % " + decimals_text(t.p99, 1) +
             " us, 99.99 % " + decimals_text(t.p9999, 1) + " us, most " + decimals_text(t.max, 1) +
             " us";
    };
    row("process, at most", bytes_text(s.live->process_peak_bytes));
    row("besides the map", bytes_text(s.live->overhead_bytes));
    row("control thread", counted(s.live->minor_faults + s.live->major_faults, "page fault") +
                              ", " + counted(s.live->allocations, "allocation") + ", " +
                              counted(s.live->missed_deadlines, "missed deadline"));
    row("cycle", timing(s.live->cycle_us));
    row("wake-up", timing(s.live->wakeup_us));
    if (s.live->ready_count > 0) row("load to map_ready", timing(s.live->ready_us));
    if (!s.live->realtime || !s.live->memory_locked || s.live->lines_not_working > 0) {
      row("DEGRADED", std::string(s.live->realtime ? "" : "not real-time ") +
                          (s.live->memory_locked ? "" : "memory not locked ") +
                          (s.live->lines_not_working == 0
                               ? ""
                               : counted(s.live->lines_not_working, "line") + " not working"));
    }
  }
  return text;
}

Outcome<void> check_limits(const RunSummary& summary) {
  if (summary.budget_violations == 0) return {};
  return failure("a limit was exceeded in " + counted(summary.budget_violations, "cycle"),
                 ErrorCode::kTooLarge);
}

Outcome<void> write_summary(const RunSummary& summary, const std::string& json_path,
                            bool output_is_taken) {
  Failures failed;
  const bool json_on_output = json_path == "-";
  std::ostream& output = output_is_taken ? std::cerr : std::cout;
  output << (json_on_output ? summary_json(summary) : summary_table(summary)) << std::flush;
  if (!std::cout) failed.add(failure("standard output: cannot be written", ErrorCode::kIo));
  if (!json_on_output && !json_path.empty()) {
    const auto written = write_file_atomically(json_path, summary_json(summary));
    if (!written) failed.add(cannot_write(json_path, written.error()));
  }
  return failed.all();
}

}  // namespace zonepack
