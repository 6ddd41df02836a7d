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

// Signatures that no cut can separate, together heavier than the limit; may be a single one.
struct Inseparable {
  std::vector<SignatureId> signatures;
  Point2 p_map;
  ByteCount weight = 0;
};

struct ZoneParts {
  std::vector<Polygon> polygons;
  std::optional<Inseparable> heaviest;  // set: the limit cannot be kept
  // Not 0: signatures at one place (kOnePlace_m) were cut apart to keep the limit; under this limit
  // they would not be.
  ByteCount narrow_limit = 0;
};

// Cuts one zone by the rule of split.hpp into connected polygons, in order along the length, that
// cover the zone without overlap. No part's signatures weigh more than `limit` unless they are
// inseparable. A zone that is light enough stays whole.
ZoneParts parts_of(const Polygon& polygon, std::span<const Member> members, ByteCount limit);

}  // namespace zonepack::packer
