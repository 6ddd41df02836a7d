// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "packer/record/damage.hpp"
#include "packer/record/record.hpp"

namespace zonepack::packer {

// What is known about a map node before its payloads are read.
struct NodeOutline {
  std::int32_t id = 0;
  std::int32_t map_id = 0;  // the session that recorded it: the layer
  std::int32_t weight = 0;  // -1: intermediate
  double stamp = 0;
  std::string label;
  std::optional<Transform> pose;           // T_map_base, optimised
  std::optional<Transform> odometry_pose;  // T_odom_base
  bool damaged = false;                    // its Damage is in MapOutline::damages
};

// The occupancy grid that RTAB-Map assembled. Row 0 is at y_min; cells are -1 unknown, 0
// free, 100 occupied, int8.
struct OptimisedMap {
  Matrix cells;
  float x_min = 0, y_min = 0;  // metres, the outer corner of cell (0, 0)
  float resolution = 0;        // metres; 0 when the database does not say (before 0.17)
};

// Everything in a source except the payloads of signatures.
//
// Memory: about 200 bytes per node.
struct MapOutline {
  std::string kind = "rtabmap";       // what wrote it, as --from names it
  std::string schema_version;         // "0.23.8"
  std::vector<NodeOutline> nodes;     // ascending id, without deleted ones
  bool numbered_anew = false;         // ids are of this opening only: what is new may shift them
  std::vector<Damage> damages;        // nodes whose own row or optimised pose is damaged
  std::vector<std::string> warnings;  // for the user, complete sentences
  std::vector<std::string> notes;     // how the source was read, where there was a choice

  std::size_t deleted_nodes = 0;       // weight -9, dropped
  bool has_optimised_poses = false;    // whether the database holds any
  std::size_t poses_without_node = 0;  // optimised poses of nodes not above: deleted or never there
  std::size_t landmark_poses = 0;      // optimised poses with negative ids
  std::map<std::int32_t, std::size_t> unlinked_by_session;  // nodes without one, by map_id
  std::uint64_t links_to_missing_nodes = 0;  // Link rows whose to_id > 0 is in no Node row

  std::string parameters;  // "Key:value;Key:value", as RTAB-Map last saved them
  // What found the features, as a manifest's provenance.detector has it; empty when unknown.
  std::string detector;
  std::optional<OptimisedMap> optimised_map;

  bool is_blocks = false;  // its signatures hold blocks of voxels, and nothing else

  // For the size report: what the source itself spends on the nodes above.
  std::uint64_t feature_count = 0;
  std::uint64_t feature_bytes = 0;  // keypoints, points and descriptors
  std::uint64_t scan_bytes = 0;     // zlib blobs as stored
  std::uint64_t grid_bytes = 0;     // ground, obstacle and empty cells
  std::uint64_t block_bytes = 0;    // blocks of voxels as stored

  const NodeOutline* find(std::int32_t id) const noexcept;
  std::size_t unlinked() const noexcept;
  // The value of one RTAB-Map parameter, such as "Kp/DetectorStrategy".
  std::optional<std::string> parameter(std::string_view key) const;
};

// Throws when the database holds no signatures: mapping ended before it saved any.
void require_signatures(const MapOutline& outline, const std::string& database);

}  // namespace zonepack::packer
