// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace zonepack::packer::tune {

Track track_of(const DrivenPath& drive, std::string name) {
  Track track;
  track.name = std::move(name);
  track.seconds = drive.poses.back().t_s - drive.poses.front().t_s;
  const auto add = [&](Point2 p, double z) { track.places.push_back({.p_map = p, .z_map_m = z}); };
  add(drive.poses.front().p_map, drive.poses.front().z_map_m);
  for (const DrivePose& pose : drive.poses) {
    const Place last = track.places.back();
    const double way = distance_m(last.p_map, pose.p_map);
    if (way < kStep_m) continue;
    if (way > kLostGap_m) {
      add(pose.p_map, pose.z_map_m);
      continue;
    }
    track.metres += way;
    const auto steps = static_cast<std::size_t>(std::ceil(way / kStep_m));
    for (std::size_t i = 1; i <= steps; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(steps);
      add({last.p_map.x_m + t * (pose.p_map.x_m - last.p_map.x_m),
           last.p_map.y_m + t * (pose.p_map.y_m - last.p_map.y_m)},
          last.z_map_m + t * (pose.z_map_m - last.z_map_m));
    }
  }
  return track;
}

std::vector<DrivenPath> halves_of(const DrivenPath& drive) {
  const double middle =
      drive.poses.front().t_s + (drive.poses.back().t_s - drive.poses.front().t_s) / 2;
  std::vector<DrivenPath> halves(2, DrivenPath{drive.file, drive.fixes, {}, 0});
  for (const DrivePose& pose : drive.poses) {
    halves[pose.t_s < middle || halves[0].poses.empty() ? 0 : 1].poses.push_back(pose);
  }
  if (halves[1].poses.empty()) halves[1].poses.push_back(drive.poses.back());
  return halves;
}

void locate(Track& track, const std::vector<PlannedZone>& zones) {
  const ZoneLookup lookup(zones);
  for (Place& place : track.places) {
    place.zone = lookup.at(place.p_map, place.z_map_m);
    place.depth_m =
        place.zone == Partition::kNone
            ? 0
            : static_cast<float>(distance_to_border_m(zones[place.zone].polygon, place.p_map));
  }
  track.visits = visits_of(track.places);
}

std::vector<Visit> visits_of(const std::vector<Place>& places) {
  std::vector<Visit> visits;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& place = places[i];
    if (!visits.empty()) visits.back().last = i;
    if (place.zone == Partition::kNone) continue;
    if (visits.empty()) {
      visits.push_back({place.zone, i, i});
    } else if (place.zone != visits.back().zone && place.depth_m >= kEntered_m) {
      if (i > visits.back().first) visits.back().last = i - 1;
      visits.push_back({place.zone, i, i});
    }
  }
  return visits;
}

}  // namespace zonepack::packer::tune
