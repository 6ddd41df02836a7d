// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/answer_json.hpp"

#include "platform/base/counted.hpp"
#include "platform/base/json_text.hpp"
#include "runtime/ctl/commands/watch_view.hpp"
#include "runtime/run/event_log.hpp"
#include "runtime/serve/status_figures.hpp"

namespace zonepack {
namespace {

const char* truth(bool value) { return value ? "true" : "false"; }

std::string line_json(const wire::Event& from) {
  // A kind that only a newer zoned knows has no word here.
  if (from.kind() > wire::EventKind::ZoneKept) {
    return "{\"cycle\":" + std::to_string(from.cycle()) +
           ",\"t_ns\":" + std::to_string(from.t_ns()) + ",\"event\":\"event_" +
           std::to_string(static_cast<int>(from.kind())) + "\"}\n";
  }
  Event event;
  event.kind = static_cast<EventKind>(from.kind());
  event.cycle = from.cycle();
  event.t_ns = from.t_ns();
  event.zone = from.zone_name() != nullptr ? from.zone() : kNoZone;
  event.generation = from.generation();
  event.signatures = from.signatures();
  event.bytes = from.bytes();
  event.charged_signatures = from.charged_signatures();
  event.charged_bytes = from.charged_bytes();
  event.reason = from.reason() != nullptr ? from.reason()->c_str() : nullptr;
  event.has_pose = from.has_pose();
  event.x_mm = from.x_mm();
  event.y_mm = from.y_mm();
  event.yaw_mrad = from.yaw_mrad();
  return event_json(event, view_of(from.zone_name()));
}

}  // namespace

std::string zone_json(const wire::Zone& zone) {
  return "{\"zone\":" + json_quoted(view_of(zone.name())) +
         ",\"type\":" + json_quoted(view_of(zone.type())) +
         ",\"state\":" + json_quoted(to_string(zone.state())) +
         ",\"wanted\":" + truth(zone.wanted()) + ",\"pinned\":" + truth(zone.pinned()) +
         ",\"leases\":" + std::to_string(zone.leases()) +
         ",\"signatures\":" + std::to_string(zone.signatures()) +
         ",\"bytes\":" + std::to_string(zone.bytes()) +
         ",\"generation\":" + std::to_string(zone.generation()) +
         ",\"loads\":" + std::to_string(zone.loads_total()) +
         ",\"evictions\":" + std::to_string(zone.evictions_total()) +
         ",\"entered\":" + std::to_string(zone.entered_total()) + ",\"last_load_s\":" +
         (zone.loads_total() == 0 ? "null"
                                  : decimal_text(static_cast<double>(zone.last_load_ns()) / 1e9)) +
         "}";
}

std::string route_json(const wire::Route& route) {
  std::string zones, doors;
  for (const flatbuffers::String* const name : *route.names()) {
    zones += (zones.empty() ? "" : ",") + json_quoted(view_of(name));
  }
  for (const wire::Place* const door : *route.doors()) {
    doors += std::string(doors.empty() ? "" : ",") + "{\"x_m\":" + decimal_text(door->x()) +
             ",\"y_m\":" + decimal_text(door->y()) + "}";
  }
  return "{\"length_m\":" + decimal_text(route.length()) + ",\"zones\":[" + zones +
         "],\"doors\":[" + doors + "],\"more\":" + truth(route.more()) +
         ",\"hinted\":" + truth(route.hinted()) + "}\n";
}

std::string notice_json(const wire::Reply& notice) {
  std::string text;
  if (const wire::Events* const events = notice.body_as_Events();
      events != nullptr && events->events() != nullptr) {
    for (const wire::Event* const event : *events->events()) text += line_json(*event);
  }
  if (const wire::Lost* const lost = notice.body_as_Lost()) {
    text += "{\"event\":\"events_lost\",\"events\":" + std::to_string(lost->events()) + "}\n";
  }
  if (const wire::MapChanged* const map = notice.body_as_MapChanged()) {
    text += "{\"event\":\"map_in_use\",\"map_serial\":" + std::to_string(map->map_serial()) +
            ",\"zones\":" + std::to_string(map->zones()) + "}\n";
  }
  return text;
}

std::string notice_text(const wire::Reply& notice) {
  std::string text;
  if (const wire::Events* const events = notice.body_as_Events();
      events != nullptr && events->events() != nullptr) {
    for (const wire::Event* const event : *events->events()) text += event_line(*event) + '\n';
  }
  if (const wire::Lost* const lost = notice.body_as_Lost()) {
    text += "(" + counted(lost->events(), "event") + " lost)\n";
  }
  if (notice.body_as_MapChanged() != nullptr) text += "(another map)\n";
  return text;
}

}  // namespace zonepack
