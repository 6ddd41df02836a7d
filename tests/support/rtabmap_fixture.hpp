// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "packer/record/map_outline.hpp"
#include "packer/record/record.hpp"

// Small RTAB-Map databases made by tests, in the schema of any version from 0.11 to 0.23.
namespace zonepack::test_support {

// What a database should hold. A signature's `pose` goes to Admin.opt_poses, its other fields to
// the tables; weight -9 makes a deleted node.
struct RtabmapFixture {
  std::string version = "0.23.8";
  std::vector<packer::SignatureRecord> signatures;
  std::map<std::int32_t, packer::Transform> extra_poses;  // landmarks, or nodes that do not exist
  bool optimised_poses = true;                            // false: none are saved, as after a crash
  std::optional<packer::OptimisedMap> optimised_map;
  std::string parameters = "Kp/DetectorStrategy:8;Kp/MaxFeatures:400";
};

// Writes the database, replacing a file of that name.
void write_rtabmap_database(const std::filesystem::path& path, const RtabmapFixture& fixture);

// Removes from a record what the schema of `version` has no place for, so that it reads back equal.
// Before 0.13 a link keeps two variances only: the inverses of information [0] and [35], which
// should be powers of two so that they invert exactly.
packer::SignatureRecord as_schema_holds(packer::SignatureRecord record, const std::string& version);

// Changes a database made above: any SQL, with one blob for ?1 where it has one.
void execute(const std::filesystem::path& path, const std::string& sql);
void execute(const std::filesystem::path& path, const std::string& sql, const packer::Bytes& blob);

}  // namespace zonepack::test_support
