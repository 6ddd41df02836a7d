// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/pack_report.hpp"

#include <algorithm>
#include <set>

#include "platform/base/natural_order.hpp"
#include "runtime/report/floor_plan.hpp"
#include "runtime/report/format.hpp"

namespace zonepack::report {
namespace {

std::string bytes_text(ByteCount bytes) { return format_bytes(static_cast<double>(bytes)); }

// For columns, of which all cells have one unit.
std::string mib_text(ByteCount bytes) {
  return format_fixed(static_cast<double>(bytes) / static_cast<double>(kMiB), 2);
}

template <typename Member>
ByteCount sum_of(const PackReport& map, Member member) {
  ByteCount sum = 0;
  for (const PackedZone& zone : map.zones) sum += zone.*member;
  return sum;
}

ByteCount most_charged(const PackReport& map) {
  ByteCount most = 0;
  for (const PackedZone& zone : map.zones) most = std::max(most, zone.charged_bytes);
  return most;
}

std::string hint_of(const PackedZone& zone) {
  std::string text = zone.name;
  if (!zone.zone_type.empty()) text += " (" + zone.zone_type + ")";
  if (!zone.label.empty()) text += ", " + zone.label;
  if (!zone.layer.empty()) text += ", layer " + zone.layer;
  return text + ": " + format_count(zone.signatures) + " signatures, " +
         bytes_text(zone.charged_bytes) + " charged, " + bytes_text(zone.stored_bytes) + " stored";
}

// Layers of zones in order of name; empty where no zone has one.
std::vector<std::string> layers_of(const PackReport& map) {
  std::set<std::string> names;
  for (const PackedZone& zone : map.zones) {
    if (!zone.layer.empty()) names.insert(zone.layer);
  }
  return {names.begin(), names.end()};
}

// One colour for each layer, in zones and in the dots of their signatures.
FloorPlan plan_of_layers(const PackReport& map, const std::vector<std::string>& layers) {
  constexpr double kPale = 0.4;
  FloorPlan plan;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    plan.dots.push_back({.name = layers[i], .color = hue(i), .dots = {}});
  }
  plan.dots.push_back({.name = "no layer", .color = kOther, .dots = {}});
  for (const PackedZone& zone : map.zones) {
    const auto found = std::ranges::find(layers, zone.layer);
    PlanDots& dots = plan.dots[static_cast<std::size_t>(found - layers.begin())];
    plan.zones.push_back({.name = zone.name,
                          .note = bytes_text(zone.charged_bytes),
                          .hint = hint_of(zone),
                          .polygon = zone.polygon,
                          .fill = mix(kWhite, dots.color, kPale)});
    for (const Point2 p : zone.signature_positions) dots.dots.push_back({p, 0, zone.name});
  }
  if (plan.dots.back().dots.empty()) plan.dots.pop_back();
  plan.portals = map.portals;
  plan.raster = map.ground;
  return plan;
}

FloorPlan plan_of(const PackReport& map) {
  if (const auto layers = layers_of(map); !layers.empty()) return plan_of_layers(map, layers);
  const ByteCount most = most_charged(map);
  FloorPlan plan;
  for (const PackedZone& zone : map.zones) {
    const double share =
        most == 0 ? 0 : static_cast<double>(zone.charged_bytes) / static_cast<double>(most);
    plan.zones.push_back({.name = zone.name,
                          .note = bytes_text(zone.charged_bytes),
                          .hint = hint_of(zone),
                          .polygon = zone.polygon,
                          .fill = ramp_color(share)});
    plan.signatures.insert(plan.signatures.end(), zone.signature_positions.begin(),
                           zone.signature_positions.end());
  }
  plan.portals = map.portals;
  plan.raster = map.ground;
  plan.ramp = PlanRamp{"0", bytes_text(most) + " charged"};
  return plan;
}

Table table_of(const PackReport& map) {
  Table table{"Zones",
              "Charged: bytes taken from the budget while the zone is in memory, in whole slots. "
              "Stored: bytes read to load it.",
              {{"Zone"},
               {"Type"},
               {"Label"},
               {"m\xC2\xB2", true},
               {"Signatures", true},
               {"Features", true},
               {"Charged MiB", true},
               {"Stored MiB", true},
               {"Charged / signature", true}},
              {}};
  for (const PackedZone& zone : map.zones) {
    const double each = zone.signatures == 0 ? 0
                                             : static_cast<double>(zone.charged_bytes) /
                                                   static_cast<double>(zone.signatures);
    table.rows.push_back(
        {zone.name, zone.zone_type, zone.label, format_fixed(area_m2(zone.polygon), 1),
         format_count(zone.signatures), format_count(zone.features), mib_text(zone.charged_bytes),
         mib_text(zone.stored_bytes), zone.signatures == 0 ? "" : format_bytes(each)});
  }
  std::ranges::stable_sort(
      table.rows, [](const auto& a, const auto& b) { return natural_less(a.front(), b.front()); });
  return table;
}

}  // namespace

Report make_pack_report(const PackReport& map) {
  const ByteCount charged = sum_of(map, &PackedZone::charged_bytes);
  const std::uint64_t signatures = sum_of(map, &PackedZone::signatures);
  Report page;
  page.title = "Map " + map.map;
  page.headline = format_count(map.zones.size()) + (map.zones.size() == 1 ? " zone" : " zones") +
                  " with " + format_count(signatures) + " signatures. A robot needs at least " +
                  bytes_text(map.smallest_budget_bytes) +
                  " to hold any zone and a neighbour; all at once would take " +
                  bytes_text(map.table_bytes + charged) + ".";
  page.facts = {
      {"smallest budget", bytes_text(map.smallest_budget_bytes),
       format_count(map.smallest_budget_bytes) + " bytes"},
      {"set by", map.smallest_budget_pair, "the pair that needs most together"},
      {"all zones charge", bytes_text(charged), format_count(charged) + " bytes"},
      {"tables and buffers", bytes_text(map.table_bytes), "charged on top, with every zone loaded"},
      {"stored", bytes_text(sum_of(map, &PackedZone::stored_bytes)),
       "read when every zone is loaded once"},
      {"signatures", format_count(signatures),
       format_count(sum_of(map, &PackedZone::features)) + " features"},
      {"zones", format_count(map.zones.size()), format_count(map.portals.size()) + " portals"},
      {"payload", map.payload, "what is loaded of each signature"},
  };
  const FloorPlan plan = plan_of(map);
  page.figures.push_back(
      {"Floor plan",
       (plan.dots.empty()
            ? "The stronger the colour of a zone, the more bytes it takes while it is in memory."
            : "A colour stands for a layer, a part of the map that was recorded in its own "
              "sessions.") +
           std::string(" Dots are signatures, where the camera stood; orange bars are portals, "
                       "where the robot goes from zone to zone.") +
           std::string(map.ground
                           ? " Walls and furniture are what the mapping robot saw, the veil what "
                             "it did not see."
                           : ""),
       draw_floor_plan(plan), draw_floor_plan(narrowed(plan)), plan_json(plan)});
  page.tables.push_back(table_of(map));
  page.origin = map.source + (map.source.empty() ? "" : " ") + "Version " + map.version + ".";
  return page;
}

}  // namespace zonepack::report
