// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "packer/tune/driven_path.hpp"
#include "packer/zones/partition.hpp"

// A drive as the zones see it: places a few centimetres apart, and the zones visited.
namespace zonepack::packer::tune {

inline constexpr double kStep_m = 0.05;    // between two places
inline constexpr double kLostGap_m = 10;   // poses farther apart are not joined
inline constexpr double kEntered_m = 0.1;  // so deep in a zone, the robot counts as inside

struct Place {
  Point2 p_map;
  double z_map_m = 0;
  std::uint32_t zone = Partition::kNone;  // that holds it
  float depth_m = 0;                      // to the border of that zone
};

struct Visit {
  std::uint32_t zone = 0;
  std::size_t first = 0, last = 0;  // places
};

struct Track {
  std::string name;
  std::vector<Place> places;
  std::vector<Visit> visits;
  double metres = 0, seconds = 0;
};

// Places along the straight lines between poses; a robot that stands adds none. In no zone yet.
Track track_of(const DrivenPath& drive, std::string name);

// A drive cut into two, at the middle of its time.
std::vector<DrivenPath> halves_of(const DrivenPath& drive);

// Says which zone holds each place, and which zones are visited.
void locate(Track& track, const std::vector<PlannedZone>& zones);

// The zones one after the other, as the robot's tracker has them: another zone counts once the
// robot is kEntered_m deep in it; outside of all, the last one lasts.
std::vector<Visit> visits_of(const std::vector<Place>& places);

}  // namespace zonepack::packer::tune
