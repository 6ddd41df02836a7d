// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <string_view>

#include "platform/base/byte_count.hpp"
#include "platform/base/json_text.hpp"
#include "platform/base/number_text.hpp"
#include "runtime/localize/check/calibration_text.hpp"
#include "runtime/localize/replay/loop_figures.hpp"

namespace zonepack::localize {
namespace {

// The members of an object without its braces.
std::string members(const Spread& spread) {
  return "\"p50\": " + shortest_number(spread.p50) + ", \"p95\": " + shortest_number(spread.p95) +
         (spread.p99 ? ", \"p99\": " + shortest_number(*spread.p99) : "") +
         ", \"max\": " + shortest_number(spread.max);
}

std::string json_of(const std::optional<Spread>& spread) {
  return spread ? "{" + members(*spread) + "}" : "null";
}

template <typename T>
std::string json_of(const std::optional<T>& value) {
  if (!value) return "null";
  if constexpr (std::is_floating_point_v<T>) {
    return shortest_number(*value);
  } else {
    return std::to_string(*value);
  }
}

std::optional<Spread> spread(const std::optional<PoseError>& error) {
  if (!error) return std::nullopt;
  return Spread{error->p50, error->p95, error->max, std::nullopt};
}

std::string queries_json(const LoopFigures& figures) {
  if (!figures.query_ms) return "null";
  std::string text = "{" + members(*figures.query_ms) + ", \"stages\": {";
  for (std::size_t i = 0; i < kStages; ++i) {
    if (i > 0) text += ", ";
    text += json_quoted(to_string(static_cast<Stage>(i))) + ": " + json_of(figures.stage_ms[i]);
  }
  return text + "}}";
}

std::string reasons_json(const LoopFigures& figures) {
  std::string text;
  for (const auto& [name, count] : figures.reasons) {
    if (!text.empty()) text += ", ";
    text += json_quoted(name) + ": " + std::to_string(count);
  }
  return "{" + text + "}";
}

// "p50 3.8, p95 6.9, at most 12.1 cm".
std::string in_words(const std::optional<Spread>& spread, double scale, int decimals,
                     const char* unit) {
  if (!spread) return "unknown";
  return "p50 " + decimals_text(spread->p50 * scale, decimals) + ", p95 " +
         decimals_text(spread->p95 * scale, decimals) + ", at most " +
         decimals_text(spread->max * scale, decimals) + " " + unit;
}

std::string percent(std::size_t part, std::size_t whole) {
  return decimals_text(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

}  // namespace

std::string figures_json(const LoopFigures& f) {
  std::string text;
  const auto add = [&](std::string_view key, const std::string& value) {
    text += text.empty() ? "{\n  " : ",\n  ";
    text += json_quoted(key) + ": " + value;
  };
  add("images", std::to_string(f.images));
  add("accepted", std::to_string(f.accepted));
  add("right", json_of(f.right));
  add("wrong", json_of(f.wrong));
  add("longest_gap_s", shortest_number(f.longest_gap_s));
  add("fix_error_m", json_of(f.fix_error_m));
  add("fix_error_map_m", json_of(f.fix_error_map_m));
  add("pose_error_m", json_of(spread(f.run.pose_error_m)));
  add("yaw_error_deg", json_of(f.yaw_error_deg));
  add("wrong_zone_s", json_of(f.run.wrong_zone_s));
  add("zone_absent_s", f.run.localised ? shortest_number(f.run.zone_absent_s) : "null");
  add("budget_violations", std::to_string(f.run.budget_violations));
  add("query_ms", queries_json(f));
  add("rss_peak_bytes", std::to_string(f.rss_peak_bytes));
  add("found_after_views", json_of(f.found_after_views));
  add("found_after_s", json_of(f.found_after_s));
  add("times_lost", std::to_string(f.lost.times_lost));
  add("lost_s", shortest_number(f.lost.lost_s));
  add("zones_searched", std::to_string(f.lost.zones_looked_at));
  add("turns_asked", std::to_string(f.lost.turns_asked));
  add("reasons", reasons_json(f));
  add("fix_consistency", "{\"distance2\": " + shortest_number(f.fix_distance2) +
                             ", \"expected\": 3, \"widened\": " + shortest_number(f.fix_widened) +
                             "}");
  add("calibration", report_json(f.calibration));
  add("budget_bytes", std::to_string(f.run.budget_bytes));
  add("peak_charged_bytes", std::to_string(f.run.peak_charged_bytes));
  add("corrections_used", std::to_string(f.run.corrections_used));
  add("corrections_rejected", std::to_string(f.run.corrections_rejected));
  add("cycles", std::to_string(f.run.cycles));
  add("event_log_hash", json_quoted(f.run.event_log_hash));
  return text + "\n}\n";
}

std::string figures_table(const LoopFigures& f) {
  std::string text;
  const auto add = [&](const char* name, const std::string& value) {
    std::string line = name;
    line.resize(24, ' ');
    text += line + value + '\n';
  };
  add("images", std::to_string(f.images));
  std::string fixes = std::to_string(f.accepted);
  if (f.images > 0) fixes += " (" + percent(f.accepted, f.images) + ")";
  if (f.right) fixes += ", right " + std::to_string(*f.right);
  if (f.wrong) fixes += ", wrong " + std::to_string(*f.wrong);
  add("fixes", fixes);
  std::string why;
  for (const auto& [name, count] : f.reasons) {
    if (name == to_string(Reason::kAccepted)) continue;
    why += (why.empty() ? "" : ", ") + name + " " + std::to_string(count);
  }
  if (!why.empty()) add("no fix", why);
  add("longest gap", decimals_text(f.longest_gap_s, 1) + " s");
  add("fix error", in_words(f.fix_error_m, 100, 1, "cm"));
  add("  in the map's frame", in_words(f.fix_error_map_m, 100, 1, "cm"));
  add("pose error", in_words(spread(f.run.pose_error_m), 100, 1, "cm"));
  add("heading error", in_words(f.yaw_error_deg, 1, 2, "degrees"));
  if (f.calibration.enough) {
    std::string traits;
    for (const CalibrationFinding& finding : f.calibration.findings) {
      traits += (traits.empty() ? "" : ", ") + std::string(name_of(finding.trait)) + " off by " +
                value_text(finding);
    }
    add("calibration", traits.empty() ? "nothing seems wrong" : traits);
  }
  add("in a wrong zone",
      f.run.wrong_zone_s ? decimals_text(*f.run.wrong_zone_s, 2) + " s" : "unknown");
  add("own zone absent",
      f.run.localised ? decimals_text(f.run.zone_absent_s, 2) + " s" : "always: never localised");
  add("budget", format_byte_count(f.run.budget_bytes) + ", at most charged " +
                    format_byte_count(f.run.peak_charged_bytes) + ", over a limit in " +
                    std::to_string(f.run.budget_violations) + " cycles");
  add("query", in_words(f.query_ms, 1, 1, "ms of CPU"));
  add("peak memory", format_byte_count(f.rss_peak_bytes));
  add("pose trusted after", f.found_after_s
                                ? std::to_string(f.found_after_views.value_or(0)) + " images, " +
                                      decimals_text(*f.found_after_s, 1) + " s"
                                : "never");
  if (f.lost.times_lost > 0) {
    add("lost", std::to_string(f.lost.times_lost) + " times, for " +
                    decimals_text(f.lost.lost_s, 1) + " s until found, " +
                    std::to_string(f.lost.zones_looked_at) + " looks at a zone, a turn asked for " +
                    std::to_string(f.lost.turns_asked) + " times");
  }
  add("event_log_hash", f.run.event_log_hash);
  return text;
}

}  // namespace zonepack::localize
