// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/given_drives.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "packer/console/words.hpp"
#include "packer/zones/findings.hpp"
#include "runtime/report/format.hpp"

namespace zonepack::packer::tune {
namespace {

constexpr double kMostMetres = 500'000;  // of all drives: 320 MB of places
constexpr double kMuchOutside = 0.1;     // of a drive's places in no zone, worth a warning

std::vector<DrivenPath> read_drives(const std::vector<std::string>& files, const Layout& layout,
                                    const std::string& folder) {
  std::vector<DrivenPath> drives;
  double metres = 0;
  for (const std::string& file : files) {
    DrivenPath drive = read_driven_path(file);
    for (std::size_t i = 1; i < drive.poses.size(); ++i) {
      metres += distance_m(drive.poses[i - 1].p_map, drive.poses[i].p_map);
    }
    if (metres > kMostMetres) {
      throw std::runtime_error(file + ": the drives are longer than " +
                               report::format_fixed(kMostMetres / 1000, 0) +
                               " km up to here; give fewer, or a path in metres");
    }
    for (const DrivenPath& other : drives) {
      const bool same =
          std::ranges::equal(other.poses, drive.poses, [](const DrivePose& a, const DrivePose& b) {
            return a.t_s == b.t_s && a.p_map == b.p_map;
          });
      if (!same) continue;
      throw std::runtime_error(file + ": is the same drive as " + other.file +
                               ", so that changes would be judged on what they were chosen on; "
                               "give it once");
    }
    const bool floors = std::ranges::any_of(
        layout.zones, [](const TunedZone& zone) { return zone.zone.z_min_m || zone.zone.z_max_m; });
    if (drive.fixes && floors) {
      throw std::runtime_error(file + ": holds fixes, which have no height, but zones of " +
                               folder +
                               " lie above each other; give a path, stamp x y z qx qy qz qw");
    }
    drives.push_back(std::move(drive));
  }
  return drives;
}

// One track a drive; of a single drive, its halves.
std::vector<Track> tracks_of(const std::vector<DrivenPath>& drives, const std::string& folder,
                             const Layout& layout, std::vector<std::string>& warnings) {
  std::vector<PlannedZone> zones;
  for (const TunedZone& zone : layout.zones) zones.push_back(zone.zone);
  std::vector<Track> tracks;
  for (const DrivenPath& drive : drives) {
    Track track = track_of(drive, drive.file);
    locate(track, zones);
    if (track.visits.empty()) {
      const Point2 p = drive.poses.front().p_map;
      throw std::runtime_error(drive.file + ": is never in a zone of " + folder +
                               "; it begins at " + point_text(p) +
                               ", expected metres of the map's frame");
    }
    const auto outside = std::ranges::count(track.places, Partition::kNone, &Place::zone);
    if (static_cast<double>(outside) > kMuchOutside * static_cast<double>(track.places.size())) {
      warnings.push_back(
          drive.file + ": " +
          std::to_string(100 * static_cast<std::size_t>(outside) / track.places.size()) +
          " % of it lie in no zone; is it of this building, in the map's frame?");
    }
    if (drive.left_out > 0) {
      warnings.push_back(drive.file + ": " + counted(drive.left_out, "fix", "fixes") +
                         " left out that are metres off those before and after");
    }
    tracks.push_back(std::move(track));
  }
  if (drives.size() > 1) return tracks;
  const std::vector<DrivenPath> halves = halves_of(drives.front());
  tracks.clear();
  for (std::size_t i = 0; i < halves.size(); ++i) {
    tracks.push_back(
        track_of(halves[i], drives.front().file + (i == 0 ? ", first half" : ", second half")));
    locate(tracks.back(), zones);
    if (tracks.back().visits.size() < 2) {
      throw std::runtime_error(
          drives.front().file + ": its " + (i == 0 ? "first" : "second") +
          " half enters no second zone, so it cannot judge what the other half suggests; give "
          "longer or more drives");
    }
  }
  return tracks;
}

}  // namespace

GivenDrives read_given_drives(const std::vector<std::string>& files, const Layout& layout,
                              const std::string& folder) {
  GivenDrives given;
  given.drives = read_drives(files, layout, folder);
  given.halves = given.drives.size() == 1;
  given.tracks = tracks_of(given.drives, folder, layout, given.warnings);
  return given;
}

}  // namespace zonepack::packer::tune
