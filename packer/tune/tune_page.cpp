// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/tune_page.hpp"

#include <algorithm>
#include <utility>

#include "packer/console/words.hpp"
#include "packer/preview/ground.hpp"
#include "runtime/report/floor_plan.hpp"
#include "runtime/report/format.hpp"

namespace zonepack::packer::tune {
namespace {

using report::format_count;

constexpr std::size_t kMostDots = 3000;  // of all drives, in a picture
constexpr char kArrow[] = " \xE2\x86\x92 ";

std::string listed_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// What a zone takes, as a share of the largest pair: pale to strong.
report::FloorPlan floor_plan_of(const Layout& layout, const std::vector<std::string>& marked,
                                const TunePage& page) {
  report::FloorPlan plan;
  std::size_t index = 0;
  for (const TunedZone& zone : layout.zones) {
    if (!zone.alive) continue;
    const std::string& name = zone.zone.name;
    const bool changes = std::ranges::find(marked, name) != marked.end();
    plan.zones.push_back({.name = name,
                          .note = mib_text(zone.cost.slots * kSlotBytes) + " MiB",
                          .hint = name + ": " + counted(zone.members.size(), "signature") + ", " +
                                  size_text(zone.cost.slots * kSlotBytes) + " charged",
                          .polygon = zone.zone.polygon,
                          .fill = changes ? mix(report::kWhite, report::hue(index++), 0.45)
                                          : mix(report::kWhite, report::hue(0), 0.06)});
  }
  for (const PlannedPortal& portal : layout.portals) plan.portals.push_back(portal.segment);
  std::size_t places = 0;
  for (const Track& track : page.tuned->tracks) places += track.places.size();
  const std::size_t every = places / kMostDots + 1;
  report::PlanDots dots{
      .name = "where the drives went", .color = report::hue(1), .ring = false, .dots = {}};
  for (const Track& track : page.tuned->tracks) {
    for (std::size_t i = 0; i < track.places.size(); i += every) {
      dots.dots.push_back({track.places[i].p_map, 0, track.name});
    }
  }
  plan.dots.push_back(std::move(dots));
  if (page.ground != nullptr) plan.raster = raster_of(*page.ground);
  return plan;
}

report::Table steps_table(const std::string& title, const std::string& caption,
                          const std::vector<Step>& steps, bool reasons) {
  report::Table table{title,
                      caption,
                      {{"Change"},
                       {"Smallest budget, MiB", true},
                       {"Loads", true},
                       {"MiB", true},
                       {"Loads, held out", true},
                       {"MiB, held out", true},
                       {"Drives better / worse", true}},
                      {}};
  if (reasons) table.columns.push_back({"Why not"});
  for (const Step& step : steps) {
    const Judgement& j = step.judgement;
    table.rows.push_back({change_text(step), saved_mib_text(step.smallest_saved),
                          std::to_string(j.training.loads), saved_mib_text(j.training.stored),
                          std::to_string(j.held_out.loads), saved_mib_text(j.held_out.stored),
                          std::to_string(j.helped) + " / " + std::to_string(j.hurt)});
    if (reasons) table.rows.back().push_back(step.reason);
  }
  return table;
}

report::Table drives_table(const Tuned& tuned) {
  report::Table table{"Drives",
                      "With the budget, by the model: the zone used least recently is given up.",
                      {{"Drive"},
                       {"m", true},
                       {"Visits before", true},
                       {"after", true},
                       {"Loads before", true},
                       {"after", true},
                       {"MiB before", true},
                       {"after", true}},
                      {}};
  for (std::size_t i = 0; i < tuned.tracks.size(); ++i) {
    const DriveCost &before = tuned.before.drives[i], &after = tuned.after.drives[i];
    table.rows.push_back({tuned.tracks[i].name, report::format_fixed(tuned.tracks[i].metres, 0),
                          format_count(tuned.before.visits[i]), format_count(tuned.after.visits[i]),
                          format_count(before.loads), format_count(after.loads),
                          mib_text(before.stored), mib_text(after.stored)});
  }
  return table;
}

std::string from_to(const std::string& before, const std::string& after) {
  return before + kArrow + after;
}

}  // namespace

std::string change_text(const Step& step) {
  return (step.kind == Change::Kind::kSplit ? "split " : "merge ") + listed_names(step.names.from) +
         " -> " + listed_names(step.names.into);
}

std::string saved_mib_text(std::int64_t bytes) {
  return (bytes < 0 ? "-" : "") + mib_text(static_cast<ByteCount>(bytes < 0 ? -bytes : bytes));
}

report::Report make_tune_page(const TunePage& page) {
  const Tuned& tuned = *page.tuned;
  const Total &before = tuned.before, &after = tuned.after;
  std::vector<std::string> from, into;
  for (const Step& step : tuned.made) {
    from.insert(from.end(), step.names.from.begin(), step.names.from.end());
    into.insert(into.end(), step.names.into.begin(), step.names.into.end());
  }
  report::Report out;
  out.title = "Zones of " + page.folder + " that fit the drives";
  out.headline = counted(tuned.made.size(), "change") + ": the smallest budget goes from " +
                 mib_text(before.smallest.bytes) + " to " + mib_text(after.smallest.bytes) +
                 " MiB, what the drives read with " + mib_text(page.budget) + " MiB from " +
                 mib_text(before.sum.stored) + " to " + mib_text(after.sum.stored) + " MiB.";
  out.facts = {{"zones", from_to(format_count(before.zones), format_count(after.zones)), ""},
               {"smallest budget, MiB",
                from_to(mib_text(before.smallest.bytes), mib_text(after.smallest.bytes)),
                "set by " + after.smallest.text},
               {"loads", from_to(format_count(before.sum.loads), format_count(after.sum.loads)),
                "of all drives"},
               {"read, MiB", from_to(mib_text(before.sum.stored), mib_text(after.sum.stored)),
                "of all drives"}};
  const std::string caption =
      "Numbers are MiB charged; orange bars are portals, dots are places of the drives. ";
  out.figures.push_back({"Before", caption + "Coloured: zones that are changed.",
                         draw_floor_plan(floor_plan_of(*page.before, from, page))});
  out.figures.push_back({"After", caption + "Coloured: zones that are new.",
                         draw_floor_plan(floor_plan_of(tuned.layout, into, page))});
  out.tables.push_back(steps_table(
      "Changes", "In the order made, with what each saves; less than 0 is what it costs.",
      tuned.made, false));
  if (!tuned.rejected.empty()) {
    out.tables.push_back(
        steps_table("Not made", "What was tried, and why it was left out.", tuned.rejected, true));
  }
  out.tables.push_back(drives_table(tuned));
  out.origin = "Drawn by zonepack tune from " + page.folder + ".";
  return out;
}

}  // namespace zonepack::packer::tune
