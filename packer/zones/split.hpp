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
// the gap between two signatures is widest. What comes apart is a part of its own: every part is
// connected. A part that is still too heavy, because its signatures stand side by side, is cut
// again along its own length or across it.
//   Names: ZONE.1, ZONE.2 … in order along the length.
//   Signatures: by the rule of partition.hpp among the parts; each is in exactly one.
//   Inner portals, PART-PART: the stretches of the cuts inside the zone, between the parts they
//   part. Portals of the zone: go to the part they touch; one that reaches over a cut is split
//   there and its pieces are called PORTAL.1, PORTAL.2 …
namespace zonepack::packer {

struct SplitZone {
  std::string name;
  std::size_t parts = 0;
  ByteCount weight = 0;        // before the split
  ByteCount narrow_limit = 0;  // not 0: parts narrower than a robot's position is known were
                               // needed; this limit would do without them. Worth a warning.
};

struct SplitPlan {
  ZonePlan plan;
  std::vector<std::uint32_t> zone_of;  // per signature, as in Partition
  std::vector<SplitZone> split;        // zones that were split, by name
};

// `zone_of` (Partition::kNone for dropped signatures) and `weights` go with `signatures`. Throws
// std::runtime_error when one signature, or signatures that stand at one place (kOnePlace_m), weigh
// more than the limit, naming the heaviest of them, their zone and the smallest limit that would
// do; and when the name of a part is taken or too long.
SplitPlan split_oversized(const ZonePlan& plan, std::span<const SignaturePlace> signatures,
                          std::span<const std::uint32_t> zone_of,
                          std::span<const ByteCount> weights, ByteCount limit);

}  // namespace zonepack::packer
