// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/sources/map_outline.hpp"

// Where the robot was when it made the map, for a map editor (QGIS).
//
// The files are in metres of the map frame. GeoJSON knows no local frames, so they name EPSG:3857,
// a plane in metres around (0, 0): QGIS then measures and snaps in metres. Never reproject them.
namespace zonepack::packer {

// Nodes that follow each other in one session without a jump; at least two.
struct Path {
  std::int32_t map_id = 0;
  std::vector<const NodeOutline*> nodes;
};

// By session, in order of stamp (then id), of the nodes that have an optimised pose. A path ends
// where two poses jump: where they are more than 1 m and 10 % further apart or nearer together than
// odometry says or, without odometry, more than 10 m apart.
std::vector<Path> paths_of(const MapOutline& outline);

double yaw_rad(const Transform& transform);

// Points with id, map_id, weight, stamp, label, yaw (radians, counter-clockwise from x) and
// yaw_deg.
std::string signatures_geojson(const MapOutline& outline);

// LineStrings with map_id, signatures, length_m, first_stamp, last_stamp.
std::string trajectories_geojson(const std::vector<Path>& paths);

}  // namespace zonepack::packer
