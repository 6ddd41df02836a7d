// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/watch_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "platform/base/byte_count.hpp"
#include "platform/base/counted.hpp"
#include "runtime/control/event.hpp"
#include "runtime/ctl/commands/figures.hpp"
#include "runtime/ctl/commands/screen_line.hpp"

namespace zonepack {
namespace {

constexpr double kTimeline_s = 120;
constexpr std::size_t kMostEvents = 200;  // more than fit on any screen
constexpr int kLeastEvents = 5;           // rows that the plan leaves to them
constexpr int kLeastPlanRows = 6, kLeastPlanColumns = 30;
constexpr int kPlanGap = 3, kEventColumns = 45;  // of events to the right of the plan
constexpr int kTitle = 9;                        // columns of the titles on the left
constexpr std::size_t kWidestName = 24;
std::string format(const char* pattern, auto... values) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string pose_words(const wire::PoseReport* pose) {
  if (pose == nullptr || !pose->valid()) return "no pose";
  const double sigma = std::sqrt(std::max(pose->covariance()->xx(), pose->covariance()->yy()));
  return format("x %.2f  y %.2f m  %.0f°  sigma %.2f m%s", pose->pose()->x(), pose->pose()->y(),
                pose->pose()->yaw() * (180 / M_PI), sigma, pose->trusted() ? "" : "  not trusted");
}

std::string timing_words(const wire::Timing* t) {
  if (t == nullptr || t->count() == 0) return "not measured yet";
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) / 1e3; };
  return format("p50 %.1f  p99 %.1f  p99.99 %.1f  max %.1f us", us(t->p50()), us(t->p99()),
                us(t->p9999()), us(t->max()));
}

const char* mark_of(const WatchView::Zone& zone) {
  switch (zone.state) {
    case wire::ZoneState::Resident:
      return "#";
    case wire::ZoneState::Filling:
      return "+";
    case wire::ZoneState::Cancelling:
      return "-";
    default:
      return zone.wanted ? "?" : ".";
  }
}

const char* style_of(const WatchView::Zone& zone) {
  switch (zone.state) {
    case wire::ZoneState::Resident:
      return kGreen;
    case wire::ZoneState::Filling:
    case wire::ZoneState::Cancelling:
      return kYellow;
    default:
      return zone.wanted ? kRed : kDim;
  }
}

std::string budget_line(const wire::Status& status, int columns, bool color) {
  ScreenLine line(columns, color);
  const std::string words =
      " " + short_bytes(status.charged_bytes()) + " of " + short_bytes(status.budget_bytes());
  line.add("budget   ", kBold);
  const int cells = std::clamp(line.left() - static_cast<int>(words.size()) - 2, 4, 60);
  const double share = status.budget_bytes() == 0 ? 0
                                                  : static_cast<double>(status.charged_bytes()) /
                                                        static_cast<double>(status.budget_bytes());
  const int full = static_cast<int>(std::clamp(share, 0.0, 1.0) * cells);
  line.add("[").add(std::string(static_cast<std::size_t>(full), '='), kGreen);
  line.add(std::string(static_cast<std::size_t>(cells - full), ' ')).add("]").add(words);
  return line.done();
}

}  // namespace

std::string event_line(const wire::Event& event) {
  std::string line = format("%12.3f s  ", static_cast<double>(event.t_ns()) / 1e9);
  // A kind of event that only a newer zoned knows is shown by its number.
  line += event.kind() <= wire::EventKind::ZoneKept
              ? to_string(static_cast<EventKind>(event.kind()))
              : format("event %d", static_cast<int>(event.kind()));
  if (event.zone_name() != nullptr) line += " " + event.zone_name()->str();
  if (event.reason() != nullptr) line += ": " + event.reason()->str();
  return line;
}

void WatchView::add_status(const wire::Status& status, double at_s) {
  timeline_.push_back({at_s, std::string(view_of(status.zone())), status.zone_resident()});
  while (timeline_.front().at_s < at_s - kTimeline_s) timeline_.pop_front();
}

