// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "packer/verify/pack_facts.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

// Compares a checked manifest with what its packs hold.
namespace zonepack::packer {

using Contradictions = std::vector<std::string>;  // "says 12 signatures, the pack holds 11"

// What the manifest says about a zone, but its pack contradicts.
Contradictions zone_contradictions(const fb::Manifest& manifest, const fb::Zone& zone,
                                   const PackFacts& pack);

// The same for the map as a whole: each signature in exactly one zone, the right one; edges;
// portals; provenance. `packs` are by zone; checks that need all of them are skipped when one is
// missing or incomplete.
Contradictions map_contradictions(const fb::Manifest& manifest,
                                  const std::vector<std::optional<PackFacts>>& packs);

}  // namespace zonepack::packer
