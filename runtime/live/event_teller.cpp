// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/event_teller.hpp"

#include <iostream>
#include <string>

namespace zonepack {
namespace {

std::string line_of(const Event& event, const Catalog& catalog) {
  const std::string zone = event.zone == kNoZone ? std::string() : catalog.zones[event.zone].name;
  switch (event.kind) {
    case EventKind::kLoadFailed:
      return "zone " + zone + " cannot be loaded: " + catalog.folder + "/" +
             catalog.zones[event.zone].pack + ": " + event.reason +
             "; it is tried again; build the map again or copy the pack again, zonepack verify "
             "tells more";
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

void EventTeller::on_event(const Event& event) noexcept {
  next_.on_event(event);
  const std::string line = line_of(event, catalog_);
  if (!line.empty()) std::cerr << "zoned: " + line + "\n";
}

}  // namespace zonepack
