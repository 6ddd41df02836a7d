// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/zone_metrics.hpp"

#include "platform/base/json_text.hpp"
#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/serve/status_figures.hpp"

namespace zonepack {
namespace {

std::string head(const std::string& name, const char* type, const char* help) {
  return "# HELP " + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
}

// Empty from a zoned that is older than the field.
std::string text_or_unknown(const flatbuffers::String* text) {
  return json_quoted(text != nullptr ? view_of(text) : "unknown");
}

}  // namespace

std::string build_metrics(const wire::Welcome& welcome) {
  const auto* const map = welcome.map_version();
  const std::string map_version =
      map == nullptr ? "unknown" : to_hex({map->data(), map->size()}).substr(0, 16);
  return head("zoned_build_info", "gauge", "What runs, and with which map.") +
         "zoned_build_info{version=" + text_or_unknown(welcome.release()) +
         ",commit=" + text_or_unknown(welcome.commit()) + ",protocol=\"" +
         std::to_string(welcome.version()) + "\",map_version=\"" + map_version + "\"} 1\n";
}

void ZoneMetrics::add(const wire::Zone& zone) {
  const bool charged = zone.state() != wire::ZoneState::Absent;
  rows_.push_back({.labels = "{zone=" + json_quoted(view_of(zone.name())) +
                             ",type=" + json_quoted(view_of(zone.type())) + "} ",
                   .resident = zone.state() == wire::ZoneState::Resident,
                   .charged_bytes = charged ? zone.bytes() : 0,
                   .loads = zone.loads_total(),
                   .evictions = zone.evictions_total(),
                   .entered = zone.entered_total(),
                   .last_load_ns = zone.last_load_ns()});
}

std::string ZoneMetrics::text() const {
  std::string text;
  const auto family = [&](const char* name, const char* type, const char* help, auto value) {
    text += head(name, type, help);
    for (const Row& row : rows_) text += name + row.labels + value(row) + "\n";
  };
  using std::to_string;
  family("zoned_zone_resident", "gauge", "The zone is in memory.",
         [](const Row& row) { return std::string(row.resident ? "1" : "0"); });
  family("zoned_zone_charged_bytes", "gauge", "Charged for the zone.",
         [](const Row& row) { return to_string(row.charged_bytes); });
  family("zoned_zone_loads_total", "counter", "Times the zone was loaded.",
         [](const Row& row) { return to_string(row.loads); });
  family("zoned_zone_evictions_total", "counter", "Times the zone was evicted.",
         [](const Row& row) { return to_string(row.evictions); });
  family("zoned_zone_entered_total", "counter", "Times the robot entered the zone.",
         [](const Row& row) { return to_string(row.entered); });
  family("zoned_zone_last_load_seconds", "gauge", "How long its last load took.",
         [](const Row& row) { return decimal_text(static_cast<double>(row.last_load_ns) / 1e9); });
  return text;
}

}  // namespace zonepack
