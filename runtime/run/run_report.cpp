// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/run_report.hpp"

#include <algorithm>

#include "runtime/report/format.hpp"
#include "runtime/run/figures/run_figures.hpp"

namespace zonepack {
namespace {

using report::Fact;
using report::format_bytes;
using report::format_count;
using report::format_fixed;
using report::format_number;
using report::format_seconds;
using report::Report;

std::string short_bytes(ByteCount bytes) { return format_bytes(static_cast<double>(bytes)); }

std::string percent(ByteCount part, ByteCount whole) {
  return format_number(100 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

std::string grouped_count(std::uint64_t count, const char* one, const char* many) {
  return format_count(count) + " " + (count == 1 ? one : many);
}

std::string headline(const RunSummary& s) {
  std::string text = grouped_count(s.signatures_loaded, "signature", "signatures") + " loaded, " +
                     format_count(s.signatures_unloaded) + " unloaded. ";
  if (s.budget_violations > 0) {
    return text + "The limit was exceeded in " +
           grouped_count(s.budget_violations, "cycle.", "cycles.");
  }
  text += "The map never took more than " + short_bytes(s.peak_charged_bytes);
  if (s.budget_bytes > 0) {
    text += " of its budget of " + short_bytes(s.budget_bytes) + " (" +
            percent(s.peak_charged_bytes, s.budget_bytes) + ")";
  }
  if (!s.localised) {
    return text + ", but the robot was never localised: its own zone was never in memory.";
  }
  return text + (s.zone_absent_s > 0 ? ", but the robot's own zone was missing for " +
                                           format_seconds(s.zone_absent_s) + "."
                                     : ", and the robot's own zone was always in memory.");
}

std::vector<Fact> facts_of(const RunReportInput& input) {
  const RunSummary& s = input.summary;
  std::vector<Fact> facts = {
      {"budget", short_bytes(s.budget_bytes), format_count(s.budget_bytes) + " bytes"},
      {"most charged", short_bytes(s.peak_charged_bytes),
       format_count(s.peak_charged_bytes) + " bytes"},
      {"over a limit", grouped_count(s.budget_violations, "cycle", "cycles"),
       "of " + format_count(s.cycles), s.budget_violations > 0},
      {"most signatures", format_count(s.peak_signatures),
       s.max_signatures > 0 ? "limit " + format_count(s.max_signatures)
                            : "no limit on their number"},
      {"zones loaded, unloaded",
       format_count(s.zones_loaded) + ", " + format_count(s.zones_unloaded),
       short_bytes(s.bytes_loaded) + " loaded"},
      s.localised ? Fact{"own zone not in memory", format_seconds(s.zone_absent_s),
                         "after the start of " + format_seconds(s.start_s), s.zone_absent_s > 0}
                  : Fact{"own zone not in memory", "always", "the robot was never localised", true},
      {"waiting for room", format_seconds(s.blocked_s), "a wanted zone did not fit"},
      {"zone switches", format_count(s.zone_switches),
       s.wrong_zone_s ? format_seconds(*s.wrong_zone_s) + " in a wrong zone"
                      : "no truth, so nothing is known of wrong zones"},
  };
  if (s.pose_error_m) {
    facts.push_back({"pose error, median", format_number(s.pose_error_m->p50, 3) + " m",
                     "95 %: " + format_number(s.pose_error_m->p95, 3) +
                         " m, most: " + format_number(s.pose_error_m->max, 3) + " m"});
  }
  facts.push_back({"corrections used", format_count(s.corrections_used),
                   format_count(s.corrections_rejected) + " rejected"});
  if (!input.baseline.empty()) {
    const BaselineRow& last = input.baseline.back();
    facts.push_back({"RTAB-Map loaded, unloaded",
                     format_number(last.loaded, 0) + ", " + format_number(last.unloaded, 0),
                     "signatures, on the same run"});
  }
  return facts;
}

std::string with_baseline(std::string caption, const RunReportInput& input, const char* more) {
  if (!input.baseline.empty()) caption.append(" ").append(more);
  return caption;
}

bool has_truth(const RunTrace& trace) {
  return std::ranges::any_of(trace.samples, &TraceSample::has_truth);
}

void add_figures(const RunReportInput& input, Report& page) {
  const RunTrace& trace = input.trace;
  const bool truth = has_truth(trace);
  const report::FloorPlan plan = route_plan(trace, zone_colors(trace));
  page.figures.push_back(
      {"The route, from above",
       std::string("The way the robot believed to drive, from the circle to the square, in the "
                   "colour of the zone it believed to be in; zones it never entered are grey.") +
           (truth ? " Dashed: the true way." : ""),
       report::draw_floor_plan(plan), report::draw_floor_plan(report::narrowed(plan)),
       report::plan_json(plan)});
  const auto add_chart = [&page](const char* title, std::string caption,
                                 const report::Chart& chart) {
    page.figures.push_back({title, std::move(caption), report::draw_chart(chart),
                            report::draw_chart(report::narrowed(chart)),
                            report::chart_json(chart)});
  };
  add_chart("Signatures loaded and unloaded since the start",
            with_baseline("Each step is a zone that was loaded or unloaded as a whole; the band "
                          "below names the zone the robot was in. The fewer the better: every "
                          "step is reading and decoding.",
                          input, "RTAB-Map moves single signatures in and out all the time."),
            loading_chart(trace, input.baseline));
  add_chart("Signatures in memory",
            with_baseline("Those resident and those being loaded; together they may not pass the "
                          "limit.",
                          input,
                          "RTAB-Map starts with the whole map and unloads until its threshold "
                          "holds."),
            signatures_chart(trace, input.baseline));
  add_chart("Bytes charged",
            "All memory that grows with the map, in the units it is handed out in; a zone counts "
            "from the moment its load begins. The line may touch the budget and never cross it.",
            bytes_chart(trace));
  if (!truth) return;
  add_chart("Error of the pose",
            "How far the believed position was from the true one. Corrections pull it down, wheel "
            "slip and late or wrong corrections push it up.",
            pose_error_chart(trace));
}

report::Playback playback_of(const RunTrace& trace) {
  report::Playback playback;
  playback.duration_s = trace.duration_s;
  ZoneId zone = kNoZone;
  for (const TraceSample& s : trace.samples) {
    playback.poses.push_back(
        {s.t_s, s.pose_valid, {s.estimate.x_m, s.estimate.y_m}, s.estimate.yaw_rad});
    if (s.tracked_zone == zone) continue;
    if (zone < trace.zones.size()) playback.stays.back().to_s = s.t_s;
    zone = s.tracked_zone;
    if (zone < trace.zones.size()) playback.stays.push_back({zone, s.t_s, trace.duration_s});
  }
  for (const TraceHold& hold : trace.holds) {
    playback.holds.push_back({hold.zone, hold.from_s, hold.ready_s, hold.to_s});
  }
  for (const TraceEvent& event : trace.events) {
    playback.events.push_back(
        {event.t_s, event.event,
         event.zone < trace.zones.size() ? std::size_t{event.zone} : report::PlayEvent::kNoZone});
  }
  return playback;
}

// Seconds spent in every zone, as the tracker saw it.
std::vector<double> stays_s(const RunTrace& trace) {
  std::vector<double> stays(trace.zones.size(), 0);
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    const TraceSample& s = trace.samples[i];
    const double until = i + 1 < trace.samples.size() ? trace.samples[i + 1].t_s : trace.duration_s;
    if (s.tracked_zone < stays.size()) stays[s.tracked_zone] += until - s.t_s;
  }
  return stays;
}

void add_zone_table(const RunTrace& trace, Report& page) {
  report::Table table{
      "Zones visited",
      "What each zone charges while it is in memory.",
      {{"Zone"}, {"Type"}, {"Signatures", true}, {"Charged bytes", true}, {"Seconds inside", true}},
      {}};
  const std::vector<double> stays = stays_s(trace);
  for (std::size_t i = 0; i < trace.zones.size(); ++i) {
    const TraceZone& zone = trace.zones[i];
    if (stays[i] <= 0) continue;
    table.rows.push_back({zone.name, zone.zone_type, format_count(zone.signatures),
                          format_count(zone.charged_bytes), format_fixed(stays[i], 1)});
  }
  if (!table.rows.empty()) page.tables.push_back(std::move(table));
}

}  // namespace

Report make_run_report(const RunReportInput& input) {
  Report page;
  page.title = "Replay of " + input.recording;
  page.headline = headline(input.summary);
  page.facts = facts_of(input);
  add_figures(input, page);
  add_zone_table(input.trace, page);
  page.playback = playback_of(input.trace);
  page.origin = "Map " + input.map + ", " + format_count(input.summary.cycles) + " cycles, " +
                format_count(input.summary.can_frames) + " CAN frames (" +
                format_count(input.summary.can_rejected) + " rejected) in " +
                format_seconds(input.trace.duration_s) + ". Event log " +
                input.summary.event_log_hash + ".";
  return page;
}

Report make_run_picture(const RunReportInput& input) {
  const RunTrace& trace = input.trace;
  report::Chart loading = loading_chart(trace, input.baseline);
  report::Chart bytes = bytes_chart(trace);
  loading.plot_height_px = 140;
  bytes.plot_height_px = 110;
  Report page;
  page.headline = headline(input.summary);
  page.figures.push_back({"", "", report::draw_floor_plan(route_plan(trace, zone_colors(trace)))});
  page.figures.push_back(
      {"Signatures loaded and unloaded since the start", "", report::draw_chart(loading)});
  page.figures.push_back({"Bytes charged", "", report::draw_chart(bytes)});
  return page;
}

}  // namespace zonepack
