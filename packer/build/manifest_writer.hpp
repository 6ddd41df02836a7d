// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/encode/pack_writer.hpp"
#include "packer/zones/zone_plan.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::packer {

struct ManifestContent {
  const ZonePlan* plan = nullptr;
  const std::vector<PackSummary>* packs = nullptr;  // by zone
  std::vector<std::vector<fb::Node>> nodes;         // by zone, in order of id
  std::vector<fb::ZoneEdge> edges;                  // a < b, sorted
  Digest16 lineage{};
  PayloadMask payload = 0;
  std::string source_kind, source_version, options, detector;
  std::uint64_t source_feature_count = 0;
  std::uint64_t source_bytes = 0;
};

// The bytes of manifest.zpm. Throws std::runtime_error naming the limit of the format that the
// content exceeds.
Bytes manifest_bytes(const ManifestContent& content);

}  // namespace zonepack::packer
