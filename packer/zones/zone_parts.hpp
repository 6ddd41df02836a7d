// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "packer/zones/partition.hpp"
#include "platform/base/byte_count.hpp"

namespace zonepack::packer {

struct Member {
  SignaturePlace place;
  ByteCount weight = 0;
};

// Signatures that no cut can part and that are heavier than the limit together, or one alone.
struct Inseparable {
  std::vector<SignatureId> signatures;
  Point2 p_map;
  ByteCount weight = 0;
};

struct ZoneParts {
  std::vector<Polygon> polygons;
  std::optional<Inseparable> heaviest;  // set: the limit cannot be kept
  ByteCount narrow_limit = 0;  // not 0: signatures at one place (kOnePlace_m) were cut apart to
                               // keep the limit, and would not be under this one
};

// One zone cut by the rule of split.hpp: connected polygons, in order along the length, that cover
// the zone and have no area in common; no part's signatures weigh more than `limit` unless they are
// inseparable. The zone itself when it is light enough.
ZoneParts parts_of(const Polygon& polygon, std::span<const Member> members, ByteCount limit);

}  // namespace zonepack::packer