void WatchView::add_event(const wire::Event& event) {
  using wire::EventKind;
  if (event.kind() == EventKind::ZoneWanted || event.kind() == EventKind::ZoneUnwanted) return;
  events_.push_back(event_line(event));
  if (events_.size() > kMostEvents) events_.pop_front();
}

std::string WatchView::picture(const wire::Status& status, Size size, bool color) const {
  std::vector<std::string> lines;
  const auto begin = [&](const char* title) {
    ScreenLine line(size.columns, color);
    line.add(title, kBold).pad_to(kTitle);
    return line;
  };
  const std::string zone(view_of(status.zone()));
  lines.push_back(begin("zoned")
                      .add(zone.empty() ? "in no zone" : "in " + zone, kBold)
                      .add("  " + pose_words(status.pose()))
                      .done());
  for (const std::string& complaint : complaints(status)) {
    lines.push_back(begin("").add(complaint, kRed).done());
  }
  lines.push_back(budget_line(status, size.columns, color));
  lines.push_back(
      begin("loaded")
          .add(format("%u of %s, %s  +%llu -%llu  not kept up %llu", status.zones_resident(),
                      counted(status.zones(), "zone").c_str(),
                      counted(status.resident_signatures(), "signature").c_str(),
                      static_cast<unsigned long long>(status.signatures_loaded_total()),
                      static_cast<unsigned long long>(status.signatures_unloaded_total()),
                      static_cast<unsigned long long>(status.not_keeping_up())))
          .done());
  lines.push_back(begin("cycle").add(timing_words(status.cycle())).done());
  lines.push_back(begin("wake-up")
                      .add(timing_words(status.wakeup()))
                      .add(format("  missed %llu",
                                  static_cast<unsigned long long>(status.missed_deadlines_total())))
                      .done());

  // The last two minutes, a column for each moment: names where a zone begins, '!' while the
  // robot's own zone is not in memory.
  ScreenLine timeline = begin("2 min");
  const int cells = timeline.left();
  std::string before;
  std::string label;
  auto sample = timeline_.begin();
  for (int cell = 0; cell < cells && !timeline_.empty(); ++cell) {
    const double at_s = timeline_.back().at_s - kTimeline_s * (cells - 1 - cell) / cells;
    while (std::next(sample) != timeline_.end() && std::next(sample)->at_s <= at_s) ++sample;
    if (sample->at_s > at_s) {
      timeline.add(" ");
      continue;
    }
    if (sample->zone != before) label = before = sample->zone;
    const bool missing = !sample->resident && !sample->zone.empty();
    const std::string shown = label.empty() ? (missing ? "!" : "-") : label.substr(0, 1);
    if (!label.empty()) label.erase(0, 1);
    timeline.add(shown, missing ? kRed : kGreen);
  }
  lines.push_back(timeline.done());

  const std::string more = add_zones(status, size, color, lines);
  const bool has_events = add_plan(status, size, color, lines);
  const auto free =
      static_cast<std::size_t>(std::max(size.rows - static_cast<int>(lines.size()) - 1, 0));
  const std::size_t shown = has_events ? 0 : std::min(events_.size(), free);
  for (std::size_t i = events_.size() - shown; i < events_.size(); ++i) {
    lines.push_back(
        begin(i == events_.size() - shown ? "events" : "").add(events_[i], kDim).done());
  }
  lines.push_back(
      begin("")
          .add(more + "q ends  # in memory  + loading  ? wanted  < robot  P pinned  L leased", kDim)
          .done());
  std::string text;
  for (std::size_t i = 0; i < lines.size() && i < static_cast<std::size_t>(size.rows); ++i) {
    text += lines[i];
  }
  // The last row has no line end, so that the screen does not scroll.
  if (!text.empty() && lines.size() >= static_cast<std::size_t>(size.rows)) text.pop_back();
  return text;
}

