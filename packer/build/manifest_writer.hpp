// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "packer/encode/pack_writer.hpp"
#include "packer/zones/zone_plan.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::packer {

// Sessions (map_id) under one name; both ends of a range included.
struct NamedLayer {
  std::string name;
  std::vector<std::pair<std::int32_t, std::int32_t>> sessions;  // ascending, disjoint
};

// What made a version from the one before.
struct VersionChange {
  Digest32 parent{};  // of the manifest before
  std::string what;
  std::uint32_t zones = 0;  // of the version before, like the next two
  std::uint64_t signatures = 0;
  std::uint64_t pack_bytes = 0;
  // Zones, sorted. Drawn: with another outline, besides those added. Replaced: with no signature of
  // the version before.
  std::vector<std::string> added, removed, changed, drawn, replaced;
};

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
  std::vector<NamedLayer> layers;      // sorted by name
  std::vector<VersionChange> changes;  // oldest first
};

// A signature's entry in the coarse pose graph.
fb::Node node_at(std::int32_t id, const Transform& T_map_base);

// The bytes of manifest.zpm: of minor version 0 without layers and changes. Throws
// std::runtime_error naming the limit of the format that the content exceeds.
Bytes manifest_bytes(const ManifestContent& content);

}  // namespace zonepack::packer
