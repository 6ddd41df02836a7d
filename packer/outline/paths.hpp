// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/record/map_outline.hpp"

// Where the robot was while it recorded the map, for a map editor (QGIS).
//
// The files are in metres of the map frame. GeoJSON has no local frames, so they declare EPSG:3857,
// a plane in metres around (0, 0): QGIS then measures and snaps in metres. Never reproject them.
namespace zonepack::packer {

// Consecutive nodes of one session without a jump between them; at least two.
struct Path {
  std::int32_t map_id = 0;
  std::vector<const NodeOutline*> nodes;
};

// The paths of all sessions, over the nodes that have an optimised pose, in order of stamp (then
// id). A path ends where two poses jump: where their distance differs from that of odometry by more
// than 1 m plus 10 % or, without odometry, exceeds 10 m.
std::vector<Path> paths_of(const MapOutline& outline);

double yaw_rad(const Transform& transform);

// Points with id, map_id, weight, stamp, label, yaw (radians, counter-clockwise from x) and
// yaw_deg.
std::string signatures_geojson(const MapOutline& outline);

// LineStrings with map_id, signatures, length_m, first_stamp, last_stamp.
std::string trajectories_geojson(const std::vector<Path>& paths);

}  // namespace zonepack::packer
