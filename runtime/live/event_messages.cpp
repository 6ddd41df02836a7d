// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/event_messages.hpp"

#include <string>
#include <string_view>

#include "runtime/live/print_line.hpp"

namespace zonepack {
namespace {

std::string remedy_of(std::string_view reason) {
  if (reason == "no room") {
    return "; zonepack plan tells the budget with which maps change while the robot drives, and "
           "where the robot's zone is small there may be room";
  }
  if (reason == "frozen") return "; zonectl unfreeze, then reload again";
  return "; the robot goes on with it";
}

std::string line_of(const Event& event, const Catalog& catalog) {
  const std::string zone = event.zone == kNoZone ? std::string() : catalog.zones[event.zone].name;
  switch (event.kind) {
    case EventKind::kLoadFailed:
      return "zone " + zone + " cannot be loaded: " + catalog.folder + "/" +
             catalog.zones[event.zone].pack + ": " + event.reason +
             "; it is tried again; build the map again or copy the pack again, zonepack verify "
             "tells more";
    case EventKind::kMapChanged:
      return "map changed: " + catalog.folder + " is in use, version " + to_hex(catalog.version);
    case EventKind::kMapRefused:
      return std::string("map not changed: ") + event.reason + "; version " +
             to_hex(catalog.version) + " stays in use" + remedy_of(event.reason);
    case EventKind::kNotKeepingUp:
      return "not keeping up: the robot entered zone " + zone +
             " before it was loaded; drive slower, or raise the budget, preload.margin or the "
             "storage's rate";
    case EventKind::kOdometryStale:
      return "odometry is missing: no frame of it for odometry.timeout; look at the bus and at "
             "can.interface";
    case EventKind::kOdometryResumed:
      return "odometry is there";
    default:
      return {};
  }
}

}  // namespace

void EventMessages::on_event(const Event& event, const MapVersion& map) noexcept {
  const std::string line = line_of(event, map.catalog());
  if (!line.empty()) print_line(line);
}

}  // namespace zonepack
