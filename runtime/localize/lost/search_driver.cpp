// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/search_driver.hpp"

#include <utility>

namespace zonepack::localize {

Result<void> SearchDriver::begin(std::int64_t now_ns, ZoneId last) {
  if (const auto lost = world_.command(Command::Kind::kLost, kNoZone); !lost) return lost;
  sweep_.begin(now_ns, last);
  watch_.restart();
  sought_ = kNoZone;
  given_ns_.reset();
  begun_ns_ = now_ns;
  return {};
}

void SearchDriver::end() {
  sweep_.end();
  given_ns_.reset();
}

bool SearchDriver::see(std::int64_t stamp_ns, ImageFeatures features) {
  const auto wheels = wheels_.at(stamp_ns);
  if (!wheels) return false;
  sweep_.see({++images_, stamp_ns, *wheels, std::move(features)});
  return true;
}

void SearchDriver::look(ZoneId zone) {
  const auto features = world_.read(zone);
  if (!features) return;
  std::vector<const MapFeatures*> list;
  for (const MapFeatures& one : *features) list.push_back(&one);
  figures_.pairs += sweep_.look(zone, list);
  ++figures_.zones_looked_at;
}

Result<std::vector<FoundFix>> SearchDriver::step(std::int64_t now_ns) {
  if (!active() || waits(now_ns)) return std::vector<FoundFix>{};
  const ZoneId zone = sweep_.next(now_ns, [&](ZoneId asked) { return world_.resident(asked); });
  if (zone != kNoZone && world_.resident(zone)) {
    look(zone);
  } else if (zone != kNoZone && zone != sought_) {
    if (const auto sought = world_.command(Command::Kind::kSeek, zone); !sought) {
      return sought.error();
    }
    sought_ = zone;
  }
  if (sweep_.asks_for_turn(now_ns)) {
    if (const auto asked = world_.command(Command::Kind::kAskTurn, kNoZone); !asked) {
      return asked.error();
    }
    ++figures_.turns_asked;
  }
  auto fixes = sweep_.found(now_ns);
  if (!fixes.empty()) given_ns_ = now_ns;
  return fixes;
}

std::string passed_over_text(const std::string& zone, const std::string& advice) {
  return "zone " + zone +
         " was not loaded in time to be searched: it does not fit next to what is held, or cannot "
         "be read; " +
         advice;
}

}  // namespace zonepack::localize
