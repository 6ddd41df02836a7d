// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "packer/verify/pack_facts.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

// Holding a checked manifest against what its packs hold.
namespace zonepack::packer {

using Contradictions = std::vector<std::string>;  // "says 12 signatures, the pack holds 11"

// What the manifest says of a zone that its pack contradicts.
Contradictions zone_contradictions(const fb::Manifest& manifest, const fb::Zone& zone,
                                   const PackFacts& pack);

// What it says of the map as a whole: signatures in one zone each and in the right one, edges,
// portals, provenance. `packs` are by zone; checks that need all of them are left out when one is
// missing or not complete.
Contradictions map_contradictions(const fb::Manifest& manifest,
                                  const std::vector<std::optional<PackFacts>>& packs);

}  // namespace zonepack::packer
