// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "packer/tune/track.hpp"
#include "packer/zones/zone_plan.hpp"
#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/file/accounting.hpp"

// Zones while they are changed, and what they cost.
namespace zonepack::packer::tune {

// A signature of the map.
struct Signature {
  SignaturePlace place;
  ZoneId pack = kNoZone;  // the zone of the map whose pack holds it
  double decoded = 0;     // its share of the loaded kinds, bytes
};

// What a zone's pack takes for the kinds that are loaded.
struct PackCost {
  std::uint32_t slots = 0;
  std::uint64_t chunks = 0;  // of all kinds
  ByteCount stored = 0;      // read from storage at each load
  bool exact = false;        // packed; else estimated by the shares of its signatures
};

struct TunedZone {
  PlannedZone zone;
  std::vector<std::uint32_t> members;  // indices of signatures, ascending
  PackCost cost;
  bool pinned = false;
  bool loaded = true;    // false: of a layer that is never loaded
  bool alive = true;     // false: other zones have taken its place
  bool changed = false;  // not a zone of the map
};

// Zones keep their index for ever, so that tracks can name them; those that others have replaced
// are not alive.
struct Layout {
  std::vector<TunedZone> zones;
  std::vector<PlannedPortal> portals;  // between living zones
  ByteCount other_fixed_bytes = 0;     // fixed bytes besides zones, portals and the index

  ByteCount fixed_bytes() const;
  std::size_t living() const;
  // In the order of names, as a zone file has them.
  ZonePlan plan() const;
};

// What one drive loads: its zones in turn, in a memory of so many slots that gives up the zone used
// least recently. It begins empty; pinned zones are always held and never count. A zone that does
// not fit together with the one before it pushes that one out.
struct DriveCost {
  std::uint64_t loads = 0;
  std::uint64_t signatures = 0;
  ByteCount stored = 0;
  DriveCost& operator+=(const DriveCost& other) {
    loads += other.loads;
    signatures += other.signatures;
    stored += other.stored;
    return *this;
  }
};
DriveCost cost_of(std::span<const Visit> visits, const Layout& layout, std::uint64_t slots);

// The largest pair of neighbours besides the pinned zones, how many pairs are as large, and the
// smallest budget that this makes.
struct Smallest {
  std::uint64_t pair_slots = 0;
  std::size_t pairs = 0;
  ByteCount bytes = 0;
  std::string text;  // "L1 with H1"
};
Smallest smallest_of(const Layout& layout);

// Slots for zones that are not pinned within a budget, at least those of the largest pair.
std::uint64_t room_in(const Layout& layout, const Smallest& smallest, ByteCount budget);

}  // namespace zonepack::packer::tune