// Zones in their order by name, so that each keeps its place; what the legend says of those that
// find no room.
std::string WatchView::add_zones(const wire::Status& status, Size size, bool color,
                                 std::vector<std::string>& lines) const {
  const std::string zone(view_of(status.zone()));
  std::size_t widest = 0;
  for (const Zone& each : zones_) widest = std::max(widest, each.name.size());
  const int cell = static_cast<int>(std::min<std::size_t>(widest, kWidestName)) + 4;
  const int across = std::max((size.columns - kTitle) / cell, 1);
  // The plan and the events come after the zones: they share what is left in halves.
  const int left = size.rows - static_cast<int>(lines.size()) - 1;
  const int others = std::min(static_cast<int>(events_.size()), kLeastEvents);
  const int room = std::max(plan_.empty() ? left - others : std::min(left - others, left / 2), 1);
  std::size_t next = 0;
  for (int shown = 0; next < zones_.size() && shown < room; ++shown) {
    ScreenLine row(size.columns, color);
    row.add(shown == 0 ? "zones" : "", kBold).pad_to(kTitle);
    for (int i = 0; i < across && next < zones_.size(); ++i, ++next) {
      const Zone& each = zones_[next];
      row.add(mark_of(each), style_of(each)).add(each.name.substr(0, kWidestName), style_of(each));
      if (each.name == zone) row.add("<", kBold);
      if (each.pinned) row.add("P");
      if (each.leases > 0) row.add("L");
      row.pad_to(kTitle + cell * (i + 1));
    }
    lines.push_back(row.done());
  }
  return next < zones_.size() ? counted(zones_.size() - next, "zone") + " more;  " : "";
}

// The plan takes the free rows, with the last events to its right where the terminal is wide
// enough (true), else leaves some rows to them.
bool WatchView::add_plan(const wire::Status& status, Size size, bool color,
                         std::vector<std::string>& lines) const {
  const int free = size.rows - static_cast<int>(lines.size()) - 1;
  if (plan_.empty() || free < kLeastPlanRows || size.columns < kLeastPlanColumns) return false;
  const bool beside = plan_.columns_in(free) + kPlanGap + kEventColumns <= size.columns;
  const int rows = beside ? free : free - std::min(static_cast<int>(events_.size()), kLeastEvents);
  if (rows < kLeastPlanRows) return false;
  const std::string zone(view_of(status.zone()));
  std::vector<TextPlan::Shade> shades;
  for (const Zone& each : zones_) {
    const bool resident = each.state == wire::ZoneState::Resident;
    const bool filling = each.state == wire::ZoneState::Filling;
    shades.push_back({.name = each.name,
                      .style = style_of(each),
                      .look = each.name == zone ? TextPlan::Look::kOwn
                              : resident        ? TextPlan::Look::kResident
                              : filling         ? TextPlan::Look::kFilling
                              : each.wanted     ? TextPlan::Look::kWanted
                                                : TextPlan::Look::kAbsent});
  }
  std::optional<TextPlan::Robot> robot;
  if (const wire::PoseReport* const pose = status.pose();
      pose != nullptr && pose->valid() && pose->pose() != nullptr) {
    robot = {pose->pose()->x(), pose->pose()->y(), pose->pose()->yaw()};
  }
  std::vector<ScreenLine> drawn = plan_.draw({size.columns, rows}, shades, robot, color);
  const int right = plan_.columns_in(rows) + kPlanGap;
  const std::size_t shown = std::min(events_.size(), drawn.size());
  for (std::size_t row = 0; row < drawn.size(); ++row) {
    if (beside && row < shown) {
      drawn[row].pad_to(right).add(events_[events_.size() - shown + row], kDim);
    }
    lines.push_back(drawn[row].done());
  }
  return beside;
}

std::string WatchView::line(const wire::Status& status) {
  const std::string zone(view_of(status.zone()));
  std::string text = (zone.empty() ? "in no zone" : "in " + zone) + "  " +
                     pose_words(status.pose()) + "  " + short_bytes(status.charged_bytes()) +
                     " of " + short_bytes(status.budget_bytes()) +
                     format("  %u of ", status.zones_resident()) + counted(status.zones(), "zone");
  for (const std::string& complaint : complaints(status)) {
    text += "  " + complaint.substr(0, complaint.find(':'));
  }
  return text + "\n";
}

}  // namespace zonepack
