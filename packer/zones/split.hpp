// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "packer/zones/partition.hpp"
#include "packer/zones/zone_plan.hpp"
#include "platform/base/byte_count.hpp"

// Splitting zones that are too large into parts.
//
// A zone whose signatures weigh more than the limit is cut across its length (length_of: the longer
// side of its bounding rectangle of least area) into as few slabs as the limit allows. Cuts lie
// between signatures, where the weights of the slabs are nearly even (within 15 % of a slab) and
// the gap between two signatures is widest. Pieces that come apart become parts of their own, so
// every part is connected. A part that is still too heavy, because its signatures are side by side,
// is cut again along its own length or across it.
//
// Names: ZONE.1, ZONE.2 … in order along the length.
//
// Signatures: assigned among the parts by the rule of partition.hpp; each is in exactly one.
//
// Portals: the stretches of the cuts inside the zone become portals PART-PART between the parts on
// their two sides. A portal of the zone goes to the part it touches; one that crosses a cut is
// split there into PORTAL.1, PORTAL.2 …
namespace zonepack::packer {

struct SplitZone {
  std::string name;
  std::size_t parts = 0;
  ByteCount weight = 0;  // before the split
  // Not 0: some parts are narrower than the precision of a robot's position, which is worth a
  // warning; this limit would avoid them.
  ByteCount narrow_limit = 0;
};

struct SplitPlan {
  ZonePlan plan;
  std::vector<std::uint32_t> zone_of;  // per signature, as in Partition
  std::vector<SplitZone> split;        // zones that were split, by name
};

// `zone_of` (Partition::kNone for dropped signatures) and `weights` are parallel to `signatures`.
// Throws std::runtime_error when one signature, or signatures at one place (kOnePlace_m), weigh
// more than the limit, naming the heaviest of them, their zone and the smallest sufficient limit;
// and when the name of a part is taken or too long.
SplitPlan split_oversized(const ZonePlan& plan, std::span<const SignaturePlace> signatures,
                          std::span<const std::uint32_t> zone_of,
                          std::span<const ByteCount> weights, ByteCount limit);

}  // namespace zonepack::packer
