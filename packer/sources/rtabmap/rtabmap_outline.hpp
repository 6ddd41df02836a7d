// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/record/map_outline.hpp"
#include "packer/sources/rtabmap/rtabmap_schema.hpp"
#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {

// The SELECT list of Node that read_node() understands.
std::string node_columns(const RtabmapSchema& schema);

// Reads the identity of a node from a row of node_columns(). The rest of the row starts at
// kFirstNodeDetail: ground_truth_pose, velocity, gps, env_sensors.
inline constexpr int kFirstNodeDetail = 6;
void read_node(const SqliteQuery& row, const CellPlace& place, NodeOutline& node);

// Reads the whole outline. Damage inside one node goes to MapOutline::damages; throws when the
// database as a whole is unusable (optimised poses that do not match their ids).
MapOutline read_outline(const SqliteFile& file, const RtabmapSchema& schema);

}  // namespace zonepack::packer
