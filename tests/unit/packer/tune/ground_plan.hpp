// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/tune/layout.hpp"

// A building for the tests of packer/tune: zones in a row, 2 m wide, from x to x, each with a
// signature in the middle of every metre that takes one slot and 1000 stored bytes.
namespace zonepack::packer::tune {

struct GroundPlan {
  std::vector<Signature> signatures;
  Layout layout;

  void add(const std::string& name, int from_m, int to_m) {
    const double from = from_m, to = to_m;
    TunedZone zone;
    zone.zone.name = name;
    zone.zone.zone_type = "room";
    zone.zone.polygon = {{{from, 0}, {to, 0}, {to, 2}, {from, 2}}, {}};
    for (int x = from_m; x < to_m; ++x) {
      zone.members.push_back(static_cast<std::uint32_t>(signatures.size()));
      signatures.push_back({{static_cast<SignatureId>(signatures.size() + 1), {x + 0.5, 1}, 0},
                            static_cast<ZoneId>(layout.zones.size()),
                            static_cast<double>(kSlotBytes)});
    }
    zone.cost = cost(zone.members.size());
    layout.zones.push_back(zone);
  }

  // A door of 1 m in the middle of the border at x.
  void join(std::uint32_t a, std::uint32_t b, double x_m) {
    layout.portals.push_back({layout.zones[a].zone.name + "-" + layout.zones[b].zone.name,
                              a,
                              b,
                              {{x_m, 0.5}, {x_m, 1.5}}});
  }

  static PackCost cost(std::size_t signatures) {
    return {static_cast<std::uint32_t>(signatures), 1, 1000 * signatures, true};
  }

  std::vector<PlannedZone> zones() const {
    std::vector<PlannedZone> zones;
    for (const TunedZone& zone : layout.zones) zones.push_back(zone.zone);
    return zones;
  }

  // Along y = 1 through these x, at 1 m/s.
  Track drive(const std::string& name, const std::vector<double>& stops) const {
    DrivenPath drive{name, false, {}, 0};
    double t = 0, last = stops.front();
    for (const double x : stops) {
      t += x > last ? x - last : last - x;
      // Poses a metre apart, as those farther than kLostGap_m are not joined.
      for (double at = last; x > last ? at < x : at > x; at += x > last ? 1 : -1) {
        drive.poses.push_back({t, {at, 1}, 0});
      }
      drive.poses.push_back({t, {x, 1}, 0});
      last = x;
    }
    Track track = track_of(drive, name);
    locate(track, zones());
    return track;
  }
};

// B 10 m, A 10 m, C 40 m in a row: 10, 10 and 40 slots.
inline GroundPlan three_rooms() {
  GroundPlan plan;
  plan.add("B", -20, -10);
  plan.add("A", -10, 0);
  plan.add("C", 0, 40);
  plan.join(0, 1, -10);
  plan.join(1, 2, 0);
  return plan;
}

}  // namespace zonepack::packer::tune
