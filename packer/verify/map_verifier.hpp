// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/verify/map_files.hpp"
#include "packer/verify/problem.hpp"

namespace zonepack::packer {

// The result of checking a map or a pack.
struct Verdict {
  Problems problems;
  std::size_t packs = 0;             // checked
  std::uint64_t bytes = 0;           // read
  std::size_t signatures = 0;        // decoded
  std::vector<std::string> unnamed;  // packs and parts that the manifest does not name
  bool whole() const { return problems.empty(); }
  std::uint64_t problem_count() const;  // with those that are not listed
};

// Checks a map: the manifest, every pack it names (verify_pack), and that the manifest describes
// them correctly: files, digests, counts, bytes, slots, nodes, edges, and that each signature is
// unique and in the zone that the zone-in rule gives. Without a trustworthy manifest, checks the
// packs in the folder one by one. Lists files that the manifest does not name, without checking
// them.
Verdict verify_map(const MapFiles& map);

// Checks one pack by itself.
Verdict verify_one_pack(const MapFiles& folder, const std::string& name);

}  // namespace zonepack::packer
